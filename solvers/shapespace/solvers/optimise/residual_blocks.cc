#include <shapespace/solvers/optimise/residual_blocks.h>

#include <cmath>
#include <string>
#include <type_traits>

#include <ceres/solver.h>

#include <shapespace/base/error.h>
#include <shapespace/solvers/cost/segment_cost.h>
#include <shapespace/solvers/optimise/keep_going.h>

namespace shapespace::internal {
namespace {

// Adds the residual blocks of all segments for one feature.
template <typename Feature>
void AddFeature(const Feature& feature, const Metric& metric, double quartic_weight,
                std::vector<Shape>* shapes, ceres::Problem* problem) {
  const int num_vertices = metric.connectivity->NumVertices();
  for (size_t i = 0; i + 1 < shapes->size(); ++i) {
    Shape& from = (*shapes)[i];
    Shape& to = (*shapes)[i + 1];
    std::vector<double*> blocks;
    if constexpr (Feature::kSum) {
      using Segment = SumSegment<Feature>;
      if (num_vertices > kMaxDenseVertices) {
        throw InvalidOptions("volume: couples all vertices; above " +
                             std::to_string(kMaxDenseVertices) + " vertices use the solver kLbfgs");
      }
      auto* const cost = new ceres::DynamicAutoDiffCostFunction<Segment>(
          new Segment{feature, num_vertices, std::sqrt(feature.weights(0))});
      for (Shape* shape : {&from, &to}) {
        for (int v = 0; v < num_vertices; ++v) {
          cost->AddParameterBlock(3);
          blocks.push_back(shape->col(v).data());
        }
      }
      cost->SetNumResiduals(1);
      problem->AddResidualBlock(cost, nullptr, blocks);
    } else {
      for (int e = 0; e < feature.stencils.cols(); ++e) {
        const double root = std::sqrt(feature.weights(e));
        blocks.clear();
        for (Shape* shape : {&from, &to}) {
          for (int k = 0; k < Feature::kVertices; ++k) {
            blocks.push_back(shape->col(feature.stencils(k, e)).data());
          }
        }
        ceres::CostFunction* cost = nullptr;
        if constexpr (Feature::kTrapezoid) {
          if (metric.options.discretization == Discretization::kTrapezoid) {
            cost = MakeSegmentCost<Feature::kVertices>(
                TrapezoidSegment{root, std::sqrt(quartic_weight)});
          }
        }
        if (cost == nullptr) {
          cost = MakeSegmentCost<Feature::kVertices>(FeatureSegment<Feature>{feature, root});
        }
        problem->AddResidualBlock(cost, nullptr, blocks);
      }
    }
  }
}

// root_weight (p - target).
struct PullResidual {
  double root_weight;
  Eigen::Vector3d target;

  template <typename T>
  bool operator()(const T* p, T* residual) const {
    for (int k = 0; k < 3; ++k) residual[k] = root_weight * (p[k] - target(k));
    return true;
  }
};

}  // namespace

void ResidualBlocks::AddPathEnergy(const Metric& metric, double quartic_weight,
                                   std::vector<Shape>* shapes) {
  for (const AnyFeature& any : metric.features) {
    std::visit(
        [&](const auto& feature) {
          AddFeature(feature, metric, quartic_weight, shapes, &problem_);
        },
        any);
  }
  if (!metric.rigid.Active()) return;
  motions_.setZero(6, shapes->size() - 1);
  for (size_t i = 0; i + 1 < shapes->size(); ++i) {
    for (int v = 0; v < metric.connectivity->NumVertices(); ++v) {
      problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<RigidSegment, 3, 3, 3, 6>(
                                    new RigidSegment{std::sqrt(metric.rigid.weights(v))}),
                                nullptr, (*shapes)[i].col(v).data(), (*shapes)[i + 1].col(v).data(),
                                motions_.col(i).data());
    }
  }
}

void ResidualBlocks::AddPull(double weight, const Eigen::Vector3d& target, double* vertex) {
  problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<PullResidual, 3, 3>(
                                new PullResidual{std::sqrt(0.5 * weight), target}),
                            nullptr, vertex);
}

void ResidualBlocks::Fix(double* vertex) {
  if (problem_.HasParameterBlock(vertex)) problem_.SetParameterBlockConstant(vertex);
}

void ResidualBlocks::Fix(Shape* shape) {
  for (int v = 0; v < shape->cols(); ++v) Fix(shape->col(v).data());
}

MinimiseResult ResidualBlocks::Minimise(const MinimiseOptions& options) {
  ceres::Solver::Options ceres_options;
  ceres_options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  ceres_options.max_num_iterations = options.max_iterations;
  ceres_options.function_tolerance = options.tolerance;
  ceres_options.gradient_tolerance = 0;
  ceres_options.parameter_tolerance = 0;
  ceres_options.logging_type = ceres::SILENT;
  KeepGoing keep_going(options.keep_going);
  ceres_options.callbacks.push_back(&keep_going);
  ceres::Solver::Summary summary;
  ceres::Solve(ceres_options, &problem_, &summary);

  MinimiseResult result;
  result.iterations = static_cast<int>(summary.iterations.size()) - 1;
  result.evaluations = summary.num_residual_evaluations;
  result.initial_energy = 4 * summary.initial_cost;  // Ceres' cost is a quarter of the energy
  result.energy = 4 * summary.final_cost;
  if (keep_going.Stopped()) {
    result.stop = Stop::kCancelled;
  } else if (summary.termination_type == ceres::CONVERGENCE) {
    result.stop = Stop::kConverged;
  } else if (summary.termination_type == ceres::NO_CONVERGENCE) {
    result.stop = Stop::kMaxIterations;
  }
  return result;
}

}  // namespace shapespace::internal
