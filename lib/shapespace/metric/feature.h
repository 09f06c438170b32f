#ifndef SHAPESPACE_METRIC_FEATURE_H_
#define SHAPESPACE_METRIC_FEATURE_H_

#include <memory>
#include <string>
#include <typeinfo>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/shape.h>

namespace shapespace {

/// Base of the structs that define features. A feature is one component of the map Phi whose
/// pull-back is the metric (docs/mathematics.md, section 1). It maps the vertices of every element
/// (an edge, a triangle, ...) to a few values, and the element adds weight * |change of these
/// values|^2 to the cost of a motion. A struct that derives from this has
///
///      static constexpr const char* kName        its name, in files and reports,
///      template <typename T> void operator()(const T* x, T* value) const
///                                                its values: x has kVertices x 3 coordinates,
///                                                vertex after vertex, value kValues numbers,
///
/// and may redefine any of the members below. T is double or a scalar with derivatives (ceres::Jet
/// and LineJet), so mathematical functions must be called unqualified, after `using std::sqrt;` and
/// so on. `static Struct Freeze(const MetricBasis& basis)` returns the feature on a mesh and some
/// poses of it. define_feature.h makes a `Feature` of such a struct, and docs/guide/features.md has
/// a complete example.
///
/// An element may have numbers of its own, such as its shape at rest; they follow the coordinates
/// in x, and values are not differentiated by them.
template <int kElementVertices, int kElementValues, int kElementNumbers = 0>
struct ElementFeature {
  static constexpr int kVertices = kElementVertices, kValues = kElementValues,
                       kNumbers = kElementNumbers, kInputs = 3 * kVertices + kNumbers;

  /// Whether the values are invariant under rigid motion of the whole shape. If so, solvers remove
  /// rigid motion from paths exactly.
  static constexpr bool kRigidInvariant = true;
  /// Whether the values of all elements are added before they are squared, as for the volume. Then
  /// kValues is 1, and `weights` has one entry.
  static constexpr bool kSum = false;
  /// Whether the struct has, beside the automatic derivatives of its values, faster ones of its
  /// own, which the library's kernels use and Ceres' cost functions do not:
  ///
  ///      void Derivatives(const double* x, double* value, double* derivative) const
  ///
  /// computes the values and their derivatives: by vertex, by value, three numbers each.
  static constexpr bool kHasDerivatives = false;
  /// Number of vectors of `ScalarRows`; 0 means that they are computed from the derivative.
  static constexpr int kScalarRows = 0;

  Eigen::Matrix<int, kVertices, Eigen::Dynamic> stencils;   ///< one column per element
  Eigen::VectorXd weights;                                  ///< one per element, not negative
  Eigen::Matrix<double, kNumbers, Eigen::Dynamic> numbers;  ///< one column per element

  /// The minimum of sum_i |Phi_{i+1} - Phi_i|^2 over all paths of `segments` segments from value a
  /// to value b: the element's contribution to the lower bound. The straight chord is valid for any
  /// feature.
  double LeastChange(const double* a, const double* b, int segments) const {
    double sum = 0;
    for (int k = 0; k < kValues; ++k) sum += (b[k] - a[k]) * (b[k] - a[k]);
    return sum / segments;
  }

  /// kScalarRows vectors k, stored one after the other, each with one number per vertex, such that
  /// the sum of w k k^T approximates the metric's matrix for each axis; the preconditioner is
  /// assembled from them. x contains the element's vertices.
  void ScalarRows(const Eigen::Vector3d* /*x*/, double* /*k*/) const {}

  /// Calls visit(name, number) for each number of the feature as a whole; they are stored in files.
  /// A struct with such numbers redefines this template.
  template <typename Self, typename Visit>
  static void ForConstants(Self* /*self*/, const Visit& /*visit*/) {}
};

/// Copies the coordinates of `element`'s vertices from a shape, vertex after vertex, and its
/// numbers: kInputs in all.
template <typename Struct>
void GatherCoordinates(const Struct& feature, int element, const Shape& shape, double* x) {
  for (int k = 0; k < Struct::kVertices; ++k) {
    Eigen::Map<Eigen::Vector3d>(x + 3 * k) = shape.col(feature.stencils(k, element));
  }
  for (int k = 0; k < Struct::kNumbers; ++k) {
    x[3 * Struct::kVertices + k] = feature.numbers(k, element);
  }
}

/// A feature of any struct (see `ElementFeature`), in the form used by the library and the solvers.
/// Virtual functions process many elements per call, so that their overhead is negligible.
/// Immutable; made by `MakeFeature`.
class Feature {
 public:
  /// Limits on a struct's vertices, values, and coordinates and numbers together, because buffers
  /// of this size are on the stack.
  static constexpr int kMaxVertices = 8, kMaxValues = 8, kMaxInputs = 3 * kMaxVertices + 4;

