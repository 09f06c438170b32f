#include <shapespace/path/detail/energy_kernels.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <type_traits>

#include <shapespace/base/internal/clones.h>

namespace shapespace::internal {
namespace {

// Registers are filled with times of one element or, if a path has few shapes, with one time of
// eight elements. The code is the same for both: in a scratch row, which contains one quantity of
// kElements elements at all times, the same element at the next time is kElements slots further on.
// Time 0 is the first shape, 1 .. inner are the inner ones, inner + 1 is the last. The slots after
// those are finite but unused. kInner is the number of inner shapes if there are few, and otherwise
// 0. A scratch row of a path with two inner shapes, and of one with many:
//
//   kElements 8:  |e0 e1 .. e7|e0 e1 .. e7|e0 e1 .. e7|e0 e1 .. e7|
//                    time 0      time 1      time 2      time 3
//   kElements 1:  |t0|t1|t2| .. |t inner|t inner + 1|       all of one element
//                 0  |                  |           |
//                    kElements          Last()      EndOfSegments()
//
// Slot l of a row of values belongs to a shape, slot l of a row of differences to the segment that
// ends there; so `value[l] - value[l - kElements]` is the change on that segment, and a loop over
// [kElements, EndOfSegments()) visits all segments.
//
// Long paths are divided into windows, so that rows are short and on the stack, where the
// compiler's addressing is most efficient. A window's first shape is the last but one of the window
// before.
constexpr int kWindow = 128;

template <int kInner>
class Scratch {
 public:
  static constexpr int kElements = kInner > 0 ? 8 : 1;
  static constexpr int kRow = kInner > 0 ? 56 : kWindow + 16;

  /// The window whose first inner shape is inner shape `begin` of the path, from 0.
  Scratch(const PathRows& path, int begin)
      : begin_(begin),
        inner_(kInner > 0 ? kInner : std::min(kWindow, path.inner - begin)),
        stored_(kInner > 0 ? kInner : std::min(kWindow, path.stride - begin)),
        at_first_(kInner > 0 || begin == 0),
        at_last_(kInner > 0 || begin + inner_ == path.inner) {
    for (double(&row)[kRow] : rows_) std::fill_n(row, 8 + End() + kElements, 0.0);
  }

  /// Offset such that the first inner shape is aligned.
  double* Row(int i) { return rows_[i] + 8 - kElements; }

  int Begin() const { return begin_; }
  int Last() const { return kElements * (inner_ + 1); }
  /// Slots [kElements, End()) are the inner shapes, including padding that is stored.
  int End() const { return kElements * (stored_ + 1); }
  /// Slots [kElements, EndOfSegments()) are the segments, each at the position of the shape at its
  /// end.
  int EndOfSegments() const { return kElements * (inner_ + 2); }

  /// Whether the path begins, or ends, with this window. If not, the window's first and last shape
  /// are inner ones; slots [BeginOfInner(), EndOfInner()) are all inner shapes.
  bool AtFirst() const { return at_first_; }
  bool AtLast() const { return at_last_; }
  int BeginOfInner() const { return at_first_ ? kElements : 0; }
  int EndOfInner() const { return at_last_ ? End() : EndOfSegments(); }

  /// The sum over all segments except the one that also belongs to the next window.
  double Sum(const double* row) const {
    return std::accumulate(row + kElements, row + (at_last_ ? EndOfSegments() : Last()), 0.0);
  }

 private:
  const int begin_, inner_, stored_;
  const bool at_first_, at_last_;
  alignas(64) double rows_[49][kRow];
  static_assert(8 + kElements * (kInner + 1) <= kRow);
};

/// kElements elements of a kernel's list. If fewer are left, the last one is repeated with weight
/// zero.
template <int kInner, int kVertices>
class Tile {
 public:
  static constexpr int kElements = Scratch<kInner>::kElements;

  /// Uses 6 kVertices + 1 scratch rows from `row` on; for single elements none.
  SHAPESPACE_INLINE Tile(const PathRows& path, Scratch<kInner>* scratch, int row)
      : path_(path), scratch_(*scratch), row_(row) {}

