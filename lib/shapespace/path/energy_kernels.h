#ifndef SHAPESPACE_PATH_ENERGY_KERNELS_H_
#define SHAPESPACE_PATH_ENERGY_KERNELS_H_

namespace shapespace::internal {

/// A path as the kernels see it: row 3 v + axis holds that coordinate of vertex v in all inner
/// shapes, time innermost, `stride` >= `inner` numbers a row, of which the rest is padding.
struct PathRows {
  const double* shapes;
  double* gradient;     ///< same layout, added to; what the padding receives means nothing
  const double* first;  ///< one number a row: the end shapes, which do not move
  const double* last;
  int inner;
  int stride;
  bool free_end;  ///< `last` repeats the last of the inner shapes, of which nothing goes on
};

/// Up to so many inner shapes the kernels fill their registers with several elements, for which no
/// padding is wanted: stride = inner.
inline constexpr int kFewShapes = 4;

// Each kernel treats elements [0, count): adds the gradient of 2 sum w |Phi_{i+1} - Phi_i|^2 and
// returns its value. `stencils` holds kVertices vertices an element. They repeat, in closed form,
// what the functors in metric/ define; tests hold both equal.

/// EdgeLength. With `quartic` > 0 adds quartic * w |e_{i+1} - e_i|^4 / 2, which makes the midpoint
/// form the paper's trapezoid (6).
double EdgeLengthKernel(const PathRows& rows, const int* stencils, const double* weights, int count,
                        double quartic);

double PositionKernel(const PathRows& rows, const int* stencils, const double* weights, int count);

/// `ends` holds the functor's two values at the first and at the last shape, 4 numbers an element.
/// Those at the last are not read if the end is free.
double DihedralKernel(const PathRows& rows, const int* stencils, const double* weights,
                      const double* ends, int count, double normal_epsilon_squared,
                      double edge_epsilon_squared);

/// `ends` holds the functor's three values at the first and at the last shape, 6 numbers an
/// element. Those at the last are not read if the end is free.
double TriangleStrainKernel(const PathRows& rows, const int* stencils, const double* weights,
                            const double* ends, int count, double epsilon_squared);

/// Volume: adds to `values`, inner + 2 numbers, what elements [0, count) enclose at each time.
void AddVolumes(const PathRows& rows, const int* stencils, int count, double reference,
                double* values);
/// Adds the gradient of sum_t slopes[t] V_t over the inner times, `slopes` as long as `values`.
void AddVolumeGradients(const PathRows& rows, const int* stencils, int count, double reference,
                        const double* slopes);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_PATH_ENERGY_KERNELS_H_
