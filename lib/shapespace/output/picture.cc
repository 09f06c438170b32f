#include <shapespace/output/picture.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/check_range.h>
#include <shapespace/base/parallel.h>
#include <shapespace/output/detail/frame.h>
#include <shapespace/output/detail/key_shapes.h>
#include <shapespace/output/detail/legend.h>
#include <shapespace/output/detail/ray_scene.h>
#include <shapespace/output/detail/ruler.h>
#include <shapespace/output/detail/vertex_numbers.h>
#include <shapespace/output/internal/text.h>
#include <shapespace/output/internal/view.h>

namespace shapespace {
namespace {

// A strip wider than this many frame widths is arranged in rows.
constexpr int kWidestStrip = 6;

// Numbers of vertices are smaller than other texts, because many stand close together.
int NumberSize(int text_size) { return std::max(10, 3 * text_size / 4); }

// A cell shows at most this part of the world, in radii of the largest shape, which is then about
// as large as a pixel.
constexpr double kWidestWorld = 1000;

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
  internal::CheckCount("numbers", options.numbers.size(), connectivity.NumVertices(), "vertices");
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
struct CentredShapes {
  std::vector<Shape> shapes;
  std::vector<Eigen::Vector3d> centres;  // of the boxes, in the shapes' unit
  double radius = 0;                     // of the ball, in the shapes' unit
};

CentredShapes Centred(const Connectivity& connectivity, const std::vector<Shape>& shapes,
                      const std::vector<int>& chosen) {
  const std::vector<int> visible = Visible(connectivity);
  CentredShapes result;
  for (const int i : chosen) {
    const Shape shown = shapes[i](Eigen::all, visible);
    const Eigen::Vector3d low = shown.rowwise().minCoeff();
    const Eigen::Vector3d half = (shown.rowwise().maxCoeff() - low) / 2;
    result.centres.emplace_back(low + half);
    result.shapes.push_back(Shape::Zero(3, shapes[i].cols()));
    result.shapes.back()(Eigen::all, visible) = shown.colwise() - result.centres.back();
    result.radius = std::max(result.radius, half.stableNorm());
  }
  if (result.radius > 0) {
    for (Shape& shape : result.shapes) shape /= result.radius;
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
  const Eigen::Matrix2Xi edges = internal::SegmentsOfGraph(connectivity);
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
  const bool has_ground = options.ground_line.has_value();
  Eigen::Vector3d up = options.up.isZero(0) ? internal::ChooseUp(connectivity, shapes) : options.up;
  if (!options.view.isZero(0)) {
    if (has_ground &&
        std::abs(up.stableNormalized().dot(options.view.stableNormalized())) > kParallel) {
      throw InvalidOptions("view", "must be horizontal, perpendicular to up, with a ground line");
    }
    // If seen from above or below, the other of the two axes points up.
    if (Parallel(up, options.view)) up = Eigen::Vector3d(0, up.z(), up.y());
    return internal::LookFrom(options.view, up);
  }
  const std::vector<Shape> ends = {shapes.front(), shapes.back()};
  std::vector<internal::RayScene> scenes;
  for (const Shape& end : ends) scenes.emplace_back(tracer, end, Eigen::VectorXf());
  return internal::ChooseView(ends, scenes, up, has_ground);
}

// The camera of each cell, and the ground that they see.
struct View {
  std::vector<internal::Camera> cameras;  // which differ in `centre` alone
  std::optional<internal::Ruler> ruler;

  const internal::Camera& First() const { return cameras.front(); }
};

// Frames just large enough for every shape, whose longer side has the requested width, and at least
// `least_width` pixels wide.
View FitView(const internal::Axes& axes, const CentredShapes& centred, double border,
             int least_width, const FilmStripOptions& options) {
  const Eigen::Matrix<double, 2, 3> flatten = axes.leftCols<2>().transpose();
  const double unit = centred.radius > 0 ? centred.radius : 1;
  // Where shapes are in the world that all cells show, relative to the first one's centre.
  std::vector<Eigen::Vector2d> places(centred.shapes.size(), Eigen::Vector2d::Zero());
  Eigen::AlignedBox2d window;
  for (size_t i = 0; i < centred.shapes.size(); ++i) {
    if (options.ground_line) places[i] = flatten * (centred.centres[i] - centred.centres[0]) / unit;
    const Eigen::Matrix2Xd flat = flatten * centred.shapes[i];
    window.extend(Eigen::Vector2d(flat.rowwise().minCoeff() + places[i]));
    window.extend(Eigen::Vector2d(flat.rowwise().maxCoeff() + places[i]));
  }
  const Eigen::Vector2d origin = flatten * centred.centres[0];  // in the shapes' unit
  double ground = 0;
  if (options.ground_line) {
    ground = (*options.ground_line - origin.y()) / unit;
    window.extend(Eigen::Vector2d(window.min().x(), ground));
  }
  const Eigen::Vector2d size = window.sizes().array() + 2 * border;
  if (!(size.maxCoeff() <= kWidestWorld)) {
    throw InvalidOptions("ground_line",
                         "the shapes are so far from it, or from each other, that they would be "
                         "too small to be seen");
  }
  const int text_size = internal::TextSize(options.frame_width);
  int margin = std::max(2, options.frame_width / 32);
  const int inner = std::max(1, options.frame_width - 2 * margin);
  if (options.ground_line) margin = std::max(margin, internal::RulerDepth(text_size) + 1);

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
  camera.width = std::max(least_width, pixels(size.x()));
  camera.height = pixels(size.y());

  View view;
  if (options.ground_line) {
    const auto row = [&] {
      return 0.5 * camera.height - (ground - camera.centre.y()) * camera.pixels_per_unit;
    };
    // The ground lies on the border between two rows of pixels.
    camera.centre.y() += (std::round(row()) - row()) / camera.pixels_per_unit;
    internal::Ruler& ruler = view.ruler.emplace();
    ruler.height = *options.ground_line;
    ruler.row = static_cast<int>(std::lround(row()));
    ruler.cell_width = camera.width;
    ruler.step = internal::RulerStep(camera.width / camera.pixels_per_unit * unit);
    ruler.pixels = ruler.step / unit * camera.pixels_per_unit;
    // The tick nearest to the middle of the cell.
    const double middle = origin.x() + camera.centre.x() * unit;
    const double tick = std::round(middle / ruler.step) * ruler.step;
    ruler.first_tick = 0.5 * camera.width + (tick - middle) / unit * camera.pixels_per_unit;
  }
  // Instead of the shape its camera moves, so that shapes stay in the unit ball.
  for (const Eigen::Vector2d& place : places) {
    view.cameras.push_back(camera);
    view.cameras.back().centre -= place;
  }
  return view;
}

void Paste(const RgbImage& part, int left, int top, RgbImage* image) {
  for (int row = 0; row < part.height; ++row) {
    std::copy_n(&part.pixels[3 * static_cast<size_t>(row) * part.width], 3 * part.width,
                &image->pixels[3 * (static_cast<size_t>(top + row) * image->width + left)]);
  }
}

// Indices of the shapes that are drawn.
std::vector<int> ChooseShapes(const std::vector<Shape>& shapes, const FilmStripOptions& options) {
  std::vector<int> poses;
  for (size_t i = 0; i < options.roles.size(); ++i) {
    if (options.roles[i] == ShapeRole::kPose) poses.push_back(static_cast<int>(i));
  }
  return internal::KeyShapes(static_cast<int>(shapes.size()), poses, options.max_frames);
}

// Their labels; none if all are empty.
std::vector<std::string> LabelsOf(const std::vector<int>& chosen, const FilmStripOptions& options) {
  std::vector<std::string> labels;
  if (options.labels.empty()) return labels;
  bool is_any = false;
  for (const int i : chosen) {
    labels.push_back(options.labels[i]);
    is_any = is_any || !labels.back().empty();
  }
  if (!is_any) labels.clear();
  return labels;
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
  if (ground_line && !std::isfinite(*ground_line))
    throw InvalidOptions("ground_line", "not finite");
}

RgbImage RenderFilmStrip(const Connectivity& connectivity, const std::vector<Shape>& shapes,
                         const FilmStripOptions& options) {
  CheckInput(connectivity, shapes, options);
  const std::vector<int> chosen = ChooseShapes(shapes, options);
  const int frames = static_cast<int>(chosen.size());
  const CentredShapes centred = Centred(connectivity, shapes, chosen);
  const std::vector<Shape>& drawn = centred.shapes;
  const double tube_radius = connectivity.IsGraph() ? TubeRadius(connectivity, drawn.front()) : 0;
  const internal::RayTracer tracer(connectivity, static_cast<float>(tube_radius));

  const int text_size = internal::TextSize(options.frame_width);
  const int text_height = internal::LineHeight(text_size), text_margin = text_size / 2;
  const std::vector<std::string> labels = LabelsOf(chosen, options);
  int label_width = 0;
  for (const std::string& label : labels) {
    label_width = std::max(label_width, internal::TextWidth(label, text_size) + text_margin);
  }
  const View view = FitView(CameraAxes(connectivity, drawn, tracer, options), centred, tube_radius,
                            std::min(label_width, options.frame_width), options);
  const int cell_width = view.First().width;

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
    legend = internal::DrawLegend(end_of_scale, largest, options.legend, text_size);
  } else if (options.groups.size() != 0) {
    const int swatches = options.numbers.size() > 0 ? 0 : options.groups.maxCoeff() + 1;
    legend = internal::DrawGroupLegend(swatches, options.legend, text_size);
  }

  const Eigen::VectorXi marks = Widened(connectivity, drawn.front(), options.marks, kMarkRadius);

  const int widest = kWidestStrip * options.frame_width;
  const int rows = (frames * cell_width + widest - 1) / widest;
  const int columns =
      options.columns > 0 ? std::min(options.columns, frames) : (frames + rows - 1) / rows;
  const int line_height = text_height + text_margin;
  const int title_height = options.title.empty() ? 0 : line_height + text_margin / 2;
  const int cell_height = view.First().height + (labels.empty() ? 0 : line_height);
  const int cells_bottom = title_height + (frames + columns - 1) / columns * cell_height;
  const std::string note = view.ruler ? internal::DescribeRuler(*view.ruler) : "";
  const int strip_height = cells_bottom + (note.empty() ? 0 : line_height);
  int width = std::max(columns * cell_width, legend.width);
  for (const std::string& text : {options.title, note}) {
    width = std::max(width, internal::TextWidth(text, text_size) + 2 * text_margin);
  }
  const int height = strip_height + legend.height;
  if (static_cast<double>(width) * height > kMaxPixels) {
    throw InvalidOptions("frame_width",
                         std::to_string(frames) + " frames of " +
                             std::to_string(options.frame_width) +
                             " pixels make a picture of more than 100 million pixels; lower it or "
                             "max_frames");
  }
  RgbImage image = Blank(width, height);
  internal::DrawText(&image, text_margin, text_margin / 2, options.title, text_size);
  internal::DrawText(&image, text_margin, cells_bottom, note, text_size);
  ParallelFor(frames, [&](int i) {
    const internal::RayScene scene(
        tracer, drawn[i],
        values.empty() ? Eigen::VectorXf() : Eigen::VectorXf(values[i].cast<float>()));
    const internal::Camera& camera = view.cameras[i];
    const int left = i % columns * cell_width, top = title_height + i / columns * cell_height;
    const ShapeRole role = options.roles.empty() ? ShapeRole::kPose : options.roles[chosen[i]];
    if (view.ruler) internal::DrawRuler(*view.ruler, text_size, left, top, &image);
    internal::DrawFrame(scene, camera, {role, !values.empty(), options.groups, marks}, left, top,
                        &image);
    internal::DrawVertexNumbers(scene, drawn[i], camera, options.numbers, NumberSize(text_size),
                                left, top, &image);
    if (labels.empty()) return;
    const std::string label = internal::Shortened(labels[i], cell_width - text_margin, text_size);
    internal::DrawText(&image, left + (cell_width - internal::TextWidth(label, text_size)) / 2,
                       top + camera.height, label, text_size);
  });
  Paste(legend, 0, strip_height, &image);
  return image;
}

Eigen::Vector3d FilmStripView(const Connectivity& connectivity, const std::vector<Shape>& shapes,
                              const FilmStripOptions& options) {
  CheckInput(connectivity, shapes, options);
  const CentredShapes centred = Centred(connectivity, shapes, ChooseShapes(shapes, options));
  const bool is_graph = connectivity.IsGraph();
  const double tube_radius = is_graph ? TubeRadius(connectivity, centred.shapes.front()) : 0;
  const internal::RayTracer tracer(connectivity, static_cast<float>(tube_radius));
  return CameraAxes(connectivity, centred.shapes, tracer, options).col(2);
}

}  // namespace shapespace
