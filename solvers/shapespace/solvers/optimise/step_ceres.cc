#include <shapespace/solvers/optimise/step_ceres.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include <ceres/autodiff_cost_function.h>
#include <ceres/dynamic_autodiff_cost_function.h>
#include <ceres/iteration_callback.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <Eigen/SparseCore>

#include <shapespace/base/error.h>
#include <shapespace/solvers/cost/shooting_cost.h>
#include <shapespace/solvers/optimise/minimise.h>

namespace shapespace::internal {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// Ceres' default of four derivatives a pass was measured to be the fastest (3 to 64 tried), though
// a row with bending has some sixty unknowns: Jets of that size do not fit into registers.
template <typename Rows>
using DynamicCost = ceres::DynamicAutoDiffCostFunction<Rows>;

class StopAtResidual final : public ceres::IterationCallback {
 public:
  explicit StopAtResidual(double norm) : norm_(norm) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    return std::sqrt(2 * summary.cost) <= norm_ ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
                                                : ceres::SOLVER_CONTINUE;
  }

 private:
  double norm_;
};

// Iterations alone, or a callback, end a solve: Ceres' own tolerances measure no residual.
ceres::Solver::Options SolverOptions(int max_iterations) {
  ceres::Solver::Options options;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = options.gradient_tolerance = options.parameter_tolerance = 0;
  options.logging_type = ceres::SILENT;
  return options;
}

int CountSumFeatures(const Metric& metric) {
  return static_cast<int>(
      std::count_if(metric.features.begin(), metric.features.end(), [](const AnyFeature& any) {
        return std::visit([](const auto& feature) { return feature.kSum; }, any);
      }));
}

// The index of `value` in `list`, at whose end it is put if it was not there.
int IndexOf(int value, std::vector<int>* list) {
  const auto found = std::find(list->begin(), list->end(), value);
  const int index = static_cast<int>(found - list->begin());
  if (found == list->end()) list->push_back(value);
  return index;
}

// J(at)^T [Phi(P) - target], times `scale`, as rows by vertex.
class StepRows {
 public:
  StepRows(const Metric& metric, const Shape& at, const Eigen::VectorXd& target, double scale)
      : num_sums_(CountSumFeatures(metric)),
        rows_(at.cols()),
        neighbours_(at.cols()),
        magnitude_(Tangent::Zero(3, at.cols())) {
    const double* targets = target.data();
    for (const AnyFeature& any : metric.features) {
      std::visit([&](const auto& feature) { targets = Add(any, feature, at, targets, scale); },
                 any);
    }
  }

  // What rounding of values and coordinates leaves of the scaled residual where it should be zero:
  // an estimate from above, as if all of it had one sign.
  double Rounding() const { return kEpsilon * magnitude_.norm(); }

  // `sums` are the unknowns of the sum features, in their order.
  void AddTo(Shape* shape, std::vector<double>* sums, ceres::Problem* problem) const {
    std::vector<double*> blocks;
    for (size_t v = 0; v < rows_.size(); ++v) {
      if (rows_[v].parts.empty()) continue;
      auto* const cost = new DynamicCost<EulerLagrangeRows>(new EulerLagrangeRows(rows_[v]));
      blocks.clear();
      for (double& sum : *sums) {
        cost->AddParameterBlock(1);
        blocks.push_back(&sum);
      }
      for (int neighbour : neighbours_[v]) {
        cost->AddParameterBlock(3);
        blocks.push_back(shape->col(neighbour).data());
      }
      cost->SetNumResiduals(3);
      problem->AddResidualBlock(cost, nullptr, blocks);
    }
  }

  // Norm of the scaled gradient of each sum feature.
  const std::vector<double>& SumGradients() const { return sum_gradients_; }

