#include <shapespace/path/energy_kernels.h>

#include <cmath>

namespace shapespace::internal {
namespace {

// Scratch rows hold a quantity at all times: index 0 is the first shape, 1 .. inner the inner ones,
// inner + 1 the last, repeated through the padding so that differences vanish there.
struct Scratch {
  double* memory;
  int width;
  double* Row(int i) const { return memory + static_cast<size_t>(i) * width; }
};

Scratch MakeScratch(double* memory, int stride) { return {memory, stride + 16}; }

}  // namespace

// The bodies below are plain loops over time that the compiler vectorises.

SHAPESPACE_CLONES
double EdgeLengthKernel(const PathRows& rows, const int* stencils, const double* weights, int count,
                        double quartic, double* memory) {
  const int n = rows.inner, stride = rows.stride;
  const Scratch scratch = MakeScratch(memory, stride);
  double* const e[3] = {scratch.Row(0) + 7, scratch.Row(1) + 7, scratch.Row(2) + 7};
  double* const value = scratch.Row(3) + 7;
  double* const flow = scratch.Row(4) + 7;    // 4 w times the change of value on the segment before
  double* const spread = scratch.Row(5) + 7;  // likewise of the quartic part
  double energy = 0;
  for (int element = 0; element < count; ++element) {
    const size_t p = 3 * static_cast<size_t>(stencils[2 * element]);
    const size_t q = 3 * static_cast<size_t>(stencils[2 * element + 1]);
    const double w = weights[element];
    for (int axis = 0; axis < 3; ++axis) {
      const double* const from = rows.shapes + (p + axis) * stride - 1;
      const double* const to = rows.shapes + (q + axis) * stride - 1;
      double* const d = e[axis];
      d[0] = rows.first[q + axis] - rows.first[p + axis];
      const double last = rows.last[q + axis] - rows.last[p + axis];
      for (int t = 1; t <= stride; ++t) d[t] = to[t] - from[t];
      for (int t = n + 1; t <= stride + 1; ++t) d[t] = last;
    }
    const double* const ex = e[0];
    const double* const ey = e[1];
    const double* const ez = e[2];
    for (int t = 0; t <= stride + 1; ++t) {
      value[t] = 0.5 * (ex[t] * ex[t] + ey[t] * ey[t] + ez[t] * ez[t]);
    }
    double sum = 0;
    for (int t = 1; t <= n + 1; ++t) {
      const double change = value[t] - value[t - 1];
      flow[t] = 4 * w * change;
      sum += change * change;
    }
    energy += 2 * w * sum;
    for (int t = n + 1; t <= stride; ++t) flow[t + 1] = flow[t];
    if (quartic > 0) {
      double sum4 = 0;
      for (int t = 1; t <= n + 1; ++t) {
        const double dx = ex[t] - ex[t - 1], dy = ey[t] - ey[t - 1], dz = ez[t] - ez[t - 1];
        const double squared = dx * dx + dy * dy + dz * dz;
        spread[t] = 2 * quartic * w * squared;
        sum4 += squared * squared;
      }
      energy += 0.5 * quartic * w * sum4;
      for (int t = n + 1; t <= stride; ++t) spread[t + 1] = spread[t];
    }
    for (int axis = 0; axis < 3; ++axis) {
      double* const gp = rows.gradient + (p + axis) * stride - 1;
      double* const gq = rows.gradient + (q + axis) * stride - 1;
      const double* const d = e[axis];
      if (quartic > 0) {
        for (int t = 1; t <= n; ++t) {
          const double g = (flow[t] - flow[t + 1]) * d[t] + spread[t] * (d[t] - d[t - 1]) +
                           spread[t + 1] * (d[t] - d[t + 1]);
          gp[t] -= g;
          gq[t] += g;
        }
      } else {
        for (int t = 1; t <= n; ++t) {
          const double g = (flow[t] - flow[t + 1]) * d[t];
          gp[t] -= g;
          gq[t] += g;
        }
      }
    }
  }
  return energy;
}

SHAPESPACE_CLONES
double PositionKernel(const PathRows& rows, const int* stencils, const double* weights, int count,
                      double* memory) {
  const int n = rows.inner, stride = rows.stride;
  const Scratch scratch = MakeScratch(memory, stride);
  double* const p = scratch.Row(0) + 7;
  double energy = 0;
  for (int element = 0; element < count; ++element) {
    const double w = weights[element];
    for (int axis = 0; axis < 3; ++axis) {
      const size_t row = 3 * static_cast<size_t>(stencils[element]) + axis;
      const double* const shapes = rows.shapes + row * stride - 1;
      double* const g = rows.gradient + row * stride - 1;
      p[0] = rows.first[row];
      for (int t = 1; t <= n; ++t) p[t] = shapes[t];
      p[n + 1] = rows.last[row];
      double sum = 0;
      for (int t = 1; t <= n + 1; ++t) sum += (p[t] - p[t - 1]) * (p[t] - p[t - 1]);
      energy += 2 * w * sum;
      for (int t = 1; t <= n; ++t) g[t] += 4 * w * (2 * p[t] - p[t - 1] - p[t + 1]);
    }
  }
  return energy;
}

SHAPESPACE_CLONES
double DihedralKernel(const PathRows& rows, const int* stencils, const double* weights, int count,
                      double normal_epsilon_squared, double edge_epsilon_squared, double* memory) {
  const int n = rows.inner, stride = rows.stride;
  const Scratch scratch = MakeScratch(memory, stride);
  // By vertex a, b, c, d of the hinge: edge e = b - a, sides u = c - a and v = d - a, unit normals
  // m1 and m2 with 1 / (regularised length), the same of the edge, and the two values.
  double* row[20];
  for (int i = 0; i < 20; ++i) row[i] = scratch.Row(i) + 7;
  double *const ex = row[0], *const ey = row[1], *const ez = row[2];
  double *const ux = row[3], *const uy = row[4], *const uz = row[5];
  double *const vx = row[6], *const vy = row[7], *const vz = row[8];
  double *const ax = row[9], *const ay = row[10], *const az = row[11];
  double *const bx = row[12], *const by = row[13], *const bz = row[14];
  double *const ra = row[15], *const rb = row[16], *const re = row[17];
  double *const cosine = row[18], *const sine = row[19];
  double energy = 0;
  for (int element = 0; element < count; ++element) {
    const int* const stencil = stencils + 4 * element;
    const size_t a = 3 * static_cast<size_t>(stencil[0]);
    const double w = weights[element];
    for (int k = 1; k < 4; ++k) {
      const size_t b = 3 * static_cast<size_t>(stencil[k]);
      for (int axis = 0; axis < 3; ++axis) {
        const double* const from = rows.shapes + (a + axis) * stride - 1;
        const double* const to = rows.shapes + (b + axis) * stride - 1;
        double* const d = row[3 * (k - 1) + axis];
        d[0] = rows.first[b + axis] - rows.first[a + axis];
        for (int t = 1; t <= n; ++t) d[t] = to[t] - from[t];
        d[n + 1] = rows.last[b + axis] - rows.last[a + axis];
      }
    }
    for (int t = 0; t <= n + 1; ++t) {
      const double nx = ey[t] * uz[t] - ez[t] * uy[t];
      const double ny = ez[t] * ux[t] - ex[t] * uz[t];
      const double nz = ex[t] * uy[t] - ey[t] * ux[t];
      const double kx = vy[t] * ez[t] - vz[t] * ey[t];
      const double ky = vz[t] * ex[t] - vx[t] * ez[t];
      const double kz = vx[t] * ey[t] - vy[t] * ex[t];
      const double r1 = 1 / std::sqrt(nx * nx + ny * ny + nz * nz + normal_epsilon_squared);
      const double r2 = 1 / std::sqrt(kx * kx + ky * ky + kz * kz + normal_epsilon_squared);
      const double r0 =
          1 / std::sqrt(ex[t] * ex[t] + ey[t] * ey[t] + ez[t] * ez[t] + edge_epsilon_squared);
      ax[t] = nx * r1, ay[t] = ny * r1, az[t] = nz * r1;
      bx[t] = kx * r2, by[t] = ky * r2, bz[t] = kz * r2;
      ra[t] = r1, rb[t] = r2, re[t] = r0;
      cosine[t] = ax[t] * bx[t] + ay[t] * by[t] + az[t] * bz[t];
      const double cx = ay[t] * bz[t] - az[t] * by[t];
      const double cy = az[t] * bx[t] - ax[t] * bz[t];
      const double cz = ax[t] * by[t] - ay[t] * bx[t];
      sine[t] = r0 * (cx * ex[t] + cy * ey[t] + cz * ez[t]);
    }
    double sum = 0;
    for (int t = 1; t <= n + 1; ++t) {
      const double dc = cosine[t] - cosine[t - 1], ds = sine[t] - sine[t - 1];
      sum += dc * dc + ds * ds;
    }
    energy += 2 * w * sum;

    double* const ga = rows.gradient + a * stride - 1;
    double* const gb = rows.gradient + 3 * static_cast<size_t>(stencil[1]) * stride - 1;
    double* const gc = rows.gradient + 3 * static_cast<size_t>(stencil[2]) * stride - 1;
    double* const gd = rows.gradient + 3 * static_cast<size_t>(stencil[3]) * stride - 1;
#pragma GCC ivdep
    for (int t = 1; t <= n; ++t) {
      const double fc = 4 * w * (2 * cosine[t] - cosine[t - 1] - cosine[t + 1]);
      const double fs = 4 * w * (2 * sine[t] - sine[t - 1] - sine[t + 1]);
      // Back through the values to the unit vectors, i = e / |e| ...
      const double ix = ex[t] * re[t], iy = ey[t] * re[t], iz = ez[t] * re[t];
      double px = fc * bx[t] + fs * (by[t] * iz - bz[t] * iy);
      double py = fc * by[t] + fs * (bz[t] * ix - bx[t] * iz);
      double pz = fc * bz[t] + fs * (bx[t] * iy - by[t] * ix);
      double qx = fc * ax[t] + fs * (iy * az[t] - iz * ay[t]);
      double qy = fc * ay[t] + fs * (iz * ax[t] - ix * az[t]);
      double qz = fc * az[t] + fs * (ix * ay[t] - iy * ax[t]);
      double sx = fs * (ay[t] * bz[t] - az[t] * by[t]);
      double sy = fs * (az[t] * bx[t] - ax[t] * bz[t]);
      double sz = fs * (ax[t] * by[t] - ay[t] * bx[t]);
      // ... through the normalisations to the two normals and the edge ...
      const double along1 = ax[t] * px + ay[t] * py + az[t] * pz;
      px = ra[t] * (px - along1 * ax[t]);
      py = ra[t] * (py - along1 * ay[t]);
      pz = ra[t] * (pz - along1 * az[t]);
      const double along2 = bx[t] * qx + by[t] * qy + bz[t] * qz;
      qx = rb[t] * (qx - along2 * bx[t]);
      qy = rb[t] * (qy - along2 * by[t]);
      qz = rb[t] * (qz - along2 * bz[t]);
      const double along0 = ix * sx + iy * sy + iz * sz;
      sx = re[t] * (sx - along0 * ix);
      sy = re[t] * (sy - along0 * iy);
      sz = re[t] * (sz - along0 * iz);
      // ... and through the cross products e x u and v x e to the sides.
      const double gux = py * ez[t] - pz * ey[t];
      const double guy = pz * ex[t] - px * ez[t];
      const double guz = px * ey[t] - py * ex[t];
      const double gvx = ey[t] * qz - ez[t] * qy;
      const double gvy = ez[t] * qx - ex[t] * qz;
      const double gvz = ex[t] * qy - ey[t] * qx;
      const double gex = sx + uy[t] * pz - uz[t] * py + qy * vz[t] - qz * vy[t];
      const double gey = sy + uz[t] * px - ux[t] * pz + qz * vx[t] - qx * vz[t];
      const double gez = sz + ux[t] * py - uy[t] * px + qx * vy[t] - qy * vx[t];
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
  return energy;
}

}  // namespace shapespace::internal