  /// Loads the first elements of `count`.
  SHAPESPACE_INLINE void Load(const int* stencils, const double* weights, int count) {
    used_ = std::min(kElements, count);
    for (int i = 0; i < kElements; ++i) {
      const int* const stencil = stencils + kVertices * std::min(i, used_ - 1);
      for (int k = 0; k < kVertices; ++k) vertex_[k][i] = stencil[k];
    }
    if constexpr (kElements == 1) {
      weight_ = weights[0];
    } else {
      for (int i = 0; i < kElements; ++i) {
        const double weight = i < used_ ? weights[i] : 0;
        for (int t = 1; t < kInner + 2; ++t) scratch_.Row(row_)[kElements * t + i] = weight;
      }
      for (int k = 0; k < kVertices; ++k) {
        double* const to = Gathered(k) + kElements;
        for (int i = 0; i < kElements; ++i) {
          const double* const from = path_.shapes + Begin(k, i, 0) * kInner;
          for (int axis = 0; axis < 3; ++axis) {
            for (int t = 0; t < kInner; ++t) {
              to[axis * Step() + kElements * t + i] = from[kInner * axis + t];
            }
          }
        }
        for (int axis = 0; axis < 3; ++axis) {
          std::fill_n(G(k) + axis * Step() + kElements, kElements * kInner, 0.0);
        }
      }
    }
  }

  /// The slots of a vertex's first coordinate; those of the next coordinate are Step() further on.
  SHAPESPACE_INLINE const double* X(int vertex) const {
    if constexpr (kElements > 1) return Gathered(vertex);
    return path_.shapes + Begin(vertex, 0, 0) * path_.stride + scratch_.Begin() - 1;
  }
  /// The same for the gradient, to be added to.
  SHAPESPACE_INLINE double* G(int vertex) const {
    if constexpr (kElements > 1) return scratch_.Row(row_ + 1 + 3 * (kVertices + vertex));
    return path_.gradient + Begin(vertex, 0, 0) * path_.stride + scratch_.Begin() - 1;
  }
  SHAPESPACE_INLINE size_t Step() const {
    return kElements > 1 ? Scratch<kInner>::kRow : path_.stride;
  }

  /// The weight of the element in a slot.
  SHAPESPACE_INLINE double Weight(int slot) const {
    return kElements == 1 ? weight_ : scratch_.Row(row_)[slot];
  }

  /// The path's row of one coordinate of one vertex of one element.
  SHAPESPACE_INLINE size_t Begin(int vertex, int element, int axis) const {
    return 3 * static_cast<size_t>(vertex_[vertex][element]) + axis;
  }

  /// Adds the gradient to the path's.
  SHAPESPACE_INLINE void Store() const {
    if constexpr (kElements > 1) {
      for (int i = 0; i < used_; ++i) {
        for (int k = 0; k < kVertices; ++k) {
          double* const to = path_.gradient + Begin(k, i, 0) * kInner;
          const double* const from = G(k) + kElements + i;
          for (int axis = 0; axis < 3; ++axis) {
            for (int t = 0; t < kInner; ++t) {
              to[kInner * axis + t] += from[axis * Step() + kElements * t];
            }
          }
        }
      }
    }
  }

 private:
  SHAPESPACE_INLINE double* Gathered(int vertex) const {
    return scratch_.Row(row_ + 1 + 3 * vertex);
  }

