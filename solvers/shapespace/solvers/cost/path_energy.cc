#include <shapespace/solvers/cost/path_energy.h>

#include <cmath>
#include <string>
#include <variant>

#include <shapespace/base/error.h>
#include <shapespace/solvers/cost/refuse_sums.h>
#include <shapespace/solvers/cost/segment_cost.h>

namespace shapespace::cost {
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

void Check(const Metric& metric, const std::vector<Shape>& shapes, const RigidMotions* motions) {
  const int num_vertices = metric.connectivity->NumVertices();
  if (shapes.size() < 2) throw MeshError("a path needs at least two shapes");
  for (const Shape& shape : shapes) {
    if (shape.cols() != num_vertices) {
      throw MeshError("a shape has another number of vertices than the metric");
    }
  }
  if (metric.rigid.Active() && motions == nullptr) {
    throw InvalidOptions("motions: the rigid metric needs them");
  }
  RefuseDenseRows(metric);
}

}  // namespace

void AddPathEnergy(const Metric& metric, std::vector<Shape>* shapes, ceres::Problem* problem,
                   RigidMotions* motions, double quartic_weight) {
  Check(metric, *shapes, motions);
  for (Shape& shape : *shapes) {
    for (int v = 0; v < shape.cols(); ++v) problem->AddParameterBlock(shape.col(v).data(), 3);
  }
  for (const AnyFeature& any : metric.features) {
    std::visit(
        [&](const auto& feature) { AddFeature(feature, metric, quartic_weight, shapes, problem); },
        any);
  }
  if (!metric.rigid.Active()) return;
  motions->setZero(6, shapes->size() - 1);
  for (size_t i = 0; i + 1 < shapes->size(); ++i) {
    for (int v = 0; v < metric.connectivity->NumVertices(); ++v) {
      problem->AddResidualBlock(new ceres::AutoDiffCostFunction<RigidSegment, 3, 3, 3, 6>(
                                    new RigidSegment{std::sqrt(metric.rigid.weights(v))}),
                                nullptr, (*shapes)[i].col(v).data(), (*shapes)[i + 1].col(v).data(),
                                motions->col(i).data());
    }
  }
}

}  // namespace shapespace::cost
