#include <shapespace/skinning/detail/vertex_weights.h>

#include <shapespace/skinning/detail/near_bones.h>
#include <shapespace/skinning/detail/simplex_minimum.h>

namespace shapespace::internal {
namespace {

void SetPoint(const SimplexPoint& point, const std::vector<int>& bones, int p,
              VertexWeights* weights) {
  weights->bones.col(p).setZero();
  weights->weights.col(p).setZero();
  for (int k = 0; k < point.count; ++k) {
    weights->bones(k, p) = bones[point.index[k]];
    weights->weights(k, p) = point.weight[k];
  }
}

// Fits the weights of one point after another. Has the working memory.
class PointFit {
 public:
  PointFit(const MovingPoints& points, const Bones& bones, double smoothness,
           const VertexWeights& old, const NearBones& near)
      : points_(points),
        bones_(bones),
        smoothness_(smoothness),
        old_(old),
        near_(near),
        place_(bones.Count()),
        expected_(bones.Count()) {}

  void Fit(int p, VertexWeights* weights) {
    near_.Find(p, &candidates_);
    for (size_t i = 0; i < candidates_.size(); ++i) place_[candidates_[i]] = static_cast<int>(i);
    SetGram(p);
    AddSmoothness(p);
    SimplexPoint before;
    for (Eigen::Index k = 0; k < old_.weights.rows(); ++k) {
      if (old_.weights(k, p) > 0) before.Append(place_[old_.bones(k, p)], old_.weights(k, p));
    }
    SimplexPoint best = before;
    double least = ValueAt(gram_, before);
    const auto consider = [&](const SimplexPoint& candidate) {
      const double value = ValueAt(gram_, candidate);
      if (!(value < least)) return;
      least = value;
      best = candidate;
    };
    SimplexPoint same_bones = before;
    MinimiseOnSupport(gram_, &same_bones);
    consider(same_bones);
    SimplexPoint any_bones = before;
    MinimiseOnSimplex(gram_, &any_bones, &gradient_);
    RemoveLeastUseful(gram_, static_cast<int>(old_.weights.rows()), &any_bones);
    consider(any_bones);
    SetPoint(best, candidates_, p, weights);
  }

 private:
  // Weights have sum 1, so that the residual is the mean of those of the single bones, and the
  // squared error is w^T gram w.
  void SetGram(int p) {
    const Eigen::Vector4d rest = points_.Rest(p).homogeneous();
    residuals_.resize(points_.moved.rows(), candidates_.size());
    for (size_t i = 0; i < candidates_.size(); ++i) {
      residuals_.col(i) = -points_.moved.col(p);
      residuals_.col(i).noalias() += bones_.MatricesOf(candidates_[i]) * rest;
    }
    gram_.noalias() = residuals_.transpose() * residuals_;
  }

  // Adds 2 n s |w - m|^2: n is the number of neighbours, s the smoothness, and m the mean of the
  // point's own old weights and of its neighbours' mean. If all points change at once, the sum of
  // this is at least what s |w - w'|^2, summed over edges, rises by.
  void AddSmoothness(int p) {
    const auto& neighbours = points_.neighbours[p];
    if (neighbours.size() == 0) return;
    expected_.setZero();
    const auto add = [&](int q, double share) {
      for (Eigen::Index k = 0; k < old_.weights.rows(); ++k) {
        expected_(old_.bones(k, q)) += share * old_.weights(k, q);
      }
    };
    add(p, 0.5);
    for (const int q : neighbours) add(q, 0.5 / neighbours.size());
    // The residual of each single bone b is e_b - m.
    const double factor = 2 * smoothness_ * neighbours.size();
    const auto of = expected_(candidates_).array();
    gram_.array() += factor * expected_.squaredNorm();
    gram_.array().colwise() -= factor * of;
    gram_.array().rowwise() -= factor * of.transpose();
    gram_.diagonal().array() += factor;
  }

  const MovingPoints& points_;
  const Bones& bones_;
  const double smoothness_;
  const VertexWeights& old_;
  const NearBones& near_;
  std::vector<int> candidates_;
  std::vector<int> place_;  // in the candidates
  Eigen::MatrixXd residuals_, gram_;
  Eigen::VectorXd gradient_, expected_;
};

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

void FitWeights(const MovingPoints& points, const Bones& bones, double smoothness,
                VertexWeights* weights) {
  const VertexWeights old = *weights;
  const NearBones near(points, old, bones.Count());
  ForRunsOfPoints(points.NumPoints(), [&](int begin, int end) {
    PointFit fit(points, bones, smoothness, old, near);
    for (int p = begin; p < end; ++p) fit.Fit(p, weights);
  });
}

}  // namespace shapespace::internal
