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

DeviationColours ColourByDeviation(const Path& path, const Shape& reference) {
  const Shape& rest = reference.cols() > 0 ? reference : path.shapes.at(0);
  std::vector<Eigen::VectorXd> deviations;
  for (const Shape& shape : path.shapes) {
    deviations.push_back(EdgeDeviation(*path.metric, rest, shape));
  }
  DeviationColours colours;
  colours.scale_end = internal::EndOfScale(deviations);
  for (const Eigen::VectorXd& deviation : deviations) {
    Eigen::MatrixXd of_shape(3, deviation.size());
    for (Eigen::Index v = 0; v < deviation.size(); ++v) {
      const auto value = static_cast<float>(std::min(1.0, deviation[v] / colours.scale_end));
      of_shape.col(v) = ToSrgb(internal::ValueColour(value));
    }
    colours.of_shapes.push_back(std::move(of_shape));
  }
  return colours;
}

Eigen::MatrixXd ColourByGroup(const Eigen::VectorXi& groups) {
  Eigen::MatrixXd colours(3, groups.size());
  for (Eigen::Index v = 0; v < groups.size(); ++v) {
    colours.col(v) = ToSrgb(internal::GroupColour(groups[v]));
  }
  return colours;
}

}  // namespace shapespace