  const PathRows& path_;
  Scratch<kInner>& scratch_;
  const int row_;
  int used_ = 0;
  int vertex_[kVertices][kElements];
  double weight_ = 0;
};

/// The natural logarithm of a positive normal number, with an error of two units in the last place,
/// in plain arithmetic, so that loops that call it are vectorised. With x = 2^k z, z between 1 /
/// sqrt 2 and sqrt 2, and s = (z - 1) / (z + 1): log x = k log 2 + 2 atanh s, by its series.
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

// The functions below are plain loops over slots that the compiler vectorises: rows do not overlap,
// and energies are summed by slot first, so that no sum has to be reordered.

template <int kInner>
SHAPESPACE_INLINE double EdgeLengths(const PathRows& path, const int* stencils,
                                     const double* weights, int count, double quartic, int begin) {
  constexpr int kElements = Scratch<kInner>::kElements;
  Scratch<kInner> scratch(path, begin);
  const int last = scratch.Last(), end = scratch.End(), end_of_segments = scratch.EndOfSegments();
  const int begin_of_inner = scratch.BeginOfInner(), end_of_inner = scratch.EndOfInner();
  double* const e[3] = {scratch.Row(0), scratch.Row(1), scratch.Row(2)};
  double *const ex = e[0], *const ey = e[1], *const ez = e[2];
  double* const value = scratch.Row(3);
  double* const flow = scratch.Row(4);    // 4 w times the change of value on the previous segment
  double* const spread = scratch.Row(5);  // the same for the quartic part
  double* const sums = scratch.Row(6);
  std::fill(sums, sums + end_of_segments, 0.0);
  Tile<kInner, 2> tile(path, &scratch, 7);
  for (int element = 0; element < count; element += kElements) {
    tile.Load(stencils + 2 * element, weights + element, count - element);
    for (int axis = 0; axis < 3; ++axis) {
      const double *const from = tile.X(0) + axis * tile.Step(), *const to =
                                                                     tile.X(1) + axis * tile.Step();
      double* const d = e[axis];
      SHAPESPACE_INDEPENDENT
      for (int l = begin_of_inner; l < end_of_inner; ++l) d[l] = to[l] - from[l];
      for (int i = 0; i < kElements; ++i) {
        const size_t p = tile.Begin(0, i, axis), q = tile.Begin(1, i, axis);
        if (scratch.AtFirst()) d[i] = path.first[q] - path.first[p];
        if (scratch.AtLast()) d[last + i] = path.last[q] - path.last[p];
      }
    }
    const auto half_square = [&](int l) {
      return 0.5 * (ex[l] * ex[l] + ey[l] * ey[l] + ez[l] * ez[l]);
    };
    SHAPESPACE_INDEPENDENT
    for (int l = begin_of_inner; l < end_of_inner; ++l) value[l] = half_square(l);
    for (int i = 0; i < kElements; ++i) {
      value[i] = half_square(i);
      value[last + i] = half_square(last + i);
    }
    SHAPESPACE_INDEPENDENT
    for (int l = kElements; l < end_of_segments; ++l) {
      const double w = tile.Weight(l), change = value[l] - value[l - kElements];
      flow[l] = 4 * w * change;
      sums[l] += 2 * w * change * change;
    }
    if (quartic > 0) {
      SHAPESPACE_INDEPENDENT
      for (int l = kElements; l < end_of_segments; ++l) {
        const double w = tile.Weight(l), dx = ex[l] - ex[l - kElements],
                     dy = ey[l] - ey[l - kElements], dz = ez[l] - ez[l - kElements];
        const double squared = dx * dx + dy * dy + dz * dz;
        spread[l] = 2 * quartic * w * squared;
        sums[l] += 0.5 * quartic * w * squared * squared;
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      double *const gp = tile.G(0) + axis * tile.Step(), *const gq = tile.G(1) + axis * tile.Step();
      const double* const d = e[axis];
      if (quartic > 0) {
        SHAPESPACE_INDEPENDENT
        for (int l = kElements; l < end; ++l) {
          const double g = (flow[l] - flow[l + kElements]) * d[l] +
                           spread[l] * (d[l] - d[l - kElements]) +
                           spread[l + kElements] * (d[l] - d[l + kElements]);
          gp[l] -= g;
          gq[l] += g;
        }
      } else {
        SHAPESPACE_INDEPENDENT
        for (int l = kElements; l < end; ++l) {
          const double g = (flow[l] - flow[l + kElements]) * d[l];
          gp[l] -= g;
          gq[l] += g;
        }
      }
    }
    tile.Store();
  }
  return scratch.Sum(sums);
}

template <int kInner>
SHAPESPACE_INLINE double Positions(const PathRows& path, const int* stencils, const double* weights,
                                   int count, int begin) {
  constexpr int kElements = Scratch<kInner>::kElements;
  Scratch<kInner> scratch(path, begin);
  const int last = scratch.Last(), end = scratch.End(), end_of_segments = scratch.EndOfSegments();
  const int begin_of_inner = scratch.BeginOfInner(), end_of_inner = scratch.EndOfInner();
  double* const p = scratch.Row(0);
  double* const sums = scratch.Row(1);
  std::fill(sums, sums + end_of_segments, 0.0);
  Tile<kInner, 1> tile(path, &scratch, 2);
  for (int element = 0; element < count; element += kElements) {
    tile.Load(stencils + element, weights + element, count - element);
    for (int axis = 0; axis < 3; ++axis) {
      const double* const x = tile.X(0) + axis * tile.Step();
      double* const g = tile.G(0) + axis * tile.Step();
      SHAPESPACE_INDEPENDENT
      for (int l = begin_of_inner; l < end_of_inner; ++l) p[l] = x[l];
      for (int i = 0; i < kElements; ++i) {
        if (scratch.AtFirst()) p[i] = path.first[tile.Begin(0, i, axis)];
        if (scratch.AtLast()) p[last + i] = path.last[tile.Begin(0, i, axis)];
      }
      SHAPESPACE_INDEPENDENT
      for (int l = kElements; l < end_of_segments; ++l) {
        sums[l] += 2 * tile.Weight(l) * (p[l] - p[l - kElements]) * (p[l] - p[l - kElements]);
      }
      SHAPESPACE_INDEPENDENT
      for (int l = kElements; l < end; ++l) {
        g[l] += 4 * tile.Weight(l) * (2 * p[l] - p[l - kElements] - p[l + kElements]);
      }
    }
    tile.Store();
  }
  return scratch.Sum(sums);
}

// Differences of the inner shapes' points from the first of them: the rows from `row` on, three for
// each of the others.
template <int kInner, int kPoints>
SHAPESPACE_INLINE void SubtractFirstPoint(const Scratch<kInner>& scratch,
                                          const Tile<kInner, kPoints>& tile, double* const* row) {
  const int begin = scratch.BeginOfInner(), end = scratch.EndOfInner();
  for (int k = 1; k < kPoints; ++k) {
    for (int axis = 0; axis < 3; ++axis) {
      const double* const from = tile.X(0) + axis * tile.Step();
      const double* const to = tile.X(k) + axis * tile.Step();
      double* const d = row[3 * (k - 1) + axis];
      SHAPESPACE_INDEPENDENT
      for (int l = begin; l < end; ++l) d[l] = to[l] - from[l];
    }
  }
}

// Sets the rows of `kValues` values at the two ends of the path, which `ends` has for each element.
// Where the last shape is free, its values are those of the shape before.
template <int kValues, int kInner>
SHAPESPACE_INLINE void SetEnds(const PathRows& path, const Scratch<kInner>& scratch,
                               const double* ends, int element, int count,
                               double* const (&values)[kValues]) {
  constexpr int kElements = Scratch<kInner>::kElements;
  const int last = scratch.Last();
  for (int i = 0; i < kElements; ++i) {
    const double* const at = ends + 2 * kValues * std::min(element + i, count - 1);
    for (int k = 0; k < kValues; ++k) {
      double* const v = values[k];
      if (scratch.AtFirst()) v[i] = at[k];
      if (scratch.AtLast()) v[last + i] = path.free_end ? v[last + i - kElements] : at[kValues + k];
    }
  }
}

// F(R) = atanh(sqrt R) / sqrt R and F'(R) for R = (length / m)^2, where 1 - R = determinant / m^2
// and root is the square root of the determinant; for small R by their series.
SHAPESPACE_INLINE void AtanhRatio(double r, double m, double length, double determinant,
                                  double root, double* f, double* slope) {
  constexpr double kSmall = 0.01;
  const double safe = r < kSmall ? m : length;
  const double general = m / safe * Log((m + length) / root);
  const double one_less = m * m / determinant;  // 1 / (1 - R)
  const double general_slope = 0.5 * (one_less - general) * (m * m) / (safe * safe);
  const double series =
      1 +
      r * (1.0 / 3 +
           r * (1.0 / 5 +
                r * (1.0 / 7 + r * (1.0 / 9 + r * (1.0 / 11 + r * (1.0 / 13 + r * (1.0 / 15)))))));
  const double series_slope =
      1.0 / 3 +
      r * (2.0 / 5 +
           r * (3.0 / 7 +
                r * (4.0 / 9 + r * (5.0 / 11 + r * (6.0 / 13 + r * (7.0 / 15 + r * (8.0 / 17)))))));
  *f = r < kSmall ? series : general;
  *slope = r < kSmall ? series_slope : general_slope;
}

// With normals n1 = e x u, n2 = v x e of the two triangles (e = b - a, u = c - a, v = d - a) and n1
// x n2 = -(n1 . v) e, the functor's values are
//   cos = R n1 . n2,  sin = -R H n1 . v,  R = 1 / (|n1| |n2|),  H = |e|^2 / |e|,
// with all lengths regularised. This takes two roots and two divisions per hinge instead of three
// each.
template <int kInner>
SHAPESPACE_INLINE double Dihedrals(const PathRows& path, const int* stencils, const double* weights,
                                   const double* ends, int count, double normal_epsilon_squared,
                                   double edge_epsilon_squared, int begin) {
  constexpr int kElements = Scratch<kInner>::kElements;
  Scratch<kInner> scratch(path, begin);
  const int end = scratch.End(), end_of_segments = scratch.EndOfSegments();
  const int begin_of_inner = scratch.BeginOfInner(), end_of_inner = scratch.EndOfInner();
  double* row[25];
  for (int i = 0; i < 25; ++i) row[i] = scratch.Row(i);
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
  std::fill(sums, sums + end_of_segments, 0.0);
  Tile<kInner, 4> tile(path, &scratch, 24);
  for (int element = 0; element < count; element += kElements) {
    tile.Load(stencils + 4 * element, weights + element, count - element);
    SubtractFirstPoint(scratch, tile, row);
    SHAPESPACE_INDEPENDENT
    for (int l = begin_of_inner; l < end_of_inner; ++l) {
      const double nx = ey[l] * uz[l] - ez[l] * uy[l];
      const double ny = ez[l] * ux[l] - ex[l] * uz[l];
      const double nz = ex[l] * uy[l] - ey[l] * ux[l];
      const double mx = vy[l] * ez[l] - vz[l] * ey[l];
      const double my = vz[l] * ex[l] - vx[l] * ez[l];
      const double mz = vx[l] * ey[l] - vy[l] * ex[l];
      const double length = ex[l] * ex[l] + ey[l] * ey[l] + ez[l] * ez[l];
      const double n1 = nx * nx + ny * ny + nz * nz + normal_epsilon_squared;
      const double n2 = mx * mx + my * my + mz * mz + normal_epsilon_squared;
      const double r = 1 / std::sqrt(n1 * n2);
      const double over = 1 / std::sqrt(length + edge_epsilon_squared);
      const double volume = nx * vx[l] + ny * vy[l] + nz * vz[l];
      ax[l] = nx, ay[l] = ny, az[l] = nz;
      bx[l] = mx, by[l] = my, bz[l] = mz;
      q1[l] = n1, q2[l] = n2;
      inverse[l] = r, edge[l] = over, height[l] = length * over, triple[l] = volume;
      cosine[l] = r * (nx * mx + ny * my + nz * mz);
      sine[l] = -r * length * over * volume;
    }
    SetEnds<2>(path, scratch, ends, element, count, {cosine, sine});
    SHAPESPACE_INDEPENDENT
    for (int l = kElements; l < end_of_segments; ++l) {
      const double w = tile.Weight(l);
      const double dc = cosine[l] - cosine[l - kElements], ds = sine[l] - sine[l - kElements];
      sums[l] += 2 * w * (dc * dc + ds * ds);
    }

    const size_t step = tile.Step();
    double* const g[] = {tile.G(0), tile.G(1), tile.G(2), tile.G(3)};
    SHAPESPACE_INDEPENDENT
    for (int l = kElements; l < end; ++l) {
      const double w = tile.Weight(l);
      const double fc = 4 * w * (2 * cosine[l] - cosine[l - kElements] - cosine[l + kElements]);
      const double fs = 4 * w * (2 * sine[l] - sine[l - kElements] - sine[l + kElements]);
      const double r = inverse[l];
      const double along = (fc * cosine[l] + fs * sine[l]) * r * r;
      const double along1 = along * q2[l], along2 = along * q1[l];
      const double c = fc * r, s = fs * r * height[l];
      // Derivatives with respect to n1 and n2 ...
      const double px = c * bx[l] - s * vx[l] - along1 * ax[l];
      const double py = c * by[l] - s * vy[l] - along1 * ay[l];
      const double pz = c * bz[l] - s * vz[l] - along1 * az[l];
      const double qx = c * ax[l] - along2 * bx[l];
      const double qy = c * ay[l] - along2 * by[l];
      const double qz = c * az[l] - along2 * bz[l];
      // ... and through the cross products with respect to u, v and e.
      const double gux = py * ez[l] - pz * ey[l];
      const double guy = pz * ex[l] - px * ez[l];
      const double guz = px * ey[l] - py * ex[l];
      const double gvx = ey[l] * qz - ez[l] * qy - s * ax[l];
      const double gvy = ez[l] * qx - ex[l] * qz - s * ay[l];
      const double gvz = ex[l] * qy - ey[l] * qx - s * az[l];
      const double h = -fs * triple[l] * r * edge[l] * (2 - height[l] * edge[l]);
      const double gex = h * ex[l] + uy[l] * pz - uz[l] * py + qy * vz[l] - qz * vy[l];
      const double gey = h * ey[l] + uz[l] * px - ux[l] * pz + qz * vx[l] - qx * vz[l];
      const double gez = h * ez[l] + ux[l] * py - uy[l] * px + qx * vy[l] - qy * vx[l];
      g[0][l] -= gex + gux + gvx;
      g[0][l + step] -= gey + guy + gvy;
      g[0][l + 2 * step] -= gez + guz + gvz;
      g[1][l] += gex;
      g[1][l + step] += gey;
      g[1][l + 2 * step] += gez;
      g[2][l] += gux;
      g[2][l + step] += guy;
      g[2][l + 2 * step] += guz;
      g[3][l] += gvx;
      g[3][l + step] += gvy;
      g[3][l + 2 * step] += gvz;
    }
    tile.Store();
  }
  return scratch.Sum(sums);
}

// The kNumbers numbers of each of a tile's elements.
template <int kInner, int kNumbers>
class TileNumbers {
 public:
  static constexpr int kElements = Scratch<kInner>::kElements;

  /// Uses kNumbers scratch rows from `row` on; for single elements none.
  SHAPESPACE_INLINE TileNumbers(Scratch<kInner>* scratch, int row)
      : scratch_(*scratch), row_(row) {}

  /// Loads those of the first elements of `count`.
  SHAPESPACE_INLINE void Load(const double* numbers, int count) {
    for (int k = 0; k < kNumbers; ++k) single_[k] = numbers[k];
    if constexpr (kElements > 1) {
      for (int i = 0; i < kElements; ++i) {
        const double* const from = numbers + kNumbers * std::min(i, count - 1);
        for (int k = 0; k < kNumbers; ++k) {
          for (int t = 0; t < kInner + 2; ++t) scratch_.Row(row_ + k)[kElements * t + i] = from[k];
        }
      }
    }
  }

  /// Number k of the element in a slot.
  SHAPESPACE_INLINE double At(int k, int slot) const {
    return kElements == 1 ? single_[k] : scratch_.Row(row_ + k)[slot];
  }

 private:
  Scratch<kInner>& scratch_;
  const int row_;
  double single_[kNumbers];
};

// With a and b the edges q - p and r - p as they would be if the triangle at rest were equilateral,
// the values depend on aa = |a|^2, ab = a . b and bb = |b|^2 only. Names are those of the functor
// (metric/triangle_strain.h).
template <int kInner>
SHAPESPACE_INLINE double TriangleStrains(const PathRows& path, const int* stencils,
                                         const double* weights, const double* numbers,
                                         const double* ends, int count, double epsilon_squared,
                                         int begin) {
  constexpr int kElements = Scratch<kInner>::kElements;
  Scratch<kInner> scratch(path, begin);
  const int end = scratch.End(), end_of_segments = scratch.EndOfSegments();
  const int begin_of_inner = scratch.BeginOfInner(), end_of_inner = scratch.EndOfInner();
  double* row[20];
  for (int i = 0; i < 20; ++i) row[i] = scratch.Row(i);
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
  std::fill(sums, sums + end_of_segments, 0.0);
  Tile<kInner, 3> tile(path, &scratch, 20);
  TileNumbers<kInner, 4> rest(&scratch, 39);
  for (int element = 0; element < count; element += kElements) {
    tile.Load(stencils + 3 * element, weights + element, count - element);
    rest.Load(numbers + 4 * element, count - element);
    SubtractFirstPoint(scratch, tile, row);
    SHAPESPACE_INDEPENDENT
    for (int l = begin_of_inner; l < end_of_inner; ++l) {
      const double r0 = rest.At(0, l), r1 = rest.At(1, l), r2 = rest.At(2, l), r3 = rest.At(3, l);
      const double ux = ax[l], uy = ay[l], uz = az[l], vx = bx[l], vy = by[l], vz = bz[l];
      ax[l] = r0 * ux + r1 * vx, ay[l] = r0 * uy + r1 * vy, az[l] = r0 * uz + r1 * vz;
      bx[l] = r2 * ux + r3 * vx, by[l] = r2 * uy + r3 * vy, bz[l] = r2 * uz + r3 * vz;
      const double aa = ax[l] * ax[l] + ay[l] * ay[l] + az[l] * az[l];
      const double ab = ax[l] * bx[l] + ay[l] * by[l] + az[l] * bz[l];
      const double bb = bx[l] * bx[l] + by[l] * by[l] + bz[l] * bz[l];
      const double nx = ay[l] * bz[l] - az[l] * by[l];
      const double ny = az[l] * bx[l] - ax[l] * bz[l];
      const double nz = ax[l] * by[l] - ay[l] * bx[l];
      const double mean = 2 * kThird * (aa + bb - ab);
      const double d = kThird * (aa + 2 * (ab - bb)), o = kRoot3 * (2 * ab - aa);
      const double m = mean + epsilon_squared;
      const double determinant = 4 * kThird * (nx * nx + ny * ny + nz * nz) +
                                 (2 * mean + epsilon_squared) * epsilon_squared;
      const double squared = d * d + o * o, reciprocal = 1 / m;
      const double r = squared * reciprocal * reciprocal;
      const double length = std::sqrt(squared), root = std::sqrt(determinant);
      double f, f_slope;
      AtanhRatio(r, m, length, determinant, root, &f, &f_slope);
      const double s = 0.5 * M_SQRT1_2 * f * reciprocal;
      saa[l] = aa, sab[l] = ab, sbb[l] = bb;
      sd[l] = d, so[l] = o, sm[l] = reciprocal;
      inverse[l] = 1 / determinant;
      slope[l] = s;
      turn[l] = M_SQRT1_2 * f_slope * reciprocal;
      ratio[l] = r;
      v0[l] = 0.25 * Log(determinant);
      v1[l] = s * d;
      v2[l] = s * o;
    }
    SetEnds<3>(path, scratch, ends, element, count, {v0, v1, v2});
    SHAPESPACE_INDEPENDENT
    for (int l = kElements; l < end_of_segments; ++l) {
      const double w = tile.Weight(l);
      const double d0 = v0[l] - v0[l - kElements], d1 = v1[l] - v1[l - kElements],
                   d2 = v2[l] - v2[l - kElements];
      sums[l] += 2 * w * (d0 * d0 + d1 * d1 + d2 * d2);
    }

    const size_t step = tile.Step();
    double* const g[] = {tile.G(0), tile.G(1), tile.G(2)};
    SHAPESPACE_INDEPENDENT
    for (int l = kElements; l < end; ++l) {
      const double w = tile.Weight(l);
      const double f0 = 4 * w * (2 * v0[l] - v0[l - kElements] - v0[l + kElements]);
      const double f1 = 4 * w * (2 * v1[l] - v1[l - kElements] - v1[l + kElements]);
      const double f2 = 4 * w * (2 * v2[l] - v2[l - kElements] - v2[l + kElements]);
      // Derivatives with respect to the determinant, d, o and the mean m ...
      const double by_determinant = kThird * f0 * inverse[l];
      const double sum = (f1 * sd[l] + f2 * so[l]) * sm[l];
      const double by_d = slope[l] * f1 + sum * turn[l] * sd[l] * sm[l];
      const double by_o = kRoot3 * (slope[l] * f2 + sum * turn[l] * so[l] * sm[l]);
      const double by_m = -2 * kThird * sum * (turn[l] * ratio[l] + slope[l]);
      // ... to aa, bb and ab, and so to a, b and the edges.
      const double by_aa =
          by_m + kThird * by_d - by_o + by_determinant * (sbb[l] + epsilon_squared);
      const double by_bb = by_m - 2 * kThird * by_d + by_determinant * (saa[l] + epsilon_squared);
      const double by_ab =
          -by_m + 2 * kThird * by_d + 2 * by_o - by_determinant * (2 * sab[l] + epsilon_squared);
      const double ux = 2 * by_aa * ax[l] + by_ab * bx[l], vx = 2 * by_bb * bx[l] + by_ab * ax[l];
      const double uy = 2 * by_aa * ay[l] + by_ab * by[l], vy = 2 * by_bb * by[l] + by_ab * ay[l];
      const double uz = 2 * by_aa * az[l] + by_ab * bz[l], vz = 2 * by_bb * bz[l] + by_ab * az[l];
      const double r0 = rest.At(0, l), r1 = rest.At(1, l), r2 = rest.At(2, l), r3 = rest.At(3, l);
      const double qx = r0 * ux + r2 * vx, rx = r1 * ux + r3 * vx;
      const double qy = r0 * uy + r2 * vy, ry = r1 * uy + r3 * vy;
      const double qz = r0 * uz + r2 * vz, rz = r1 * uz + r3 * vz;
      g[0][l] -= qx + rx;
      g[0][l + step] -= qy + ry;
      g[0][l + 2 * step] -= qz + rz;
      g[1][l] += qx;
      g[1][l + step] += qy;
      g[1][l + 2 * step] += qz;
      g[2][l] += rx;
      g[2][l + step] += ry;
      g[2][l + 2 * step] += rz;
    }
    tile.Store();
  }
  return scratch.Sum(sums);
}

// Calls kernel(kInner, begin) for every window of the path and adds the results.
template <typename Kernel>
SHAPESPACE_INLINE double ForWindows(const PathRows& path, const Kernel& kernel) {
  static_assert(kFewShapes == 4);
  switch (path.inner) {
    case 1:
      return kernel(std::integral_constant<int, 1>(), 0);
    case 2:
      return kernel(std::integral_constant<int, 2>(), 0);
    case 3:
      return kernel(std::integral_constant<int, 3>(), 0);
    case 4:
      return kernel(std::integral_constant<int, 4>(), 0);
    default:
      break;
  }
  double sum = 0;
  for (int begin = 0; begin < path.inner; begin += kWindow) {
    sum += kernel(std::integral_constant<int, 0>(), begin);
  }
  return sum;
}

}  // namespace

// Function multiversioning does not work for templates.

SHAPESPACE_CLONES
double EdgeLengthKernel(const PathRows& path, const int* stencils, const double* weights, int count,
                        double quartic) {
  return ForWindows(
      path, [&](auto inner, int begin) __attribute__((always_inline)) {
        return EdgeLengths<inner>(path, stencils, weights, count, quartic, begin);
      });
}

SHAPESPACE_CLONES
double PositionKernel(const PathRows& path, const int* stencils, const double* weights, int count) {
  return ForWindows(
      path, [&](auto inner, int begin) __attribute__((always_inline)) {
        return Positions<inner>(path, stencils, weights, count, begin);
      });
}

SHAPESPACE_CLONES
double DihedralKernel(const PathRows& path, const int* stencils, const double* weights,
                      const double* ends, int count, double normal_epsilon_squared,
                      double edge_epsilon_squared) {
  return ForWindows(
      path, [&](auto inner, int begin) __attribute__((always_inline)) {
        return Dihedrals<inner>(path, stencils, weights, ends, count, normal_epsilon_squared,
                                edge_epsilon_squared, begin);
      });
}

SHAPESPACE_CLONES
double TriangleStrainKernel(const PathRows& path, const int* stencils, const double* weights,
                            const double* numbers, const double* ends, int count,
                            double epsilon_squared) {
  return ForWindows(
      path, [&](auto inner, int begin) __attribute__((always_inline)) {
        return TriangleStrains<inner>(path, stencils, weights, numbers, ends, count,
                                      epsilon_squared, begin);
      });
}

SHAPESPACE_CLONES
void AddVolumes(const PathRows& rows, const int* stencils, int count, double reference,
                double* values) {
  const int stride = rows.stride;
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
    for (int t = 0; t < rows.inner; ++t) {
      values[t + 1] += scale * (p[0][t] * (q[1][t] * r[2][t] - q[2][t] * r[1][t]) +
                                p[1][t] * (q[2][t] * r[0][t] - q[0][t] * r[2][t]) +
                                p[2][t] * (q[0][t] * r[1][t] - q[1][t] * r[0][t]));
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
  values[rows.inner + 1] += scale * ends[1];
}

SHAPESPACE_CLONES
void AddVolumeGradients(const PathRows& rows, const int* stencils, int count, double reference,
                        const double* slopes) {
  const int stride = rows.stride;
  const double scale = 1 / (6 * reference);
  for (int element = 0; element < count; ++element) {
    // The derivative with respect to each corner is the cross product of the next two.
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
        for (int t = 0; t < rows.inner; ++t) {
          g[t] += scale * slopes[t + 1] * (q1[t] * r2[t] - q2[t] * r1[t]);
        }
      }
    }
  }
}

}  // namespace shapespace::internal
