#ifndef SHAPESPACE_PATH_ENERGY_H_
#define SHAPESPACE_PATH_ENERGY_H_

#include <memory>
#include <vector>

#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>

namespace shapespace {
namespace internal {
struct ElementGroup;
struct PathRows;
}  // namespace internal

/// The energy of a path of shapes and its gradient, on flat arrays: the low-level interface for
/// users with their own optimiser.
///
/// For features Phi it is E = 2 sum_i |Phi(P_{i+1}) - Phi(P_i)|^2, the midpoint form of the paper's
/// (6) (docs/mathematics.md); the trapezoid and rigid metrics have forms of their own. The first
/// shape is fixed, and so is the last, unless its end is free. The unknowns are one array of
/// `Size()` doubles: row 3 r + axis, with `Stride()` numbers, contains one coordinate of one vertex
/// in all inner shapes, consecutive in time (a free last shape counts as an inner one); r =
/// Row(vertex) is an order of the vertices in which neighbours are close. Numbers after `Inner()`
/// in a row are padding: finite in the unknowns (`Load` sets zeros), undefined in a gradient.
///
/// An object is used for one solve at a time; `Evaluate` uses all threads, and its result is
/// bitwise identical for any number of them.
class PathEnergy {
 public:
  enum class End {
    kFixed,  ///< the last shape stays as given to `Load`
    kFree,   ///< the last shape is an unknown too
  };

  /// \throw InvalidOptions if `inner` < 1.
  PathEnergy(std::shared_ptr<const Metric> metric, int inner, End end = End::kFixed);
  PathEnergy(PathEnergy&&) noexcept;
  ~PathEnergy();

  int Inner() const { return inner_; }
  /// Shapes of the whole path: Inner() and the fixed ones.
  int NumShapes() const { return inner_ + (end_ == End::kFree ? 1 : 2); }
  int Stride() const { return stride_; }
  size_t Size() const { return 3 * row_of_vertex_.size() * static_cast<size_t>(stride_); }
  int Row(int vertex) const { return row_of_vertex_[vertex]; }

  /// Prepares for paths of another number of inner shapes; `Load` is to be called next. Faster than
  /// a new object, because the order of vertices and elements is kept.
  /// \throw InvalidOptions if `inner` < 1.
  void SetInner(int inner);

  /// Weight of the quartic part that distinguishes the trapezoid from the midpoint; 1 is (6). A
  /// solve with fewer shapes that prepares another one needs less, otherwise its result is biased.
  void SetQuarticWeight(double weight) { quartic_weight_ = weight; }

  /// Copies `shapes` (NumShapes() of them, in the metric's unit) to `unknowns` (Size() doubles,
  /// with zero padding) and stores the fixed ones.
  /// \throw MeshError on wrong sizes.
  void Load(const std::vector<Shape>& shapes, double* unknowns);

  /// Copies the unknowns to the inner ones of `shapes`.
  void Store(const double* unknowns, std::vector<Shape>* shapes) const;

  /// Returns the energy and, unless null, fills `gradient` (Size() doubles).
  double Evaluate(const double* unknowns, double* gradient);

  /// Each feature's part of the energy, in the metric's order, followed by the rigid part if there
  /// is one; evaluates the energy again.
  std::vector<double> Parts(const double* unknowns);

  /// Memory in bytes of an object for this metric, all of its features included, and this number of
  /// inner shapes.
  static double EstimateBytes(const Metric& metric, int inner);

 private:
  // Elements are grouped by the blocks of rows that they use: within one block, across one border
  // to the next block (even and odd borders separately), or others. Groups of one phase share no
  // row.
  static constexpr int kPhases = 4;
  struct Term;  // of the feature with the same index

  struct GroupPlace {
    int phase, group;
  };

  void CheckNumber(const std::vector<Shape>& shapes) const;
  static GroupPlace PlaceOf(int low, int high);
  int NumGroups(int phase) const;
  int FirstRow(int block) const;
  Term MakeTerm(const std::shared_ptr<const Feature>& feature) const;
  std::vector<double> EvaluateParts(const double* unknowns, double* gradient);
  double EvaluateSum(const Term& term, const double* unknowns, double* gradient) const;
  double EvaluateRigid(const double* unknowns, double* gradient);
  double* Sink(double* gradient);
  internal::PathRows Rows(const double* unknowns, double* gradient) const;
  /// An entry of a row at time t in 0 .. inner + 1, including the ends.
  double At(const double* unknowns, size_t row, int t) const {
    return t == 0 ? first_[row] : t > inner_ ? last_[row] : unknowns[row * stride_ + t - 1];
  }

  std::shared_ptr<const Metric> metric_;
  const End end_;
  int inner_ = 0, stride_ = 0, blocks_ = 0;
  double quartic_weight_ = 1;
  std::vector<int> row_of_vertex_, vertex_of_row_;
  // The ends, by row. If the end is free, the last shape is repeated after itself: the segment
  // between the two has no length, no energy and no gradient.
  std::vector<double> first_, last_;
  std::vector<Term> terms_;
  std::vector<double> rigid_weights_;  // by row
  std::vector<double> sink_;           // receives the gradient if the caller wants none
};

/// Lower bound of the energy over all paths of `segments` segments from `first` to `last` (metric's
/// unit), computed by feature; NaN if the metric has a rigid part, for which no bound is known. The
/// bound is valid for the trapezoid too, which is never less than the midpoint form.
double EnergyLowerBound(const Metric& metric, const Shape& first, const Shape& last, int segments);

/// The square root of the bound above for one segment, for each two consecutive `shapes` (metric's
/// unit; two at least); NaN if the metric has a rigid part. The energy of a path in the midpoint
/// form is the sum of their squares.
std::vector<double> ChordLengths(const Metric& metric, const std::vector<Shape>& shapes);

/// The squared length of each segment between consecutive `shapes` (metric's unit), in the form in
/// which the metric has it; the energy is twice their sum.
/// \throw MeshError on wrong sizes.
std::vector<double> SquaredLengths(const std::shared_ptr<const Metric>& metric,
                                   const std::vector<Shape>& shapes);

/// An energy E of n segments is reported as E n / 2, which converges, as shapes are inserted, to
/// the integral of the squared speed over the unit interval.
inline double ScaledEnergy(double energy, int segments) { return 0.5 * segments * energy; }

}  // namespace shapespace

#endif  // SHAPESPACE_PATH_ENERGY_H_