 private:
  // Returns where the targets of the next feature begin.
  template <typename Feature>
  const double* Add(const AnyFeature& any, const Feature& feature, const Shape& at,
                    const double* targets, double scale) {
    constexpr int kVertices = Feature::kVertices, kValues = Feature::kValues;
    using Jet = ceres::Jet<double, 3 * kVertices>;
    Tangent sum_gradient = Tangent::Zero(3, Feature::kSum ? at.cols() : 0);
    double sum_rounded = 0;
    for (int e = 0; e < feature.stencils.cols(); ++e) {
      double x[3 * kVertices];
      Gather(feature, e, at, x);
      Jet jet[3 * kVertices], value[kValues];
      for (int k = 0; k < 3 * kVertices; ++k) jet[k] = Jet(x[k], k);
      feature(jet, value);
      const double root = std::sqrt(feature.weights(Feature::kSum ? 0 : e));
      double rounded[kValues];  // what values, and coordinates by way of them, are made of
      for (int k = 0; k < kValues; ++k) {
        rounded[k] = Feature::kSum ? 0 : std::abs(targets[k]);
        for (int i = 0; i < 3 * kVertices; ++i) rounded[k] += root * std::abs(value[k].v[i] * x[i]);
      }
      sum_rounded += rounded[0];
      for (int corner = 0; corner < kVertices; ++corner) {
        const int v = feature.stencils(corner, e);
        if constexpr (Feature::kSum) {
          sum_gradient.col(v) += scale * root * value[0].v.template segment<3>(3 * corner);
        } else {
          VertexElements& part = Part(any, v);
          part.elements.push_back(e);
          for (int k = 0; k < kVertices; ++k) {
            const int neighbour = IndexOf(feature.stencils(k, e), &neighbours_[v]);
            part.blocks.push_back(num_sums_ + neighbour);
          }
          for (int k = 0; k < kValues; ++k) {
            const Eigen::Vector3d gradient =
                scale * root * value[k].v.template segment<3>(3 * corner);
            part.gradient.insert(part.gradient.end(), gradient.data(), gradient.data() + 3);
            part.targets.push_back(targets[k]);
            magnitude_.col(v) += rounded[k] * gradient.cwiseAbs();
          }
        }
      }
      if (!Feature::kSum) targets += kValues;
    }
    if constexpr (Feature::kSum) {
      for (int v = 0; v < at.cols(); ++v) {
        VertexElements& part = Part(any, v);
        part.blocks.push_back(static_cast<int>(sum_gradients_.size()));
        part.gradient.assign(sum_gradient.col(v).data(), sum_gradient.col(v).data() + 3);
        part.targets.push_back(*targets);
      }
      magnitude_ += (std::abs(*targets) + sum_rounded) * sum_gradient.cwiseAbs();
      sum_gradients_.push_back(sum_gradient.norm());
      ++targets;
    }
    return targets;
  }

  // What vertex v sees of the feature that is being added.
  VertexElements& Part(const AnyFeature& any, int v) {
    std::vector<VertexElements>& parts = rows_[v].parts;
    if (parts.empty() || parts.back().feature != &any) parts.push_back({&any, {}, {}, {}, {}});
    return parts.back();
  }

  int num_sums_;
  std::vector<EulerLagrangeRows> rows_;
  std::vector<std::vector<int>> neighbours_;
  Tangent magnitude_;  // the sums of the absolute values of what the residual is made of
  std::vector<double> sum_gradients_;
};

// Adds s = sum for every sum feature, and sets `sums` to the values at `shape`.
void AddSums(const Metric& metric, const std::vector<double>& weights, Shape* shape,
             std::vector<double>* sums, ceres::Problem* problem) {
  size_t i = 0;
  for (const AnyFeature& any : metric.features) {
    std::visit(
        [&](const auto& feature) {
          using Feature = std::decay_t<decltype(feature)>;
          if constexpr (Feature::kSum) {
            using Cost = SumCost<SumElements<Feature>>;
            const int num_vertices = static_cast<int>(shape->cols());
            auto* const cost = new Cost({feature}, num_vertices, weights[i]);
            std::vector<double*> blocks;
            for (int v = 0; v < num_vertices; ++v) blocks.push_back(shape->col(v).data());
            double& sum = (*sums)[i++];
            blocks.push_back(&sum);
            sum = cost->Sum(blocks.data());
            problem->AddResidualBlock(cost, nullptr, blocks);
          }
        },
        any);
  }
}

