#include <shapespace/path/energy_kernels.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>

#include <shapespace/base/clones.h>

namespace shapespace::internal {
namespace {

// Scratch rows hold a quantity at all times: index 0 is the first shape, 1 .. inner the inner ones,
// inner + 1 the last. What stands further on, up to stride + 1, is finite and means nothing.
struct Scratch {
  double* memory;
  int width;
  double* Row(int i) const { return memory + static_cast<size_t>(i) * width; }
};

Scratch MakeScratch(double* memory, int stride) { return {memory, stride + 16}; }

/// The natural logarithm of a positive normal number, to two units in the last place; plain
/// arithmetic, so that loops that call it are vectorised. With x = 2^k z, z between 1 / sqrt 2 and
/// sqrt 2, and s = (z - 1) / (z + 1): log x = k log 2 + 2 atanh s, by its series.
inline double Log(double x) {
  constexpr std::uint64_t kOne = 0x3ff0000000000000, kRootHalf = 0x3fe6a09e667f3bcd;
  constexpr std::uint64_t kMantissa = 0x000fffffffffffff, kTwoTo52 = 0x4330000000000000;
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  bits += kOne - kRootHalf;
  const std::uint64_t exponent = (bits >> 52) | kTwoTo52;  // as the last bits of a double
  bits = (bits & kMantissa) + kRootHalf;
  double z, k;
  std::memcpy(&z, &bits, sizeof z);
  std::memcpy(&k, &exponent, sizeof k);
  k -= 4503599627370496.0 + 1023;
  const double s = (z - 1) / (z + 1), w = s * s;
  double series = 1.0 / 21;
  series = series * w + 1.0 / 19;
  series = series * w + 1.0 / 17;
  series = series * w + 1.0 / 15;
  series = series * w + 1.0 / 13;
  series = series * w + 1.0 / 11;
  series = series * w + 1.0 / 9;
  series = series * w + 1.0 / 7;
  series = series * w + 1.0 / 5;
  series = series * w + 1.0 / 3;
  return k * M_LN2 + 2 * (s + s * w * series);
}

}  // namespace

// The bodies below are plain loops over time that the compiler vectorises: no two rows overlap, and
// energies are summed by time first, so that no sum has to be reordered.

SHAPESPACE_CLONES
double EdgeLengthKernel(const PathRows& rows, const int* stencils, const double* weights, int count,
                        double quartic, double* memory) {
  const int n = rows.inner, stride = rows.stride;
  const Scratch scratch = MakeScratch(memory, stride);
  double* const e[3] = {scratch.Row(0) + 7, scratch.Row(1) + 7, scratch.Row(2) + 7};
  const double *const ex = e[0], *const ey = e[1], *const ez = e[2];
  double* const value = scratch.Row(3) + 7;
  double* const flow = scratch.Row(4) + 7;    // 4 w times the change of value on the segment before
  double* const spread = scratch.Row(5) + 7;  // likewise of the quartic part
  double* const sums = scratch.Row(6) + 7;
  std::fill(sums, sums + n + 2, 0.0);
  for (int element = 0; element < count; ++element) {
    const size_t p = 3 * static_cast<size_t>(stencils[2 * element]);
    const size_t q = 3 * static_cast<size_t>(stencils[2 * element + 1]);
    const double w = weights[element];
    for (int axis = 0; axis < 3; ++axis) {
      const double* const from = rows.shapes + (p + axis) * stride - 1;
      const double* const to = rows.shapes + (q + axis) * stride - 1;
      double* const d = e[axis];
      SHAPESPACE_INDEPENDENT
      for (int t = 1; t <= stride; ++t) d[t] = to[t] - from[t];
      d[0] = rows.first[q + axis] - rows.first[p + axis];
      d[n + 1] = rows.last[q + axis] - rows.last[p + axis];
    }
    SHAPESPACE_INDEPENDENT
    for (int t = 1; t <= stride; ++t) {
      value[t] = 0.5 * (ex[t] * ex[t] + ey[t] * ey[t] + ez[t] * ez[t]);
    }
    for (int t : {0, n + 1}) value[t] = 0.5 * (ex[t] * ex[t] + ey[t] * ey[t] + ez[t] * ez[t]);
    SHAPESPACE_INDEPENDENT
    for (int t = 1; t <= n + 1; ++t) {
      const double change = value[t] - value[t - 1];
      flow[t] = 4 * w * change;
      sums[t] += 2 * w * change * change;
    }
    if (quartic > 0) {
      SHAPESPACE_INDEPENDENT
      for (int t = 1; t <= n + 1; ++t) {
        const double dx = ex[t] - ex[t - 1], dy = ey[t] - ey[t - 1], dz = ez[t] - ez[t - 1];
        const double squared = dx * dx + dy * dy + dz * dz;
        spread[t] = 2 * quartic * w * squared;
        sums[t] += 0.5 * quartic * w * squared * squared;
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      double* const gp = rows.gradient + (p + axis) * stride - 1;
      double* const gq = rows.gradient + (q + axis) * stride - 1;
      const double* const d = e[axis];
      if (quartic > 0) {
        SHAPESPACE_INDEPENDENT
        for (int t = 1; t <= stride; ++t) {
          const double g = (flow[t] - flow[t + 1]) * d[t] + spread[t] * (d[t] - d[t - 1]) +
                           spread[t + 1] * (d[t] - d[t + 1]);
          gp[t] -= g;
          gq[t] += g;
        }
      } else {
        SHAPESPACE_INDEPENDENT
        for (int t = 1; t <= stride; ++t) {
          const double g = (flow[t] - flow[t + 1]) * d[t];
          gp[t] -= g;
          gq[t] += g;
        }
      }
    }
  }
  return std::accumulate(sums + 1, sums + n + 2, 0.0);
}

SHAPESPACE_CLONES
double PositionKernel(const PathRows& rows, const int* stencils, const double* weights, int count,
                      double* memory) {
  const int n = rows.inner, stride = rows.stride;
  const Scratch scratch = MakeScratch(memory, stride);
  double* const p = scratch.Row(0) + 7;
  double* const sums = scratch.Row(1) + 7;
  std::fill(sums, sums + n + 2, 0.0);
  for (int element = 0; element < count; ++element) {
    const double w = weights[element];
    for (int axis = 0; axis < 3; ++axis) {
      const size_t row = 3 * static_cast<size_t>(stencils[element]) + axis;
      const double* const shapes = rows.shapes + row * stride - 1;
      double* const g = rows.gradient + row * stride - 1;
      p[0] = rows.first[row];
      SHAPESPACE_INDEPENDENT
      for (int t = 1; t <= stride; ++t) p[t] = shapes[t];
      p[n + 1] = rows.last[row];
      SHAPESPACE_INDEPENDENT
      for (int t = 1; t <= n + 1; ++t) sums[t] += 2 * w * (p[t] - p[t - 1]) * (p[t] - p[t - 1]);
      SHAPESPACE_INDEPENDENT
      for (int t = 1; t <= stride; ++t) g[t] += 4 * w * (2 * p[t] - p[t - 1] - p[t + 1]);
    }
  }
  return std::accumulate(sums + 1, sums + n + 2, 0.0);
}

// With normals n1 = e x u, n2 = v x e of the two triangles (e = b - a, u = c - a, v = d - a) the
// functor's values are, since n1 x n2 = -(n1 . v) e,
//   cos = R n1 . n2,  sin = -R H n1 . v,  R = 1 / (|n1| |n2|),  H = |e|^2 / |e|,
// all lengths regularised: two roots and two divisions a hinge instead of three each.
SHAPESPACE_CLONES
double DihedralKernel(const PathRows& rows, const int* stencils, const double* weights,
                      const double* ends, int count, double normal_epsilon_squared,
                      double edge_epsilon_squared, double* memory) {
  const int n = rows.inner, stride = rows.stride;
  const Scratch scratch = MakeScratch(memory, stride);
  double* row[25];
  for (int i = 0; i < 25; ++i) row[i] = scratch.Row(i) + 7;
  double *const ex = row[0], *const ey = row[1], *const ez = row[2];
  double *const ux = row[3], *const uy = row[4], *const uz = row[5];
  double *const vx = row[6], *const vy = row[7], *const vz = row[8];
  double *const ax = row[9], *const ay = row[10], *const az = row[11];   // n1
  double *const bx = row[12], *const by = row[13], *const bz = row[14];  // n2
  double *const q1 = row[15], *const q2 = row[16];                       // |n1|^2, |n2|^2
  double *const inverse = row[17], *const height = row[18];              // R, H
  double *const edge = row[19], *const triple = row[20];                 // 1 / |e|, n1 . v
  double *const cosine = row[21], *const sine = row[22];
  double* const sums = row[23];
  std::fill(sums, sums + n + 2, 0.0);
  for (int element = 0; element < count; ++element) {
    const int* const stencil = stencils + 4 * element;
    const double* const end = ends + 4 * element;
    const size_t a = 3 * static_cast<size_t>(stencil[0]);
    const double w = weights[element];
    for (int k = 1; k < 4; ++k) {
      const size_t b = 3 * static_cast<size_t>(stencil[k]);
      for (int axis = 0; axis < 3; ++axis) {
        const double* const from = rows.shapes + (a + axis) * stride - 1;
        const double* const to = rows.shapes + (b + axis) * stride - 1;
        double* const d = row[3 * (k - 1) + axis];
        SHAPESPACE_INDEPENDENT
        for (int t = 1; t <= stride; ++t) d[t] = to[t] - from[t];
      }
    }
    SHAPESPACE_INDEPENDENT
    for (int t = 1; t <= stride; ++t) {
      const double nx = ey[t] * uz[t] - ez[t] * uy[t];
      const double ny = ez[t] * ux[t] - ex[t] * uz[t];
      const double nz = ex[t] * uy[t] - ey[t] * ux[t];
      const double mx = vy[t] * ez[t] - vz[t] * ey[t];
      const double my = vz[t] * ex[t] - vx[t] * ez[t];
      const double mz = vx[t] * ey[t] - vy[t] * ex[t];
      const double length = ex[t] * ex[t] + ey[t] * ey[t] + ez[t] * ez[t];
      const double n1 = nx * nx + ny * ny + nz * nz + normal_epsilon_squared;
      const double n2 = mx * mx + my * my + mz * mz + normal_epsilon_squared;
      const double r = 1 / std::sqrt(n1 * n2);
      const double l = 1 / std::sqrt(length + edge_epsilon_squared);
      const double volume = nx * vx[t] + ny * vy[t] + nz * vz[t];
      ax[t] = nx, ay[t] = ny, az[t] = nz;
      bx[t] = mx, by[t] = my, bz[t] = mz;
      q1[t] = n1, q2[t] = n2;
      inverse[t] = r, edge[t] = l, height[t] = length * l, triple[t] = volume;
      cosine[t] = r * (nx * mx + ny * my + nz * mz);
      sine[t] = -r * length * l * volume;
    }
    cosine[0] = end[0], sine[0] = end[1];
    cosine[n + 1] = rows.free_end ? cosine[n] : end[2];
    sine[n + 1] = rows.free_end ? sine[n] : end[3];
    SHAPESPACE_INDEPENDENT
    for (int t = 1; t <= n + 1; ++t) {
      const double dc = cosine[t] - cosine[t - 1], ds = sine[t] - sine[t - 1];
      sums[t] += 2 * w * (dc * dc + ds * ds);
    }

    double* const ga = rows.gradient + a * stride - 1;
    double* const gb = rows.gradient + 3 * static_cast<size_t>(stencil[1]) * stride - 1;
    double* const gc = rows.gradient + 3 * static_cast<size_t>(stencil[2]) * stride - 1;
    double* const gd = rows.gradient + 3 * static_cast<size_t>(stencil[3]) * stride - 1;
    SHAPESPACE_INDEPENDENT
    for (int t = 1; t <= stride; ++t) {
      const double fc = 4 * w * (2 * cosine[t] - cosine[t - 1] - cosine[t + 1]);
      const double fs = 4 * w * (2 * sine[t] - sine[t - 1] - sine[t + 1]);
      const double r = inverse[t];
      const double along = (fc * cosine[t] + fs * sine[t]) * r * r;
      const double along1 = along * q2[t], along2 = along * q1[t];
      const double c = fc * r, s = fs * r * height[t];
      // Derivatives with respect to n1 and n2 ...
      const double px = c * bx[t] - s * vx[t] - along1 * ax[t];
      const double py = c * by[t] - s * vy[t] - along1 * ay[t];
      const double pz = c * bz[t] - s * vz[t] - along1 * az[t];
      const double qx = c * ax[t] - along2 * bx[t];
      const double qy = c * ay[t] - along2 * by[t];
      const double qz = c * az[t] - along2 * bz[t];
      // ... and through the cross products with respect to u, v and e.
      const double gux = py * ez[t] - pz * ey[t];
      const double guy = pz * ex[t] - px * ez[t];
      const double guz = px * ey[t] - py * ex[t];
      const double gvx = ey[t] * qz - ez[t] * qy - s * ax[t];
      const double gvy = ez[t] * qx - ex[t] * qz - s * ay[t];
      const double gvz = ex[t] * qy - ey[t] * qx - s * az[t];
      const double h = -fs * triple[t] * r * edge[t] * (2 - height[t] * edge[t]);
      const double gex = h * ex[t] + uy[t] * pz - uz[t] * py + qy * vz[t] - qz * vy[t];
      const double gey = h * ey[t] + uz[t] * px - ux[t] * pz + qz * vx[t] - qx * vz[t];
      const double gez = h * ez[t] + ux[t] * py - uy[t] * px + qx * vy[t] - qy * vx[t];
      ga[t] -= gex + gux + gvx;
      ga[t + stride] -= gey + guy + gvy;
      ga[t + 2 * stride] -= gez + guz + gvz;
      gb[t] += gex;
      gb[t + stride] += gey;
      gb[t + 2 * stride] += gez;
      gc[t] += gux;
      gc[t + stride] += guy;
      gc[t + 2 * stride] += guz;
      gd[t] += gvx;
      gd[t + stride] += gvy;
      gd[t + 2 * stride] += gvz;
    }
  }
  return std::accumulate(sums + 1, sums + n + 2, 0.0);
}

// With a = q - p, b = r - p, the values depend on aa = |a|^2, ab = a . b and bb = |b|^2 only; what
// is written here as in the functor (metric/triangle_strain.h) has the same names there.
SHAPESPACE_CLONES
double TriangleStrainKernel(const PathRows& rows, const int* stencils, const double* weights,
                            const double* ends, int count, double epsilon_squared, double* memory) {
  const int n = rows.inner, stride = rows.stride;
  const Scratch scratch = MakeScratch(memory, stride);
  double* row[20];
  for (int i = 0; i < 20; ++i) row[i] = scratch.Row(i) + 7;
  double *const ax = row[0], *const ay = row[1], *const az = row[2];
  double *const bx = row[3], *const by = row[4], *const bz = row[5];
  double *const saa = row[6], *const sab = row[7], *const sbb = row[8];
  double *const sd = row[9], *const so = row[10], *const sm = row[11];
  double* const inverse = row[12];                       // 1 / determinant
  double *const slope = row[13], *const turn = row[14];  // values / (d, o); its derivative by R
  double* const ratio = row[15];                         // R = (d^2 + o^2) / m^2
  double *const v0 = row[16], *const v1 = row[17], *const v2 = row[18];
  double* const sums = row[19];
  constexpr double kThird = 1.0 / 3, kRoot3 = 0.57735026918962576451;
  constexpr double kSmall = 0.01;  // ratios below take the series of atanh(r) / r
  std::fill(sums, sums + n + 2, 0.0);
  for (int element = 0; element < count; ++element) {
    const int* const stencil = stencils + 3 * element;
    const double* const end = ends + 6 * element;
    const size_t p = 3 * static_cast<size_t>(stencil[0]);
    const double w = weights[element];
    for (int k = 1; k < 3; ++k) {
      const size_t q = 3 * static_cast<size_t>(stencil[k]);
      for (int axis = 0; axis < 3; ++axis) {
        const double* const from = rows.shapes + (p + axis) * stride - 1;
        const double* const to = rows.shapes + (q + axis) * stride - 1;
        double* const difference = row[3 * (k - 1) + axis];
        SHAPESPACE_INDEPENDENT
        for (int t = 1; t <= stride; ++t) difference[t] = to[t] - from[t];
      }
    }
    SHAPESPACE_INDEPENDENT
    for (int t = 1; t <= stride; ++t) {
      const double aa = ax[t] * ax[t] + ay[t] * ay[t] + az[t] * az[t];
      const double ab = ax[t] * bx[t] + ay[t] * by[t] + az[t] * bz[t];
      const double bb = bx[t] * bx[t] + by[t] * by[t] + bz[t] * bz[t];
      const double nx = ay[t] * bz[t] - az[t] * by[t];
      const double ny = az[t] * bx[t] - ax[t] * bz[t];
      const double nz = ax[t] * by[t] - ay[t] * bx[t];
      const double mean = 2 * kThird * (aa + bb - ab);
      const double d = kThird * (aa + 2 * (ab - bb)), o = kRoot3 * (2 * ab - aa);
      const double m = mean + epsilon_squared;
      const double determinant = 4 * kThird * (nx * nx + ny * ny + nz * nz) +
                                 (2 * mean + epsilon_squared) * epsilon_squared;
      const double squared = d * d + o * o, reciprocal = 1 / m;
      const double r = squared * reciprocal * reciprocal;
      const double length = std::sqrt(squared), root = std::sqrt(determinant);
      // F = atanh(sqrt R) / sqrt R and F', where R is small by their series.
      const double safe = r < kSmall ? m : length;
      const double general = m / safe * Log((m + length) / root);
      const double one_less = m * m / determinant;  // 1 / (1 - R)
      const double general_slope = 0.5 * (one_less - general) * (m * m) / (safe * safe);
      const double series =
          1 + r * (1.0 / 3 +
                   r * (1.0 / 5 +
                        r * (1.0 / 7 +
                             r * (1.0 / 9 + r * (1.0 / 11 + r * (1.0 / 13 + r * (1.0 / 15)))))));
      const double series_slope =
          1.0 / 3 +
          r * (2.0 / 5 +
               r * (3.0 / 7 +
                    r * (4.0 / 9 +
                         r * (5.0 / 11 + r * (6.0 / 13 + r * (7.0 / 15 + r * (8.0 / 17)))))));
      const double f = r < kSmall ? series : general;
      const double f_slope = r < kSmall ? series_slope : general_slope;
      const double s = 0.5 * M_SQRT1_2 * f * reciprocal;
      saa[t] = aa, sab[t] = ab, sbb[t] = bb;
      sd[t] = d, so[t] = o, sm[t] = reciprocal;
      inverse[t] = 1 / determinant;
      slope[t] = s;
      turn[t] = M_SQRT1_2 * f_slope * reciprocal;
      ratio[t] = r;
      v0[t] = 0.25 * Log(determinant);
      v1[t] = s * d;
      v2[t] = s * o;
    }
    v0[0] = end[0], v1[0] = end[1], v2[0] = end[2];
    v0[n + 1] = rows.free_end ? v0[n] : end[3];
    v1[n + 1] = rows.free_end ? v1[n] : end[4];
    v2[n + 1] = rows.free_end ? v2[n] : end[5];
    SHAPESPACE_INDEPENDENT
    for (int t = 1; t <= n + 1; ++t) {
      const double d0 = v0[t] - v0[t - 1], d1 = v1[t] - v1[t - 1], d2 = v2[t] - v2[t - 1];
      sums[t] += 2 * w * (d0 * d0 + d1 * d1 + d2 * d2);
    }

    double* const gp = rows.gradient + p * stride - 1;
    double* const gq = rows.gradient + 3 * static_cast<size_t>(stencil[1]) * stride - 1;
    double* const gr = rows.gradient + 3 * static_cast<size_t>(stencil[2]) * stride - 1;
    SHAPESPACE_INDEPENDENT
    for (int t = 1; t <= stride; ++t) {
      const double f0 = 4 * w * (2 * v0[t] - v0[t - 1] - v0[t + 1]);
      const double f1 = 4 * w * (2 * v1[t] - v1[t - 1] - v1[t + 1]);
      const double f2 = 4 * w * (2 * v2[t] - v2[t - 1] - v2[t + 1]);
      // Derivatives with respect to the determinant, d, o and the mean m ...
      const double by_determinant = kThird * f0 * inverse[t];
      const double sum = (f1 * sd[t] + f2 * so[t]) * sm[t];
      const double by_d = slope[t] * f1 + sum * turn[t] * sd[t] * sm[t];
      const double by_o = kRoot3 * (slope[t] * f2 + sum * turn[t] * so[t] * sm[t]);
      const double by_m = -2 * kThird * sum * (turn[t] * ratio[t] + slope[t]);
      // ... and to aa, bb and ab.
      const double by_aa =
          by_m + kThird * by_d - by_o + by_determinant * (sbb[t] + epsilon_squared);
      const double by_bb = by_m - 2 * kThird * by_d + by_determinant * (saa[t] + epsilon_squared);
      const double by_ab =
          -by_m + 2 * kThird * by_d + 2 * by_o - by_determinant * (2 * sab[t] + epsilon_squared);
      const double qx = 2 * by_aa * ax[t] + by_ab * bx[t], rx = 2 * by_bb * bx[t] + by_ab * ax[t];
      const double qy = 2 * by_aa * ay[t] + by_ab * by[t], ry = 2 * by_bb * by[t] + by_ab * ay[t];
      const double qz = 2 * by_aa * az[t] + by_ab * bz[t], rz = 2 * by_bb * bz[t] + by_ab * az[t];
      gp[t] -= qx + rx;
      gp[t + stride] -= qy + ry;
      gp[t + 2 * stride] -= qz + rz;
      gq[t] += qx;
      gq[t + stride] += qy;
      gq[t + 2 * stride] += qz;
      gr[t] += rx;
      gr[t + stride] += ry;
      gr[t + 2 * stride] += rz;
    }
  }
  return std::accumulate(sums + 1, sums + n + 2, 0.0);
}

SHAPESPACE_CLONES
void AddVolumes(const PathRows& rows, const int* stencils, int count, double reference,
                double* values, double* memory) {
  const int n = rows.inner, stride = rows.stride;
  double* const sums = MakeScratch(memory, stride).Row(0);
  std::fill(sums, sums + stride, 0.0);
  double ends[2] = {0, 0};
  const double scale = 1 / (6 * reference);
  for (int element = 0; element < count; ++element) {
    const double *p[3], *q[3], *r[3];
    for (int axis = 0; axis < 3; ++axis) {
      p[axis] = rows.shapes + (3 * static_cast<size_t>(stencils[3 * element]) + axis) * stride;
      q[axis] = rows.shapes + (3 * static_cast<size_t>(stencils[3 * element + 1]) + axis) * stride;
      r[axis] = rows.shapes + (3 * static_cast<size_t>(stencils[3 * element + 2]) + axis) * stride;
    }
    SHAPESPACE_INDEPENDENT
    for (int t = 0; t < stride; ++t) {
      sums[t] += p[0][t] * (q[1][t] * r[2][t] - q[2][t] * r[1][t]) +
                 p[1][t] * (q[2][t] * r[0][t] - q[0][t] * r[2][t]) +
                 p[2][t] * (q[0][t] * r[1][t] - q[1][t] * r[0][t]);
    }
    for (int last : {0, 1}) {
      const double* const end = last ? rows.last : rows.first;
      const double* const a = end + 3 * static_cast<size_t>(stencils[3 * element]);
      const double* const b = end + 3 * static_cast<size_t>(stencils[3 * element + 1]);
      const double* const c = end + 3 * static_cast<size_t>(stencils[3 * element + 2]);
      ends[last] += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                    a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
  }
  values[0] += scale * ends[0];
  for (int t = 0; t < n; ++t) values[t + 1] += scale * sums[t];
  values[n + 1] += scale * ends[1];
}

SHAPESPACE_CLONES
void AddVolumeGradients(const PathRows& rows, const int* stencils, int count, double reference,
                        const double* slopes, double* memory) {
  const int n = rows.inner, stride = rows.stride;
  double* const slope = MakeScratch(memory, stride).Row(0);
  for (int t = 0; t < stride; ++t) slope[t] = t < n ? slopes[t + 1] / (6 * reference) : 0;
  for (int element = 0; element < count; ++element) {
    // The derivative by each corner is the cross product of the next two.
    for (int corner = 0; corner < 3; ++corner) {
      const size_t p = 3 * static_cast<size_t>(stencils[3 * element + corner]);
      const size_t q = 3 * static_cast<size_t>(stencils[3 * element + (corner + 1) % 3]);
      const size_t r = 3 * static_cast<size_t>(stencils[3 * element + (corner + 2) % 3]);
      for (int axis = 0; axis < 3; ++axis) {
        const int next = (axis + 1) % 3, after = (axis + 2) % 3;
        double* const g = rows.gradient + (p + axis) * stride;
        const double* const q1 = rows.shapes + (q + next) * stride;
        const double* const q2 = rows.shapes + (q + after) * stride;
        const double* const r1 = rows.shapes + (r + next) * stride;
        const double* const r2 = rows.shapes + (r + after) * stride;
        SHAPESPACE_INDEPENDENT
        for (int t = 0; t < stride; ++t) g[t] += slope[t] * (q1[t] * r2[t] - q2[t] * r1[t]);
      }
    }
  }
}

}  // namespace shapespace::internal
