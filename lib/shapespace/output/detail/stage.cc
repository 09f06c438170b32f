#include <shapespace/output/detail/stage.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/check_range.h>
#include <shapespace/output/detail/legend.h>
#include <shapespace/output/detail/vertex_numbers.h>
#include <shapespace/output/internal/text.h>

namespace shapespace::internal {
namespace {

// Numbers of vertices are smaller than other texts, because many stand close together.
int NumberSize(int text_size) { return std::max(10, 3 * text_size / 4); }

// A cell shows at most this part of the world, in radii of the largest shape, which is then about
// as large as a pixel.
constexpr double kWidestWorld = 1000;

// Radius of a graph's tubes, in radii of the largest shape and in lengths of edges.
constexpr double kTubeRadius = 0.01;
constexpr double kTubePerEdge = 0.15;

// Least radius of marks, in radii of the largest shape.
constexpr double kMarkRadius = 0.02;

// A view with at most this slope (sine of the angle) is horizontal.
constexpr double kHorizontal = 1e-6;

// Values are clamped to this, in units of the colour scale; it is safe in single precision.
constexpr double kLargestValue = 1e6;

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

// 0 if the mesh is no graph.
double TubeRadius(const Connectivity& connectivity, const Shape& shape) {
  if (!connectivity.IsGraph()) return 0;
  const Eigen::Matrix2Xi edges = SegmentsOfGraph(connectivity);
  if (edges.cols() == 0) return kTubeRadius;
  double sum = 0;
  for (Eigen::Index e = 0; e < edges.cols(); ++e) {
    sum += (shape.col(edges(1, e)) - shape.col(edges(0, e))).norm();
  }
  const double mean = sum / edges.cols();
  return mean > 0 ? std::min(kTubeRadius, kTubePerEdge * mean) : kTubeRadius;
}

Axes CameraAxes(const Connectivity& connectivity, const std::vector<Shape>& shapes,
                const RayTracer& tracer, const FilmStripOptions& options) {
  const bool has_ground = options.ground_line.has_value();
  Eigen::Vector3d up = options.up.isZero(0) ? ChooseUp(connectivity, shapes) : options.up;
  if (!options.view.isZero(0)) {
    if (has_ground &&
        std::abs(up.stableNormalized().dot(options.view.stableNormalized())) > kHorizontal) {
      throw InvalidOptions("view", "must be horizontal, perpendicular to up, with a ground line");
    }
    if (options.up.isZero(0)) up = UpBeside(options.view, up);
    return LookFrom(options.view, up);
  }
  const std::vector<Shape> ends = {shapes.front(), shapes.back()};
  std::vector<RayScene> scenes;
  for (const Shape& end : ends) scenes.emplace_back(tracer, end, Eigen::VectorXf());
  return ChooseView(connectivity, ends, scenes, up, has_ground);
}

// Frames just large enough for every shape, whose longer side has the requested width, and at least
// `least_width` pixels wide.
View FitView(const Axes& axes, const CentredShapes& centred, double border, int least_width,
             bool in_place, const FilmStripOptions& options) {
  const Eigen::Matrix<double, 2, 3> flatten = axes.leftCols<2>().transpose();
  const double unit = centred.radius > 0 ? centred.radius : 1;
  // Where shapes are in the world that all cells show, relative to the first one's centre.
  std::vector<Eigen::Vector2d> places(centred.shapes.size(), Eigen::Vector2d::Zero());
  Eigen::AlignedBox2d window;
  for (size_t i = 0; i < centred.shapes.size(); ++i) {
    if (in_place) places[i] = flatten * (centred.centres[i] - centred.centres[0]) / unit;
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
    throw InvalidOptions(options.ground_line ? "ground_line" : "picture",
                         "the shapes are so far from the ground line, or from each other, that "
                         "they would be too small to be seen");
  }
  const int text_size = TextSize(options.frame_width);
  int margin = std::max(2, options.frame_width / 32);
  const int inner = std::max(1, options.frame_width - 2 * margin);
  if (options.ground_line) margin = std::max(margin, RulerDepth(text_size) + 1);

  Camera camera;
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
    Ruler& ruler = view.ruler.emplace();
    ruler.height = *options.ground_line;
    ruler.row = static_cast<int>(std::lround(row()));
    ruler.cell_width = camera.width;
    ruler.step = RulerStep(camera.width / camera.pixels_per_unit * unit);
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

}  // namespace

void CheckPicture(const Connectivity& connectivity, const std::vector<Shape>& shapes,
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
  CheckCount("roles", options.roles.size(), shapes.size(), "shapes");
  CheckCount("labels", options.labels.size(), shapes.size(), "shapes");
  CheckCount("values", options.values.size(), shapes.size(), "shapes");
  CheckCount("marks", options.marks.size(), connectivity.NumVertices(), "vertices");
  if ((options.marks.array() < 0).any() || (options.marks.array() > 2).any()) {
    throw InvalidOptions("marks", "must be 0, 1 or 2");
  }
  if (options.groups.size() != 0 && !options.values.empty()) {
    throw InvalidOptions("groups", "not together with values");
  }
  CheckCount("groups", options.groups.size(), connectivity.NumVertices(), "vertices");
  CheckCount("numbers", options.numbers.size(), connectivity.NumVertices(), "vertices");
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

Stage::Stage(const Connectivity& connectivity, const std::vector<Shape>& shapes,
             std::vector<int> chosen, int least_width, bool in_place,
             const FilmStripOptions& options)
    : options_(options), chosen_(std::move(chosen)) {
  CentredShapes centred = Centred(connectivity, shapes, chosen_);
  const double tube_radius = TubeRadius(connectivity, centred.shapes.front());
  tracer_.emplace(connectivity, static_cast<float>(tube_radius));
  view_ = FitView(CameraAxes(connectivity, centred.shapes, *tracer_, options), centred, tube_radius,
                  least_width, in_place, options);
  drawn_ = std::move(centred.shapes);
  marks_ = Widened(connectivity, drawn_.front(), options.marks, kMarkRadius);
  PrepareValues();
}

void Stage::PrepareValues() {
  const int text_size = TextSize(options_.frame_width);
  if (!options_.values.empty()) {
    double largest = 0;
    for (const int i : chosen_) {
      values_.push_back(options_.values[i]);
      largest = std::max(largest, values_.back().maxCoeff());
    }
    const double end_of_scale = EndOfScale(values_);
    for (Eigen::VectorXd& v : values_) v = (v / end_of_scale).cwiseMin(kLargestValue);
    legend_ = DrawLegend(end_of_scale, largest, options_.legend, text_size);
  } else if (options_.groups.size() != 0) {
    const int swatches = options_.numbers.size() > 0 ? 0 : options_.groups.maxCoeff() + 1;
    legend_ = DrawGroupLegend(swatches, options_.legend, text_size);
  }
}

void Stage::Draw(int i, int left, int top, RgbImage* image) const {
  const RayScene scene(
      *tracer_, drawn_[i],
      values_.empty() ? Eigen::VectorXf() : Eigen::VectorXf(values_[i].cast<float>()));
  const int text_size = TextSize(options_.frame_width);
  const ShapeRole role = options_.roles.empty() ? ShapeRole::kPose : options_.roles[chosen_[i]];
  if (view_.ruler) DrawRuler(*view_.ruler, text_size, left, top, image);
  DrawFrame(scene, view_.cameras[i], {role, !values_.empty(), options_.groups, marks_}, left, top,
            image);
  DrawVertexNumbers(scene, drawn_[i], view_.cameras[i], options_.numbers, NumberSize(text_size),
                    left, top, image);
}

Axes StageAxes(const Connectivity& connectivity, const std::vector<Shape>& shapes,
               const std::vector<int>& chosen, const FilmStripOptions& options) {
  const CentredShapes centred = Centred(connectivity, shapes, chosen);
  const RayTracer tracer(connectivity,
                         static_cast<float>(TubeRadius(connectivity, centred.shapes.front())));
  return CameraAxes(connectivity, centred.shapes, tracer, options);
}

}  // namespace shapespace::internal
