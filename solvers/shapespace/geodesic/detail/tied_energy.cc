#include <shapespace/geodesic/detail/tied_energy.h>

#include <algorithm>

namespace shapespace::internal {

TiedEnergy::TiedEnergy(PathEnergy* energy, const std::vector<std::vector<ThinVertices::Tied>>& tied,
                       const std::vector<double>& unknowns)
    : energy_(energy), stride_(energy->Stride()), followed_(unknowns.size()) {
  for (size_t t = 0; t < tied.size(); ++t) {
    for (const ThinVertices::Tied& vertex : tied[t]) {
      const auto entry = [&](int v) {
        return 3 * static_cast<size_t>(energy->Row(v)) * stride_ + t;
      };
      Tie tie;
      tie.entry = entry(vertex.vertex);
      for (int k = 0; k < 3; ++k) {
        tie.corners[k] = entry(vertex.corners[k]);
        tie.weights[k] = vertex.weights(k);
      }
      for (int axis = 0; axis < 3; ++axis) {
        tie.offset[axis] = unknowns[tie.entry + axis * stride_];
        for (int k = 0; k < 3; ++k) {
          tie.offset[axis] -= tie.weights[k] * unknowns[tie.corners[k] + axis * stride_];
        }
      }
      ties_.push_back(tie);
    }
  }
}

void TiedEnergy::Follow(double* unknowns) const {
  for (const Tie& tie : ties_) {
    for (int axis = 0; axis < 3; ++axis) {
      double sum = tie.offset[axis];
      for (int k = 0; k < 3; ++k) {
        sum += tie.weights[k] * unknowns[tie.corners[k] + axis * stride_];
      }
      unknowns[tie.entry + axis * stride_] = sum;
    }
  }
}

double TiedEnergy::operator()(const double* unknowns, double* gradient) {
  std::copy_n(unknowns, followed_.size(), followed_.begin());
  Follow(followed_.data());
  const double value = energy_->Evaluate(followed_.data(), gradient);
  if (gradient == nullptr) return value;
  for (auto tie = ties_.rbegin(); tie != ties_.rend(); ++tie) {
    for (int axis = 0; axis < 3; ++axis) {
      double& own = gradient[tie->entry + axis * stride_];
      for (int k = 0; k < 3; ++k) {
        gradient[tie->corners[k] + axis * stride_] += tie->weights[k] * own;
      }
      own = 0;
    }
  }
  return value;
}

}  // namespace shapespace::internal
