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
/// (an edge, a triangle, ...) to a few numbers, and the element adds weight * |change of these
/// numbers|^2 to what a motion costs. A struct that derives from this has
///
///      static constexpr const char* kName        its name, in files and reports,
///      template <typename T> void operator()(const T* x, T* value) const
///                                                the values: x holds kVertices x 3 coordinates,
///                                                vertex after vertex, value kValues numbers,
///
/// and may replace any of the members below by its own. T is double or a scalar that carries
/// derivatives (ceres::Jet and LineJet): call mathematical functions unqualified, after
/// `using std::sqrt;` and the like. `static Struct Freeze(const MetricBasis& basis)` says what the
/// feature is on a mesh and some poses of it. define_feature.h makes a `Feature` of such a struct,
/// and docs/guide/features.md has a complete example.
template <int kElementVertices, int kElementValues>
struct ElementFeature {
  static constexpr int kVertices = kElementVertices, kValues = kElementValues;

  /// Whether the values stay the same when the whole shape moves rigidly. Solvers then take rigid
  /// motion out of paths exactly.
  static constexpr bool kRigidInvariant = true;
  /// Whether the values of all elements are added up before the square is taken, as for the volume.
  /// Then kValues is 1, and `weights` holds one number.
  static constexpr bool kSum = false;
  /// How many vectors `ScalarRows` has; 0 means that they are made from the derivative.
  static constexpr int kScalarRows = 0;

  Eigen::Matrix<int, kVertices, Eigen::Dynamic> stencils;  ///< each element's vertices, a column
  Eigen::VectorXd weights;                                 ///< one number an element, none negative

  /// The least of sum_i |Phi_{i+1} - Phi_i|^2 over all paths of `segments` segments from value a to
  /// value b: the element's share in the lower bound. The straight chord holds for any feature.
  double LeastChange(const double* a, const double* b, int segments) const {
    double sum = 0;
    for (int k = 0; k < kValues; ++k) sum += (b[k] - a[k]) * (b[k] - a[k]);
    return sum / segments;
  }

  /// kScalarRows vectors k, each of one number a vertex, one vector after the other, such that the
  /// sum of w k k^T resembles the matrix of the metric, axis by axis: what the preconditioner is
  /// assembled from. x holds the element's vertices.
  void ScalarRows(const Eigen::Vector3d* /*x*/, double* /*k*/) const {}

  /// Calls visit(name, number) for each number besides stencils and weights that the feature needs;
  /// files keep them. A struct with such numbers has a template of this form.
  template <typename Self, typename Visit>
  static void ForConstants(Self* /*self*/, const Visit& /*visit*/) {}
};

/// Reads the coordinates of `element`'s vertices out of a shape, vertex after vertex.
template <typename Struct>
void Gather(const Struct& feature, int element, const Shape& shape, double* x) {
  for (int k = 0; k < Struct::kVertices; ++k) {
    Eigen::Map<Eigen::Vector3d>(x + 3 * k) = shape.col(feature.stencils(k, element));
  }
}

/// A feature of whatever struct (see `ElementFeature`), as the library and the solvers take it.
/// Calls are made for many elements at once, so that it costs nothing that they are virtual.
/// Immutable; made by `MakeFeature`.
class Feature {
 public:
  /// A struct may have this many vertices and values at most: buffers of that size are on the
  /// stack.
  static constexpr int kMaxVertices = 8, kMaxValues = 8;

  virtual ~Feature() = default;
  Feature(const Feature&) = delete;
  Feature& operator=(const Feature&) = delete;

  const std::string& Name() const { return name_; }
  int VerticesPerElement() const { return vertices_; }
  int ValuesPerElement() const { return values_; }
  int NumElements() const { return num_elements_; }
  bool IsSum() const { return is_sum_; }
  bool IsRigidInvariant() const { return is_rigid_invariant_; }

  /// The vertices of an element, VerticesPerElement() numbers.
  const int* Element(int element) const { return stencils_ + vertices_ * element; }
  /// One number an element; of a sum, one number.
  const Eigen::VectorXd& Weights() const { return *weights_; }
  double Weight(int element) const { return (*weights_)(is_sum_ ? 0 : element); }
  /// Numbers that the feature adds to Phi.
  int NumValues() const { return is_sum_ ? 1 : values_ * num_elements_; }

  /// The coordinates of elements [begin, end), 3 VerticesPerElement() numbers each.
  void Gather(int begin, int end, const Shape& shape, double* x) const;

  /// The values, without weights, of `count` elements at coordinates x, and unless null their
  /// derivatives: element by element, vertex by vertex, value by value, three numbers.
  virtual void Evaluate(int count, const double* x, double* values,
                        double* derivatives = nullptr) const = 0;
  /// The second derivative of the values along the line x + s along, at s = 0.
  virtual void SecondDerivatives(int count, const double* x, const double* along,
                                 double* values) const = 0;
  /// The sum of weight * LeastChange over `count` elements with values a and b at the ends.
  virtual double LeastChange(int count, const double* a, const double* b, const double* weights,
                             int segments) const = 0;
  /// ScalarRows of `count` elements, NumScalarRows() vectors each.
  virtual void ScalarRows(int count, const double* x, double* rows) const = 0;
  int NumScalarRows() const { return scalar_rows_; }
  /// The numbers besides stencils and weights, by name.
  virtual std::vector<std::pair<std::string, double>> Constants() const = 0;

  /// The struct that this feature was made from, if it is a `Struct`; else null.
  template <typename Struct>
  const Struct* As() const {
    return static_cast<const Struct*>(StructIf(typeid(Struct)));
  }

 protected:
  Feature() = default;
  virtual const void* StructIf(const std::type_info& type) const = 0;

  std::string name_;
  int vertices_ = 0, values_ = 0, num_elements_ = 0, scalar_rows_ = 0;
  bool is_sum_ = false, is_rigid_invariant_ = true;
  const int* stencils_ = nullptr;             // of the struct that the derived class holds
  const Eigen::VectorXd* weights_ = nullptr;  // the same
};

}  // namespace shapespace

#endif  // SHAPESPACE_METRIC_FEATURE_H_