  virtual ~Feature() = default;
  Feature(const Feature&) = delete;
  Feature& operator=(const Feature&) = delete;

  const std::string& Name() const { return name_; }
  int VerticesPerElement() const { return vertices_; }
  int ValuesPerElement() const { return values_; }
  int NumbersPerElement() const { return numbers_per_element_; }
  /// Coordinates and numbers.
  int InputsPerElement() const { return 3 * vertices_ + numbers_per_element_; }
  int NumElements() const { return num_elements_; }
  bool IsSum() const { return is_sum_; }
  bool IsRigidInvariant() const { return is_rigid_invariant_; }

  /// The vertices of an element, VerticesPerElement() numbers.
  const int* Element(int element) const { return stencils_ + vertices_ * element; }
  /// Whether there are NumbersPerElement() numbers for each element; a metric's features have them.
  bool HasNumbers() const {
    return numbers_per_element_ * num_elements_ == 0 || numbers_ != nullptr;
  }
  /// The numbers of an element, NumbersPerElement() of them.
  const double* Numbers(int element) const { return numbers_ + numbers_per_element_ * element; }
  /// One number per element; for a sum feature one number.
  const Eigen::VectorXd& Weights() const { return *weights_; }
  double Weight(int element) const { return (*weights_)(is_sum_ ? 0 : element); }
  /// Number of values of the feature in Phi.
  int NumValues() const { return is_sum_ ? 1 : values_ * num_elements_; }

  /// The coordinates and the numbers of elements [begin, end), InputsPerElement() for each.
  void GatherCoordinates(int begin, int end, const Shape& shape, double* x) const;

  /// The values, without weights, of `count` elements with coordinates and numbers x, and, unless
  /// null, their derivatives: by element, by vertex, by value, three numbers each.
  virtual void Evaluate(int count, const double* x, double* values,
                        double* derivatives = nullptr) const = 0;
  /// The same, but the derivatives are always those of the values by automatic differentiation,
  /// even if the struct has derivatives of its own (kHasDerivatives). Ceres' cost functions
  /// evaluate this. Unless overridden, it is `Evaluate`: features of Python's have no values to
  /// differentiate.
  virtual void Differentiate(int count, const double* x, double* values,
                             double* derivatives = nullptr) const;
  /// The second derivative of the values along the line x + s along, at s = 0. Both have the layout
  /// of GatherCoordinates; the numbers do not change along the line.
  virtual void SecondDerivatives(int count, const double* x, const double* along,
                                 double* values) const = 0;
  /// The sum of weight * LeastChange over `count` elements with values a and b at the ends.
  virtual double LeastChange(int count, const double* a, const double* b, const double* weights,
                             int segments) const = 0;
  /// ScalarRows of `count` elements, NumScalarRows() vectors each. Unless overridden, they are
  /// 3 ValuesPerElement() and computed from the derivative.
  virtual void ScalarRows(int count, const double* x, double* rows) const;
  int NumScalarRows() const { return scalar_rows_; }
  /// The constants of the feature as a whole, by name.
  virtual std::vector<std::pair<std::string, double>> Constants() const = 0;

  /// The struct from which this feature was made, if it is a `Struct`; else null.
  template <typename Struct>
  const Struct* As() const {
    return static_cast<const Struct*>(StructIf(typeid(Struct)));
  }

 protected:
  Feature() = default;
  virtual const void* StructIf(const std::type_info& type) const = 0;

  std::string name_;
  int vertices_ = 0, values_ = 0, numbers_per_element_ = 0, num_elements_ = 0, scalar_rows_ = 0;
  bool is_sum_ = false, is_rigid_invariant_ = true;
  const int* stencils_ = nullptr;             // of the struct in the derived class
  const double* numbers_ = nullptr;           // the same; null if there are too few
  const Eigen::VectorXd* weights_ = nullptr;  // of the struct in the derived class
};

}  // namespace shapespace

#endif  // SHAPESPACE_METRIC_FEATURE_H_
