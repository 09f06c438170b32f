#include <shapespace/output/picture.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/check_range.h>
#include <shapespace/base/parallel.h>
#include <shapespace/output/internal/frame.h>
#include <shapespace/output/internal/key_shapes.h>
#include <shapespace/output/internal/legend.h>
#include <shapespace/output/internal/scene.h>
#include <shapespace/output/internal/text.h>
#include <shapespace/output/internal/view.h>

namespace shapespace {
namespace {

// A strip wider than this many frame widths is arranged in rows.
constexpr int kWidestStrip = 6;
constexpr int kTextMargin = 8;

// Larger pictures are not practical, and exceed the range of the PNG writer.
constexpr double kMaxPixels = 1e8;

// Radius of a graph's tubes, in radii of the largest shape and in lengths of edges.
constexpr double kTubeRadius = 0.01;
constexpr double kTubePerEdge = 0.15;

// Least radius of marks, in radii of the largest shape.
constexpr double kMarkRadius = 0.02;

// Values are clamped to this, in units of the colour scale; it is safe in single precision.
constexpr double kLargestValue = 1e6;

// Directions nearer to each other than this (sine of the angle) do not define a picture plane.
constexpr double kParallel = 1e-6;

bool Parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.stableNormalized().cross(b.stableNormalized()).norm() < kParallel;
}

void CheckInput(const Connectivity& connectivity, const std::vector<Shape>& shapes,
                const FilmStripOptions& options) {
  options.Validate();
  if (shapes.empty()) throw MeshError("picture: there is no shape to draw");
  for (size_t i = 0; i < shapes.size(); ++i) {
    const std::string name = "picture: shape " + std::to_string(i);
    if (shapes[i].cols() != connectivity.NumVertices()) {
      throw MeshError(name + " has " + std::to_string(shapes[i].cols()) +
                      " vertices, its connectivity " + std::to_string(connectivity.NumVertices()));
    }
    for (Eigen::Index v = 0; v < shapes[i].cols(); ++v) {
      if (!shapes[i].col(v).allFinite()) {
        throw MeshError(name + ": vertex " + std::to_string(v) + " is not finite");
      }
    }
    if (!(shapes[i].rowwise().maxCoeff() - shapes[i].rowwise().minCoeff()).allFinite()) {
      throw MeshError(name + " is too large for numbers of double precision; scale it down");
    }
  }
  internal::CheckCount("roles", options.roles.size(), shapes.size(), "shapes");
  internal::CheckCount("labels", options.labels.size(), shapes.size(), "shapes");
  internal::CheckCount("values", options.values.size(), shapes.size(), "shapes");
  internal::CheckCount("marks", options.marks.size(), connectivity.NumVertices(), "vertices");
  if ((options.marks.array() < 0).any() || (options.marks.array() > 2).any()) {
    throw InvalidOptions("marks", "must be 0, 1 or 2");
  }
  if (options.groups.size() != 0 && !options.values.empty()) {
    throw InvalidOptions("groups", "not together with values");
  }
  internal::CheckCount("groups", options.groups.size(), connectivity.NumVertices(), "vertices");
  if (options.values.empty()) return;
  for (size_t i = 0; i < shapes.size(); ++i) {
    const Eigen::VectorXd& values = options.values[i];
    if (values.size() != connectivity.NumVertices()) {
      throw InvalidOptions("values", std::to_string(values.size()) + " for shape " +
                                         std::to_string(i) + ", which has " +
                                         std::to_string(connectivity.NumVertices()) + " vertices");
    }
    for (Eigen::Index v = 0; v < values.size(); ++v) {
      if (!std::isfinite(values[v])) {
        throw InvalidOptions("values", "not finite for shape " + std::to_string(i) + ", vertex " +
                                           std::to_string(v));
      }
    }
  }
}

// Visible vertices: those of triangles, or all vertices of a graph.
std::vector<int> Visible(const Connectivity& connectivity) {
  std::vector<bool> shows(connectivity.NumVertices(), connectivity.IsGraph());
  for (const int v : connectivity.Triangles().reshaped()) shows[v] = true;
  std::vector<int> visible;
  for (int v = 0; v < connectivity.NumVertices(); ++v) {
    if (shows[v]) visible.push_back(v);
  }
  return visible;
}

// The selected shapes, each centred by its bounding box, scaled together into the unit ball.
// Invisible vertices move to the centre, so that they do not influence the scale.
std::vector<Shape> Normalised(const Connectivity& connectivity, const std::vector<Shape>& shapes,
                              const std::vector<int>& chosen) {
  const std::vector<int> visible = Visible(connectivity);
  std::vector<Shape> result;
  double radius = 0;
  for (const int i : chosen) {
    const Shape shown = shapes[i](Eigen::all, visible);
    const Eigen::Vector3d low = shown.rowwise().minCoeff();
    const Eigen::Vector3d half = (shown.rowwise().maxCoeff() - low) / 2;
    result.push_back(Shape::Zero(3, shapes[i].cols()));
    result.back()(Eigen::all, visible) = shown.colwise() - (low + half);
    radius = std::max(radius, half.stableNorm());
  }
  if (radius > 0) {
    for (Shape& shape : result) shape /= radius;
  }
  return result;
}

// Vertices within `radius` of a marked vertex, along edges of `shape`, get the nearest one's mark.
Eigen::VectorXi Widened(const Connectivity& connectivity, const Shape& shape,
                        const Eigen::VectorXi& marks, double radius) {
  if (marks.size() == 0) return marks;
  Eigen::VectorXi result = marks;
  std::set<std::pair<double, int>> front;  // distance and vertex
  std::vector<double> distance(marks.size(), radius);
  for (int v = 0; v < marks.size(); ++v) {
    if (marks(v) > 0) front.emplace(distance[v] = 0, v);
  }
  while (!front.empty()) {
    const int v = front.begin()->second;
    front.erase(front.begin());
    for (const int e : connectivity.EdgesOfVertices()[v]) {
      const int w = connectivity.OtherEnd(e, v);
      const double way = distance[v] + (shape.col(w) - shape.col(v)).norm();
      if (way >= distance[w]) continue;
      front.erase({distance[w], w});
      front.emplace(distance[w] = way, w);
      result(w) = result(v);
    }
  }
  return result;
}

double TubeRadius(const Connectivity& connectivity, const Shape& shape) {
  const Eigen::Matrix2Xi& edges = connectivity.Edges();
  if (edges.cols() == 0) return kTubeRadius;
  double sum = 0;
  for (Eigen::Index e = 0; e < edges.cols(); ++e) {
    sum += (shape.col(edges(1, e)) - shape.col(edges(0, e))).norm();
  }
  const double mean = sum / edges.cols();
  return mean > 0 ? std::min(kTubeRadius, kTubePerEdge * mean) : kTubeRadius;
}

internal::Axes CameraAxes(const Connectivity& connectivity, const std::vector<Shape>& shapes,
                          const internal::RayTracer& tracer, const FilmStripOptions& options) {
  Eigen::Vector3d up = options.up.isZero(0) ? internal::ChooseUp(connectivity, shapes) : options.up;
  if (!options.view.isZero(0)) {
    // If seen from above or below, the other of the two axes points up.
    if (Parallel(up, options.view)) up = Eigen::Vector3d(0, up.z(), up.y());
    return internal::LookFrom(options.view, up);
  }
  const std::vector<Shape> ends = {shapes.front(), shapes.back()};
  std::vector<internal::Scene> scenes;
  for (const Shape& end : ends) scenes.emplace_back(tracer, end, Eigen::VectorXf());
  return internal::ChooseView(ends, scenes, up);
}

// A frame just large enough for every shape, whose longer side has the requested width.
internal::Camera FitCamera(const internal::Axes& axes, const std::vector<Shape>& shapes,
                           double border, const FilmStripOptions& options) {
  Eigen::AlignedBox2d window;
  for (const Shape& shape : shapes) {
    const Eigen::Matrix2Xd flat = axes.leftCols<2>().transpose() * shape;
    window.extend(Eigen::Vector2d(flat.rowwise().minCoeff()));
    window.extend(Eigen::Vector2d(flat.rowwise().maxCoeff()));
  }
  const Eigen::Vector2d size = window.sizes().array() + 2 * border;
  const int margin = std::max(2, options.frame_width / 32);
  const int inner = options.frame_width - 2 * margin;
  internal::Camera camera;
  camera.axes = axes;
  camera.centre = window.center();
  camera.samples = options.samples;
  camera.pixels_per_unit = inner / (size.maxCoeff() > 0 ? size.maxCoeff() : 1);
  // Rounding errors must not add a pixel to the longer side.
  const auto pixels = [&](double length) {
    return 2 * margin +
           std::max(1, static_cast<int>(std::ceil(length * camera.pixels_per_unit - 1e-6)));
  };
  camera.width = pixels(size.x());
  camera.height = pixels(size.y());
  return camera;
}

void Paste(const RgbImage& part, int left, int top, RgbImage* image) {
  for (int row = 0; row < part.height; ++row) {
    std::copy_n(&part.pixels[3 * static_cast<size_t>(row) * part.width], 3 * part.width,
                &image->pixels[3 * (static_cast<size_t>(top + row) * image->width + left)]);
  }
}

RgbImage Blank(int width, int height) {
  RgbImage image{width, height,
                 std::vector<unsigned char>(3 * static_cast<size_t>(width) * height)};
  const internal::Colour colour = internal::Background();
  for (size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = internal::ToByte(colour[i % 3]);
  return image;
}

}  // namespace

void FilmStripOptions::Validate() const {
  internal::CheckRange("frame_width", frame_width, 16, 2048);
  internal::CheckRange("max_frames", max_frames, 2, 1000);
  internal::CheckRange("columns", columns, 0, 1000);
  internal::CheckRange("samples", samples, 1, 16);
  if (!view.allFinite()) throw InvalidOptions("view", "not finite");
  if (!up.allFinite()) throw InvalidOptions("up", "not finite");
  if (!view.isZero(0) && !up.isZero(0) && Parallel(view, up)) {
    throw InvalidOptions("up", "parallel to view; give another, or none");
  }
  internal::CheckText("legend", legend);
  internal::CheckText("title", title);
  for (const std::string& label : labels) internal::CheckText("labels", label);
}

RgbImage RenderFilmStrip(const Connectivity& connectivity, const std::vector<Shape>& shapes,
                         const FilmStripOptions& options) {
  CheckInput(connectivity, shapes, options);
  std::vector<int> poses;
  for (size_t i = 0; i < options.roles.size(); ++i) {
    if (options.roles[i] == ShapeRole::kPose) poses.push_back(static_cast<int>(i));
  }
  const std::vector<int> chosen =
      internal::KeyShapes(static_cast<int>(shapes.size()), poses, options.max_frames);
  const int frames = static_cast<int>(chosen.size());
  const std::vector<Shape> drawn = Normalised(connectivity, shapes, chosen);
  const double tube_radius = connectivity.IsGraph() ? TubeRadius(connectivity, drawn.front()) : 0;
  const internal::RayTracer tracer(connectivity, static_cast<float>(tube_radius));
  const internal::Camera camera =
      FitCamera(CameraAxes(connectivity, drawn, tracer, options), drawn, tube_radius, options);

  std::vector<Eigen::VectorXd> values;
  RgbImage legend;
  if (!options.values.empty()) {
    double largest = 0;
    for (const int i : chosen) {
      values.push_back(options.values[i]);
      largest = std::max(largest, values.back().maxCoeff());
    }
    const double end_of_scale = internal::EndOfScale(values);
    for (Eigen::VectorXd& v : values) v = (v / end_of_scale).cwiseMin(kLargestValue);
    legend = internal::DrawLegend(end_of_scale, largest, options.legend);
  } else if (options.groups.size() != 0) {
    legend = internal::DrawGroupLegend(options.groups.maxCoeff() + 1, options.legend);
  }

  const Eigen::VectorXi marks = Widened(connectivity, drawn.front(), options.marks, kMarkRadius);

  const int widest = kWidestStrip * options.frame_width;
  const int rows = (frames * camera.width + widest - 1) / widest;
  const int columns =
      options.columns > 0 ? std::min(options.columns, frames) : (frames + rows - 1) / rows;
  const int title_height = options.title.empty() ? 0 : internal::kTextHeight + 2 * kTextMargin;
  const int cell_height =
      camera.height + (options.labels.empty() ? 0 : internal::kTextHeight + kTextMargin);
  const int strip_height = title_height + (frames + columns - 1) / columns * cell_height;
  const int title_width = internal::TextWidth(options.title) + 2 * kTextMargin;
  const int width = std::max({columns * camera.width, legend.width, title_width});
  const int height = strip_height + legend.height;
  if (static_cast<double>(width) * height > kMaxPixels) {
    throw InvalidOptions("frame_width",
                         std::to_string(frames) + " frames of " +
                             std::to_string(options.frame_width) +
                             " pixels make a picture of more than 100 million pixels; lower it or "
                             "max_frames");
  }
  RgbImage image = Blank(width, height);
  internal::DrawText(&image, kTextMargin, kTextMargin, options.title);
  ParallelFor(frames, [&](int i) {
    const internal::Scene scene(
        tracer, drawn[i],
        values.empty() ? Eigen::VectorXf() : Eigen::VectorXf(values[i].cast<float>()));
    const int left = i % columns * camera.width, top = title_height + i / columns * cell_height;
    const ShapeRole role = options.roles.empty() ? ShapeRole::kPose : options.roles[chosen[i]];
    internal::DrawFrame(scene, camera, {role, !values.empty(), options.groups, marks}, left, top,
                        &image);
    if (!options.labels.empty()) {
      const std::string& label = options.labels[chosen[i]];
      internal::DrawText(&image, left + (camera.width - internal::TextWidth(label)) / 2,
                         top + camera.height, label);
    }
  });
  Paste(legend, 0, strip_height, &image);
  return image;
}

}  // namespace shapespace