void RefuseSums(const Metric& metric, int max_vertices, const std::string& remedy) {
  if (metric.connectivity->NumVertices() <= max_vertices) return;
  for (const AnyFeature& any : metric.features) {
    std::visit(
        [&](const auto& feature) {
          if (feature.kSum) {
            throw InvalidOptions(std::string(feature.kName) + ": couples all vertices; " + remedy);
          }
        },
        any);
  }
}

}  // namespace

StepResult SolveStepWithCeres(const FeatureMap& map, const Shape& at, const Eigen::VectorXd& target,
                              double tolerance, int max_iterations, Shape* shape) {
  const Metric& metric = map.GetMetric();
  RefuseSums(metric, kMaxDenseVertices,
             "above " + std::to_string(kMaxDenseVertices) + " vertices use another solver");
  const FeatureDerivative derivative = map.Derivative(at);
  const auto residual = [&](const Shape& p) {
    return derivative.TransposeTimes(map.Values(p) - target).norm();
  };
  const double unit = residual(at);
  StepResult result;
  if (unit == 0) {
    *shape = at;
    result.converged = true;
    return result;
  }
  if (!std::isfinite(unit) || !std::isfinite(residual(*shape))) {
    throw SolverError("a step of the geodesic has no finite residual where it starts");
  }

  // In units of the residual at `at` all numbers are moderate, as Ceres' absolute limits (of the
  // diagonal, of the scaling of columns) expect.
  const StepRows rows(metric, at, target, 1 / unit);
  ceres::Problem problem;
  std::vector<double> sums(CountSumFeatures(metric));
  rows.AddTo(shape, &sums, &problem);
  // The weight makes an error of s count as much as the error that it makes in the rows, so that k
  // sums leave in the true residual at most sqrt(1 + k) times what Ceres sees.
  AddSums(metric, rows.SumGradients(), shape, &sums, &problem);
  const double enough = std::max(tolerance, rows.Rounding());
  StopAtResidual stop(enough / std::sqrt(1.0 + sums.size()));

  ceres::Solver::Options options = SolverOptions(max_iterations);
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // Newton's method for as long as that lowers the residual. The damping that goes with a radius is
  // relative to the squared derivative, in which soft motions are smaller than stiff ones by as
  // much as 1e16: with the 1e12 of milder metrics convergence is linear (60 iterations are not
  // enough at 1000 vertices, where this takes 3).
  options.initial_trust_region_radius = options.max_trust_region_radius;
  options.callbacks.push_back(&stop);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  result.iterations = std::max(0, static_cast<int>(summary.iterations.size()) - 1);
  result.residual = residual(*shape) / unit;
  result.converged = result.residual <= enough;
  return result;
}

