#ifndef SHAPESPACE_SOLVERS_COST_SHOOTING_COST_H_
#define SHAPESPACE_SOLVERS_COST_SHOOTING_COST_H_

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include <ceres/cost_function.h>
#include <ceres/jet.h>
#include <Eigen/Core>

#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>

namespace shapespace::cost {

// Ceres cost functions of shooting and of the paper's transport, automatically differentiated.
// Their parameter blocks are vertices (3 numbers).

/// The terms of one feature in the rows of vertex v of J(at)^T [Phi(P) - target] = 0.
struct VertexElements {
  const AnyFeature* feature = nullptr;
  std::vector<int> elements;     ///< elements at v
  std::vector<int> blocks;       ///< kVertices per element: the parameter blocks of its vertices
  std::vector<double> targets;   ///< kValues per element
  std::vector<double> gradient;  ///< 3 kValues per element: gradients of its values with respect to
                                 ///< v, at the shape `at`
};

/// The three rows of vertex v in J(at)^T [Phi(P) - target] = 0. Parameter blocks: the value of each
/// sum feature (1 number), which all rows share, then the vertices that share an element with v.
struct EulerLagrangeRows {
  std::vector<VertexElements> parts;

  template <typename T>
  bool operator()(const T* const* blocks, T* residual) const {
    std::fill_n(residual, 3, T(0.0));
    for (const VertexElements& part : parts) {
      std::visit([&](const auto& feature) { Add(feature, part, blocks, residual); }, *part.feature);
    }
    return true;
  }

 private:
  template <typename Feature, typename T>
  static void Add(const Feature& feature, const VertexElements& part, const T* const* blocks,
                  T* residual) {
    constexpr int kVertices = Feature::kVertices, kValues = Feature::kValues;
    const int* block = part.blocks.data();
    const double* target = part.targets.data();
    const double* gradient = part.gradient.data();
    if constexpr (Feature::kSum) {
      for (int axis = 0; axis < 3; ++axis) {
        residual[axis] += gradient[axis] * (blocks[*block][0] - *target);
      }
    } else {
      for (int element : part.elements) {
        T x[3 * kVertices], value[kValues];
        for (int corner = 0; corner < kVertices; ++corner) {
          std::copy_n(blocks[*block++], 3, x + 3 * corner);
        }
        feature(x, value);
        const double root = std::sqrt(feature.weights(element));
        for (int k = 0; k < kValues; ++k, gradient += 3) {
          const T change = root * value[k] - *target++;
          for (int axis = 0; axis < 3; ++axis) residual[axis] += gradient[axis] * change;
        }
      }
    }
  }
};

/// weight (sum over all elements of a function of their vertices - s): the value s of a sum
/// feature, or a linear constraint. Parameter blocks: all m vertices, then s (1 number). Each
/// element is differentiated with Jets of its own size, so that time and memory of the dense row
/// are proportional to m; with DynamicAutoDiffCostFunction they would be proportional to m^2.
/// `Elements` has kVertices, Count(), Vertex(corner, element) and a templated Value(element, x).
template <typename Elements>
class SumCost final : public ceres::CostFunction {
 public:
  SumCost(const Elements& elements, int num_vertices, double weight)
      : elements_(elements), num_vertices_(num_vertices), weight_(weight) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->assign(num_vertices, 3);
    mutable_parameter_block_sizes()->push_back(1);
  }

  /// The sum alone, as a function of the m vertices.
  double Sum(const double* const* blocks) const {
    double sum = 0;
    ForElements<double>(
        blocks, [](double value, int) { return value; }, [&](int, double value) { sum += value; });
    return sum;
  }

