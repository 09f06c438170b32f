#include <shapespace/correspondence/correspondence_picture.h>

#include <algorithm>

#include <shapespace/base/error.h>
#include <shapespace/correspondence/detail/nearest_corners.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/output/internal/view.h>

namespace shapespace {
namespace {

// Number of coloured patches; more colours would be hard to distinguish.
constexpr int kPatches = 12;

// Both meshes as one, so that all pictures have the same camera. The mesh that a picture does not
// show is collapsed to a point inside the other one, where it has no area and does not affect the
// position of the floor.
struct Both {
  std::shared_ptr<const Connectivity> connectivity;
  Eigen::Index first, second;

  Both(const Connectivity& a, const Connectivity& b)
      : first(a.NumVertices()), second(b.NumVertices()) {
    Eigen::Matrix3Xi triangles(3, a.NumTriangles() + b.NumTriangles());
    triangles << a.Triangles(), b.Triangles().array() + a.NumVertices();
    connectivity = Connectivity::FromTriangles(a.NumVertices() + b.NumVertices(), triangles);
  }

  Shape First(const Shape& shape) const {
    Shape both(3, first + second);
    both << shape, shape.rowwise().mean().replicate(1, second);
    return both;
  }
  Shape Second(const Shape& shape) const {
    Shape both(3, first + second);
    both << shape.rowwise().mean().replicate(1, first), shape;
    return both;
  }
};

// Voronoi patches around vertices that are far from each other.
Eigen::VectorXi PatchesOf(const Shape& shape) {
  Eigen::VectorXi patch = Eigen::VectorXi::Zero(shape.cols());
  Eigen::RowVectorXd distance = (shape.colwise() - shape.rowwise().mean()).colwise().squaredNorm();
  for (int i = 0; i < kPatches; ++i) {
    Eigen::Index seed = 0;
    distance.maxCoeff(&seed);
    const Eigen::RowVectorXd to_seed = (shape.colwise() - shape.col(seed)).colwise().squaredNorm();
    for (Eigen::Index v = 0; v < shape.cols(); ++v) {
      if (i > 0 && to_seed(v) >= distance(v)) continue;
      distance(v) = to_seed(v);
      patch(v) = i;
    }
  }
  return patch;
}

// The number of the marker at each vertex, from 1; 0 elsewhere.
Eigen::VectorXi NumbersAt(const std::vector<int>& vertices, Eigen::Index count) {
  Eigen::VectorXi numbers = Eigen::VectorXi::Zero(count);
  for (size_t k = 0; k < vertices.size(); ++k) numbers(vertices[k]) = static_cast<int>(k) + 1;
  return numbers;
}

// The nearest marker of every vertex that is near one, -1 elsewhere.
Eigen::VectorXi SpotsAround(const std::vector<int>& vertices, const Shape& shape) {
  constexpr double kRadius = 0.012;  // of the body's diameter
  const double diameter = (shape.rowwise().maxCoeff() - shape.rowwise().minCoeff()).norm();
  Eigen::VectorXi spots = Eigen::VectorXi::Constant(shape.cols(), -1);
  for (Eigen::Index v = 0; v < shape.cols(); ++v) {
    double least = kRadius * diameter;
    for (size_t k = 0; k < vertices.size(); ++k) {
      const double distance = (shape.col(v) - shape.col(vertices[k])).norm();
      if (distance > least) continue;
      least = distance;
      spots(v) = static_cast<int>(k);
    }
  }
  return spots;
}

void PasteBelow(const RgbImage& part, RgbImage* image) {
  const int width = std::max(image->width, part.width);
  RgbImage whole = {width, image->height + part.height, {}};
  whole.pixels.resize(3 * static_cast<size_t>(width) * whole.height);
  // The first pixel of a strip has the background's colour.
  for (size_t i = 0; i < whole.pixels.size(); ++i) whole.pixels[i] = part.pixels[i % 3];
  const auto paste = [&](const RgbImage& from, int top) {
    for (int row = 0; row < from.height; ++row) {
      std::copy_n(&from.pixels[3 * static_cast<size_t>(row) * from.width], 3 * from.width,
                  &whole.pixels[3 * static_cast<size_t>(top + row) * width]);
    }
  };
  paste(*image, 0);
  paste(part, image->height);
  *image = std::move(whole);
}

}  // namespace

RgbImage RenderCorrespondence(const Connectivity& template_connectivity,
                              const Shape& template_shape, const Connectivity& target_connectivity,
                              const Shape& target_shape,
                              const std::vector<CorrespondenceMarker>& markers,
                              const CorrespondenceResult& result) {
  if (template_shape.cols() != result.fitted.cols() ||
      target_shape.cols() != result.map.to_template.NumVertices()) {
    throw MeshError("the meshes are not those of the correspondence");
  }
  const Both both(template_connectivity, target_connectivity);
  const double scale = result.summary.scale;
  Shape from(3, markers.size()), to(3, markers.size());
  for (size_t k = 0; k < markers.size(); ++k) {
    from.col(static_cast<Eigen::Index>(k)) = scale * template_shape.col(markers[k].template_vertex);
    to.col(static_cast<Eigen::Index>(k)) = target_shape.col(markers[k].target_vertex);
  }
  const Shape turned =
      FitRigidMotion(from, to, Eigen::VectorXd::Ones(from.cols()))(scale * template_shape);
  const std::vector<Shape> shapes = {both.First(turned), both.Second(target_shape),
                                     both.First(result.fitted)};

  FilmStripOptions options;
  // The markers have oriented the template like the target.
  options.up = internal::ChooseUp(target_connectivity, {target_shape});
  options.roles = {ShapeRole::kPose, ShapeRole::kPose, ShapeRole::kInserted};
  options.labels = {"template", "target", "fitted template"};
  FilmStripOptions with_markers = options, with_patches = options, with_values = options;
  with_markers.groups.resize(both.first + both.second);
  std::vector<int> on_template, on_target;
  for (const CorrespondenceMarker& marker : markers) {
    on_template.push_back(marker.template_vertex);
    on_target.push_back(marker.target_vertex);
  }
  with_markers.groups << SpotsAround(on_template, template_shape),
      SpotsAround(on_target, target_shape);
  with_markers.numbers.resize(both.first + both.second);
  with_markers.numbers << NumbersAt(on_template, both.first), NumbersAt(on_target, both.second);
  with_markers.legend = "markers";
  for (const auto& doubt : result.summary.doubtful) {
    with_markers.legend +=
        (&doubt == &result.summary.doubtful.front() ? ", of them doubtful: " : ", ") +
        std::to_string(doubt.marker + 1);
  }
  with_markers.legend.resize(std::min<size_t>(with_markers.legend.size(), 120));
  // Most markers are seen from one of two opposite sides.
  FilmStripOptions other_side = with_markers;
  const Eigen::Vector3d eye = FilmStripView(*both.connectivity, shapes, options);
  const Eigen::Vector3d up = options.up.normalized();
  other_side.view = 2 * eye.dot(up) * up - eye;
  other_side.legend = "the same from the other side";
  RgbImage image = RenderFilmStrip(*both.connectivity, shapes, with_markers);
  PasteBelow(RenderFilmStrip(*both.connectivity, shapes, other_side), &image);

  const Eigen::VectorXi patches = PatchesOf(template_shape);
  with_patches.groups.resize(both.first + both.second);
  with_patches.groups.head(both.first) = patches;
  const SurfacePoints& points = result.map.to_template;
  with_patches.groups.tail(both.second) =
      patches(internal::NearestCorners(points, template_connectivity));
  with_patches.legend = "patches, mapped from the template";
  PasteBelow(RenderFilmStrip(*both.connectivity, shapes, with_patches), &image);

  with_values.values.assign(3, Eigen::VectorXd::Zero(both.first + both.second));
  with_values.values[0].head(both.first) = result.map.round_trip;
  with_values.values[2].head(both.first) = result.map.round_trip;
  with_values.values[1].tail(both.second) =
      PullBack(points, template_connectivity.Triangles(), result.map.round_trip.transpose())
          .transpose();
  with_values.legend = "round-trip error / root of area: low is good";
  PasteBelow(RenderFilmStrip(*both.connectivity, shapes, with_values), &image);

  if (!result.summary.parts_in_doubt.empty()) {
    options.groups.resize(both.first + both.second);
    options.groups.head(both.first) =
        Eigen::Map<const Eigen::VectorXi>(result.in_doubt.data(), both.first);
    options.groups.tail(both.second) =
        options.groups(internal::NearestCorners(points, template_connectivity));
    options.legend = "parts that may belong elsewhere";
    PasteBelow(RenderFilmStrip(*both.connectivity, shapes, options), &image);
  }
  return image;
}

}  // namespace shapespace