StepResult SolveFirstIntegral(const FeatureMap& map, const Shape& at, const Tangent& constants,
                              FirstIntegralSolver solver, double tolerance, int max_iterations,
                              Tangent* velocity) {
  RefuseSums(map.GetMetric(), 0, "the first integral (7) cannot take it; use another integrator");
  const int num_vertices = static_cast<int>(at.cols());
  StepResult result;
  const double norm = 2 * constants.norm();
  if (norm == 0) {  // all of <x, G x> is zero
    velocity->setZero(3, num_vertices);
    result.converged = true;
    return result;
  }
  const Eigen::SparseMatrix<double> lower = map.Derivative(at).MetricMatrix();
  const Eigen::SparseMatrix<double> matrix = lower.selfadjointView<Eigen::Lower>();
  const auto residual = [&](const Tangent& x) {
    const Eigen::VectorXd momentum = matrix * x.reshaped();
    const Eigen::VectorXd rows = constants.reshaped() - x.reshaped().cwiseProduct(momentum);
    return 2 * rows.norm() / norm;
  };
  if (!std::isfinite(residual(*velocity))) {
    throw SolverError("the first integral (7) has no finite residual where it starts");
  }

  // Ceres' absolute limits want moderate numbers: velocities in units of `unit`, residuals in units
  // of their norm at rest.
  const double trace = matrix.diagonal().sum();
  const double unit = trace > 0 ? std::sqrt(constants.lpNorm<1>() / trace) : 1;
  Tangent unknowns = *velocity / unit;
  ceres::Problem problem;
  for (int v = 0; v < num_vertices; ++v) {
    std::vector<int> neighbours = {v};
    FirstIntegralRows rows;
    rows.couplings.emplace_back(Eigen::Matrix3d::Zero());
    for (int axis = 0; axis < 3; ++axis) {
      for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, 3 * v + axis); entry; ++entry) {
        const size_t block = IndexOf(static_cast<int>(entry.row() / 3), &neighbours);
        if (block == rows.couplings.size()) rows.couplings.emplace_back(Eigen::Matrix3d::Zero());
        rows.couplings[block](axis, entry.row() % 3) = unit * unit * entry.value();
      }
    }
    rows.constants = constants.col(v);
    rows.scale = 1 / norm;
    auto* const cost = new DynamicCost<FirstIntegralRows>(new FirstIntegralRows(rows));
    std::vector<double*> blocks;
    for (int neighbour : neighbours) {
      cost->AddParameterBlock(3);
      blocks.push_back(unknowns.col(neighbour).data());
    }
    cost->SetNumResiduals(3);
    problem.AddResidualBlock(cost, nullptr, blocks);
  }

  StopAtResidual stop(tolerance);
  ceres::Solver::Options options = SolverOptions(max_iterations);
  if (solver == FirstIntegralSolver::kLbfgs) {
    options.minimizer_type = ceres::LINE_SEARCH;
    options.line_search_direction_type = ceres::LBFGS;
  } else {
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  }
  options.callbacks.push_back(&stop);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  result.iterations = std::max(0, static_cast<int>(summary.iterations.size()) - 1);
  // There and back again is not exact, and a start that is a root shall stay.
  if (result.iterations > 0) *velocity = unit * unknowns;
  result.residual = residual(*velocity);
  result.converged = result.residual <= tolerance;
  return result;
}

Tangent ProjectOntoConstraint(const Tangent& x, const Tangent& normal, double constant) {
  // How great the constraint counts beside the distance that is minimised: what it leaves of the
  // constraint's error is one part in its square, and that square still leaves half the digits.
  constexpr double kWeight = 1e4;
  const double norm = normal.norm();
  const double least = std::abs(constant) / norm;  // no Y on the constraint is shorter
  const double length = x.norm();
  if (!(norm > 0) || !std::isfinite(least) || (length > 0 && kEpsilon * least > length)) {
    throw SolverError(
        "the constraint's normal, the metric times the path's velocity, vanishes: to meet the "
        "constraint would change the vector beyond recognition");
  }
  // Of size one, for Ceres' absolute limits.
  const double unit = std::max(length, least);
  if (unit == 0) return x;
  Tangent y = x / unit;
  const Tangent direction = normal / norm;
  double bound = constant / norm / unit;

  ceres::Problem problem;
  std::vector<double*> blocks;
  for (int v = 0; v < x.cols(); ++v) {
    blocks.push_back(y.col(v).data());
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<Displacement, 3, 3>(new Displacement{y.col(v)}), nullptr,
        blocks.back());
  }
  blocks.push_back(&bound);
  problem.AddResidualBlock(
      new SumCost<InnerProduct>({direction}, static_cast<int>(x.cols()), kWeight), nullptr, blocks);
  problem.SetParameterBlockConstant(&bound);

  // The problem is linear, and its gradient at x is an eigenvector of its matrix, the identity plus
  // a multiple of n n^T. So one step of conjugate gradients, without preconditioner, solves it; the
  // next iterations take off rounding.
  ceres::Solver::Options options = SolverOptions(3);
  options.linear_solver_type = ceres::CGNR;
  options.preconditioner_type = ceres::IDENTITY;
  options.max_linear_solver_iterations = 1;
  options.jacobi_scaling = false;
  options.initial_trust_region_radius = options.max_trust_region_radius;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) {
    throw SolverError("the constraint cannot be met: " + summary.message);
  }
  return unit * y;
}

}  // namespace shapespace::internal