  bool Evaluate(const double* const* blocks, double* residual, double** jacobians) const override {
    double sum = 0;
    if (jacobians == nullptr) {
      sum = Sum(blocks);
    } else {
      for (int v = 0; v < num_vertices_; ++v) {
        if (jacobians[v] != nullptr) std::fill_n(jacobians[v], 3, 0.0);
      }
      using Jet = ceres::Jet<double, 3 * kVertices>;
      ForElements<Jet>(
          blocks, [](double value, int k) { return Jet(value, k); },
          [&](int e, const Jet& value) {
            sum += value.a;
            for (int k = 0; k < 3 * kVertices; ++k) {
              double* const jacobian = jacobians[elements_.Vertex(k / 3, e)];
              if (jacobian != nullptr) jacobian[k % 3] += weight_ * value.v[k];
            }
          });
      if (jacobians[num_vertices_] != nullptr) jacobians[num_vertices_][0] = -weight_;
    }
    *residual = weight_ * (sum - blocks[num_vertices_][0]);
    return true;
  }

 private:
  static constexpr int kVertices = Elements::kVertices;

  template <typename T, typename MakeUnknown, typename Use>
  void ForElements(const double* const* blocks, const MakeUnknown& unknown, const Use& use) const {
    for (int e = 0; e < elements_.Count(); ++e) {
      T x[3 * kVertices];
      for (int k = 0; k < 3 * kVertices; ++k) {
        x[k] = unknown(blocks[elements_.Vertex(k / 3, e)][k % 3], k);
      }
      use(e, elements_.Value(e, x));
    }
  }

  Elements elements_;
  int num_vertices_;
  double weight_;
};

/// The elements of a sum feature; their sum is its value in Phi.
template <typename Feature>
struct SumElements {
  static_assert(Feature::kSum && Feature::kValues == 1);
  static constexpr int kVertices = Feature::kVertices;
  const Feature& feature;

  int Count() const { return static_cast<int>(feature.stencils.cols()); }
  int Vertex(int corner, int element) const { return feature.stencils(corner, element); }
  template <typename T>
  T Value(int, const T* x) const {
    T value;
    feature(x, &value);
    return std::sqrt(feature.weights(0)) * value;
  }
};

/// <Y, normal>, vertex by vertex.
struct InnerProduct {
  static constexpr int kVertices = 1;
  const Tangent& normal;

  int Count() const { return static_cast<int>(normal.cols()); }
  int Vertex(int, int element) const { return element; }
  template <typename T>
  T Value(int element, const T* y) const {
    return normal(0, element) * y[0] + normal(1, element) * y[1] + normal(2, element) * y[2];
  }
};

/// Y_v - x_v.
struct Displacement {
  Eigen::Vector3d from;

  template <typename T>
  bool operator()(const T* y, T* residual) const {
    for (int axis = 0; axis < 3; ++axis) residual[axis] = y[axis] - from(axis);
    return true;
  }
};

/// Equation (7) for the three coordinates j of one vertex: F_0 - 2 x_j (G x)_j - C_j, where F_0 -
/// C_j = 2 a_j is stored as one number, because F_0 alone is much larger. Parameter blocks: the
/// velocities of the vertices that G couples with this one, beginning with itself.
struct FirstIntegralRows {
  std::vector<Eigen::Matrix3d> couplings;  ///< blocks of G, one per parameter block
  Eigen::Vector3d constants;               ///< a_j
  double scale = 1;                        ///< of the residuals

  template <typename T>
  bool operator()(const T* const* blocks, T* residual) const {
    T momentum[3] = {T(0.0), T(0.0), T(0.0)};
    for (size_t w = 0; w < couplings.size(); ++w) {
      for (int axis = 0; axis < 3; ++axis) {
        for (int k = 0; k < 3; ++k) momentum[axis] += couplings[w](axis, k) * blocks[w][k];
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      residual[axis] = scale * (2 * constants(axis) - 2.0 * blocks[0][axis] * momentum[axis]);
    }
    return true;
  }
};

}  // namespace shapespace::cost

#endif  // SHAPESPACE_SOLVERS_COST_SHOOTING_COST_H_
