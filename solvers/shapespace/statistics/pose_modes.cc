#include <cmath>
#include <string>

#include <shapespace/base/error.h>
#include <shapespace/statistics/shape_model.h>

namespace shapespace {

Shape PoseModes::PlacedPose(int i) const {
  Shape placed = motions[i](metric->unit * poses[i]);
  metric->connectivity->CopyToTwins(&placed);
  return placed;
}

Eigen::MatrixXd PoseModes::Coordinates() const {
  return weights.cwiseInverse().asDiagonal() * coefficients;
}

double PoseModes::Share(int modes) const {
  return total_variance > 0 ? variances.head(modes).sum() / total_variance : 1;
}

void PoseModes::Validate() const {
  const auto fail = [](const std::string& what) { throw MeshError("the modes: " + what); };
  const int vertices = metric->connectivity->NumVertices();
  if (poses.empty()) fail("there is no pose");
  if (static_cast<int>(names.size()) != NumPoses() || motions.size() != poses.size() ||
      weights.size() != NumPoses() || coefficients.rows() != NumPoses()) {
    fail("poses, names, weights and coefficients differ in number");
  }
  if (coefficients.cols() != NumModes() || variances.size() != NumModes()) {
    fail("modes, variances and coefficients differ in number");
  }
  const auto check_shape = [&](const Shape& shape, const char* what) {
    if (shape.cols() != vertices || !shape.allFinite()) {
      fail(std::string(what) + " is not finite, or has another number of vertices than the mesh");
    }
  };
  check_shape(mean, "the mean");
  for (const Shape& pose : poses) check_shape(pose, "a pose");
  for (const Tangent& mode : modes) check_shape(mode, "a mode");
  for (const RigidMotion& motion : motions) {
    if (!motion.rotation.allFinite() || !motion.translation.allFinite()) {
      fail("the place of a pose is not finite");
    }
  }
  for (int i = 0; i < NumPoses(); ++i) {
    if (!PlacedPose(i).allFinite()) fail("a pose is not finite where its motion places it");
  }
  if (!place(metric->unit * mean).allFinite()) fail("the mean is not finite where it is placed");
  if (!coefficients.allFinite() || !place.rotation.allFinite() || !place.translation.allFinite()) {
    fail("a number is not finite");
  }
  if (!(weights.minCoeff() > 0) || !(std::abs(weights.sum() - 1) < 1e-9)) {
    fail("the weights are not positive, or their sum is not 1");
  }
  if (!std::isfinite(total_variance) || !(total_variance >= variances.sum() * (1 - 1e-9)) ||
      (NumModes() > 0 && !(variances.minCoeff() > 0))) {
    fail("a variance is not positive, or they exceed the total");
  }
  appearance.Validate(vertices, metric->connectivity->NumPolygons(),
                      static_cast<int>(metric->connectivity->Corners().size()));
}

PoseModes FirstModes(PoseModes modes, int count) {
  if (count < 0 || count > modes.NumModes()) {
    throw InvalidOptions("modes", "must be from 0 to " + std::to_string(modes.NumModes()));
  }
  modes.modes.resize(count);
  modes.variances.conservativeResize(count);
  modes.coefficients.conservativeResize(Eigen::NoChange, count);
  return modes;
}

}  // namespace shapespace
