#include <shapespace/output/vertex_colours.h>

#include <algorithm>

#include <shapespace/analysis/quality.h>
#include <shapespace/output/detail/legend.h>
#include <shapespace/output/internal/colour.h>

namespace shapespace {
namespace {

Eigen::Vector3d ToSrgb(const internal::Colour& linear) {
  const auto to_srgb = [](float x) { return internal::ToByte(x) / 255.0; };
  return {to_srgb(linear[0]), to_srgb(linear[1]), to_srgb(linear[2])};
}

}  // namespace

ValueColours ColourByValue(const std::vector<Eigen::VectorXd>& values) {
  ValueColours colours;
  colours.scale_end = internal::EndOfScale(values);
  for (const Eigen::VectorXd& of_vertices : values) {
    Eigen::MatrixXd of_shape(3, of_vertices.size());
    for (Eigen::Index v = 0; v < of_vertices.size(); ++v) {
      const auto value = static_cast<float>(std::min(1.0, of_vertices[v] / colours.scale_end));
      of_shape.col(v) = ToSrgb(internal::ValueColour(value));
    }
    colours.of_shapes.push_back(std::move(of_shape));
  }
  return colours;
}

ValueColours ColourByDeviation(const Path& path, const Shape& reference) {
  const Shape& rest = reference.cols() > 0 ? reference : path.shapes.at(0);
  std::vector<Eigen::VectorXd> deviations;
  for (const Shape& shape : path.shapes) {
    deviations.push_back(EdgeDeviation(*path.metric, rest, shape));
  }
  return ColourByValue(deviations);
}

Eigen::MatrixXd ColourByGroup(const Eigen::VectorXi& groups) {
  Eigen::MatrixXd colours(3, groups.size());
  for (Eigen::Index v = 0; v < groups.size(); ++v) {
    colours.col(v) = ToSrgb(internal::GroupColour(groups[v]));
  }
  return colours;
}

Eigen::MatrixXd ColourByBone(const SkinnedPath& path) {
  Eigen::MatrixXd colours(3, path.weights.cols());
  for (Eigen::Index v = 0; v < colours.cols(); ++v) {
    internal::Colour mixed = internal::Colour::Zero();
    for (Eigen::Index k = 0; k < path.weights.rows(); ++k) {
      mixed += static_cast<float>(path.weights(k, v)) * internal::GroupColour(path.bones(k, v));
    }
    colours.col(v) = ToSrgb(mixed);
  }
  return colours;
}

}  // namespace shapespace
