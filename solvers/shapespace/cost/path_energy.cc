#include <shapespace/cost/path_energy.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>

#include <shapespace/base/error.h>
#include <shapespace/cost/internal/refuse_sums.h>
#include <shapespace/cost/segment_cost.h>

namespace shapespace::cost {
namespace {

// Adds the residual blocks of a segment for one feature. `shared` are its values at both shapes, or
// null.
void AddFeature(const std::shared_ptr<const Feature>& feature, bool trapezoid,
                double quartic_weight, Shape* from, Shape* to,
                const std::array<const ShapeFeatures::Values*, 2>& shared,
                ceres::Problem* problem) {
  std::vector<double*> blocks;
  if (feature->IsSum()) {
    for (Shape* shape : {from, to}) {
      for (int v = 0; v < shape->cols(); ++v) blocks.push_back(shape->col(v).data());
    }
    problem->AddResidualBlock(new SumSegment(feature, static_cast<int>(from->cols())), nullptr,
                              blocks);
    return;
  }
  const bool quartic = trapezoid && feature->As<EdgeLength>() != nullptr;
  for (int e = 0; e < feature->NumElements(); ++e) {
    blocks.clear();
    for (Shape* shape : {from, to}) {
      for (int k = 0; k < feature->VerticesPerElement(); ++k) {
        blocks.push_back(shape->col(feature->Element(e)[k]).data());
      }
    }
    ceres::CostFunction* cost = nullptr;
    if (quartic) {
      cost = new ceres::AutoDiffCostFunction<TrapezoidSegment, 2, 3, 3, 3, 3>(
          new TrapezoidSegment{std::sqrt(feature->Weight(e)), std::sqrt(quartic_weight)});
    } else if (shared[0] != nullptr) {
      cost = new SharedFeatureSegment(*feature, e, *shared[0], *shared[1]);
    } else {
      cost = new FeatureSegment(feature, e);
    }
    problem->AddResidualBlock(cost, nullptr, blocks);
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
    throw InvalidOptions("motions", "the rigid metric needs them");
  }
  RefuseDenseRows(metric);
}

}  // namespace

void AddPathEnergy(const Metric& metric, std::vector<Shape>* shapes, ceres::Problem* problem,
                   RigidMotions* motions, double quartic_weight, const ShapeFeatures* features) {
  Check(metric, *shapes, motions);
  for (Shape& shape : *shapes) {
    for (int v = 0; v < shape.cols(); ++v) problem->AddParameterBlock(shape.col(v).data(), 3);
  }
  const bool trapezoid = metric.options.discretization == Discretization::kTrapezoid;
  for (int f = 0; f < static_cast<int>(metric.features.size()); ++f) {
    for (int i = 0; i + 1 < static_cast<int>(shapes->size()); ++i) {
      std::array<const ShapeFeatures::Values*, 2> shared = {};
      if (features != nullptr) shared = {&features->Of(f, i), &features->Of(f, i + 1)};
      AddFeature(metric.features[f], trapezoid, quartic_weight, &(*shapes)[i], &(*shapes)[i + 1],
                 shared, problem);
    }
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

void SetConstant(Shape* shape, ceres::Problem* problem) {
  for (int v = 0; v < shape->cols(); ++v) problem->SetParameterBlockConstant(shape->col(v).data());
}

}  // namespace shapespace::cost
