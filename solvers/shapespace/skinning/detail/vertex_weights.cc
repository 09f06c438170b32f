#include <shapespace/skinning/detail/vertex_weights.h>

#include <shapespace/skinning/detail/simplex_minimum.h>

namespace shapespace::internal {
namespace {

SimplexPoint PointOf(const VertexWeights& weights, int p) {
  SimplexPoint point;
  for (Eigen::Index k = 0; k < weights.weights.rows(); ++k) {
    if (weights.weights(k, p) > 0) point.Append(weights.bones(k, p), weights.weights(k, p));
  }
  return point;
}

void SetPoint(const SimplexPoint& point, int p, VertexWeights* weights) {
  weights->bones.col(p).setZero();
  weights->weights.col(p).setZero();
  for (int k = 0; k < point.count; ++k) {
    weights->bones(k, p) = point.index[k];
    weights->weights(k, p) = point.weight[k];
  }
}

}  // namespace

VertexWeights OneBoneEach(const std::vector<int>& bone_of, int weights_per_vertex) {
  VertexWeights weights;
  weights.bones = Eigen::MatrixXi::Zero(weights_per_vertex, bone_of.size());
  weights.weights = Eigen::MatrixXd::Zero(weights_per_vertex, bone_of.size());
  for (size_t p = 0; p < bone_of.size(); ++p) weights.bones(0, p) = bone_of[p];
  weights.weights.row(0).setOnes();
  return weights;
}

Eigen::VectorXd SquaredErrors(const MovingPoints& points, const Bones& bones,
                              const VertexWeights& weights) {
  Eigen::VectorXd errors(points.NumPoints());
  ForRunsOfPoints(points.NumPoints(), [&](int begin, int end) {
    Eigen::VectorXd residual(points.moved.rows());
    for (int p = begin; p < end; ++p) {
      const Eigen::Vector4d rest = points.Rest(p).homogeneous();
      residual = -points.moved.col(p);
      for (Eigen::Index k = 0; k < weights.weights.rows(); ++k) {
        const double weight = weights.weights(k, p);
        if (weight > 0) {
          residual.noalias() += bones.MatricesOf(weights.bones(k, p)) * (weight * rest);
        }
      }
      errors(p) = residual.squaredNorm();
    }
  });
  return errors;
}

void FitWeights(const MovingPoints& points, const Bones& bones, VertexWeights* weights) {
  const int most = static_cast<int>(weights->weights.rows());
  ForRunsOfPoints(points.NumPoints(), [&](int begin, int end) {
    Eigen::MatrixXd residuals(points.moved.rows(), bones.Count());
    Eigen::MatrixXd gram(bones.Count(), bones.Count());
    Eigen::VectorXd gradient(bones.Count());
    for (int p = begin; p < end; ++p) {
      const Eigen::Vector4d rest = points.Rest(p).homogeneous();
      // Weights have sum 1, so that the residual is the mean of those of the single bones.
      for (int b = 0; b < bones.Count(); ++b) {
        residuals.col(b) = -points.moved.col(p);
        residuals.col(b).noalias() += bones.MatricesOf(b) * rest;
      }
      gram.noalias() = residuals.transpose() * residuals;
      const SimplexPoint before = PointOf(*weights, p);
      SimplexPoint best = before;
      double least = ValueAt(gram, before);
      const auto consider = [&](const SimplexPoint& candidate) {
        const double value = ValueAt(gram, candidate);
        if (!(value < least)) return;
        least = value;
        best = candidate;
      };
      SimplexPoint same_bones = before;
      MinimiseOnSupport(gram, &same_bones);
      consider(same_bones);
      SimplexPoint any_bones = before;
      MinimiseOnSimplex(gram, &any_bones, &gradient);
      RemoveLeastUseful(gram, most, &any_bones);
      consider(any_bones);
      SetPoint(best, p, weights);
    }
  });
}

}  // namespace shapespace::internal
