#include <shapespace/statistics/modes_picture.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <shapespace/base/error.h>
#include <shapespace/output/internal/colour.h>
#include <shapespace/output/internal/text.h>
#include <shapespace/output/internal/view.h>
#include <shapespace/summary/internal/report.h>

namespace shapespace {
namespace {

constexpr int kSteps = 2;  // standard deviations to each side of the mean

// A bar for each mode, with its share of the variance; below them the modes' numbers. Lengths are
// in proportion to the text.
void AddChart(const PoseModes& modes, int text_size, RgbImage* image) {
  const int line = internal::LineHeight(text_size), margin = text_size / 2;
  const int chart_height = 6 * text_size, widest_bar = 2 * text_size;
  const int height = chart_height + 2 * line + 4 * margin;
  const int top = image->height + 2 * margin + line;
  image->height += height;
  const std::array<unsigned char, 3> paper = {image->pixels[0], image->pixels[1], image->pixels[2]};
  for (int i = 0; i < height * image->width; ++i) {
    image->pixels.insert(image->pixels.end(), paper.begin(), paper.end());
  }
  internal::DrawText(image, margin, top - margin - line, "share of the variance, in per cent",
                     text_size);
  const int bars = modes.NumModes();
  const int pitch = std::min(2 * widest_bar, (image->width - 2 * margin) / bars);
  // Numbers are written where they fit.
  const bool is_labelled = pitch >= widest_bar;
  for (int k = 0; k < bars; ++k) {
    const double share = modes.variances(k) / modes.total_variance;
    const int left = margin + k * pitch, width = std::max(1, pitch / 2);
    const int length = static_cast<int>(std::lround(share * (chart_height - line)));
    const int foot = top + chart_height;
    internal::Fill(image, left, foot - std::max(1, length), left + width, foot,
                   internal::TextColour());
    if (!is_labelled) continue;
    internal::DrawText(image, left, foot - length - line,
                       internal::Format(share < 0.095 ? "%.1f" : "%.0f", 100 * share), text_size);
    internal::DrawText(image, left, foot + margin / 2, std::to_string(k + 1), text_size);
  }
}

}  // namespace

Eigen::VectorXd DistanceFromMean(const PoseModes& modes, const Shape& shape) {
  const Metric& metric = *modes.metric;
  const Shape own = shape / metric.unit;
  const Shape moved = FitRigidMotion(own, modes.mean, metric.vertex_area)(own);
  const double diagonal =
      (modes.mean.rowwise().maxCoeff() - modes.mean.rowwise().minCoeff()).norm();
  return (moved - modes.mean).colwise().norm().transpose() / diagonal;
}

Eigen::Vector3d UpOf(const PoseModes& modes) {
  std::vector<Shape> poses;
  for (int i = 0; i < modes.NumPoses(); ++i) {
    const Shape pose = modes.PlacedPose(i) / modes.metric->unit;
    poses.push_back(pose.colwise() - Centroid(pose, modes.metric->vertex_area));
  }
  return internal::ChooseUp(*modes.metric->connectivity, poses);
}

RgbImage RenderModes(const ShapeModel& model, int modes, const FilmStripOptions& given,
                     Progress* progress) {
  const PoseModes& content = model.Modes();
  if (modes < 1 || modes > content.NumModes()) {
    throw InvalidOptions("modes", "must be from 1 to " + std::to_string(content.NumModes()) +
                                      ", of which there are pictures");
  }
  FilmStripOptions options = given;
  options.columns = 2 * kSteps + 1;
  if (options.up.isZero(0)) options.up = UpOf(content);
  options.max_frames = 1000;
  options.legend = "distance from the mean, per cent of its diagonal";
  options.roles.clear();
  options.labels.clear();
  options.values.clear();
  std::vector<Shape> shapes;
  for (int k = 0; k < modes; ++k) {
    for (int step = -kSteps; step <= kSteps; ++step) {
      Eigen::VectorXd coordinates = Eigen::VectorXd::Zero(k + 1);
      coordinates(k) = step;
      const Shape shape = model.At(coordinates, progress).shape;
      // Turned to the mean, so that the motion of the parts is seen and not that of the whole.
      shapes.push_back(FitRigidMotion(shape / content.metric->unit, content.mean,
                                      content.metric->vertex_area)(shape / content.metric->unit));
      options.values.push_back(DistanceFromMean(content, shape));
      options.labels.push_back(internal::Format("mode %d: %+d", k + 1, step));
      if (step == 0) options.labels.back() = "mean";
    }
  }
  RgbImage image = RenderFilmStrip(*content.metric->connectivity, shapes, options);
  AddChart(content, internal::TextSize(options.frame_width), &image);
  return image;
}

}  // namespace shapespace
