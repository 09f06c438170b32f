#ifndef SHAPESPACE_PATH_DETAIL_ENERGY_KERNELS_H_
#define SHAPESPACE_PATH_DETAIL_ENERGY_KERNELS_H_

namespace shapespace::internal {

/// A path in the kernels' layout: row 3 v + axis contains that coordinate of vertex v in all inner
/// shapes, consecutive in time; a row has `stride` >= `inner` numbers, the rest is padding.
struct PathRows {
  const double* shapes;
  double* gradient;     ///< same layout, added to; undefined in the padding
  const double* first;  ///< one number per row: the end shapes, which do not move
  const double* last;
  int inner;
  int stride;
  bool free_end;  ///< `last` repeats the last inner shape, and the segment between the two has no
                  ///< energy
};

/// Up to this number of inner shapes the kernels fill their registers with several elements, and
/// rows have no padding: stride = inner.
inline constexpr int kFewShapes = 4;

// Each kernel processes elements [0, count): adds the gradient of 2 sum w |Phi_{i+1} - Phi_i|^2 and
// returns its value. `stencils` contains kVertices vertices per element. They implement, in closed
// form, the functors in metric/; tests compare the two.

/// EdgeLength. With `quartic` > 0 adds quartic * w |e_{i+1} - e_i|^4 / 2, which makes the midpoint
/// form the paper's trapezoid (6).
double EdgeLengthKernel(const PathRows& rows, const int* stencils, const double* weights, int count,
                        double quartic);

double PositionKernel(const PathRows& rows, const int* stencils, const double* weights, int count);

/// `ends` contains the functor's two values at the first and at the last shape, 4 numbers per
/// element. Those at the last are not used if the end is free.
double DihedralKernel(const PathRows& rows, const int* stencils, const double* weights,
                      const double* ends, int count, double normal_epsilon_squared,
                      double edge_epsilon_squared);

/// `numbers` contains the functor's four numbers of each element, `ends` its three values at the
/// first and at the last shape, 6 numbers per element. Those at the last are not used if the end is
/// free.
double TriangleStrainKernel(const PathRows& rows, const int* stencils, const double* weights,
                            const double* numbers, const double* ends, int count,
                            double epsilon_squared);

/// Volume: adds the volume of elements [0, count) at each time to `values`, inner + 2 numbers.
void AddVolumes(const PathRows& rows, const int* stencils, int count, double reference,
                double* values);
/// Adds the gradient of sum_t slopes[t] V_t over the inner times, `slopes` as long as `values`.
void AddVolumeGradients(const PathRows& rows, const int* stencils, int count, double reference,
                        const double* slopes);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_PATH_DETAIL_ENERGY_KERNELS_H_
