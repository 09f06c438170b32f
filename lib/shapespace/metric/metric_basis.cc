#include <shapespace/metric/metric_basis.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/ranges.h>
#include <shapespace/mesh/different_meshes.h>
#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/metric/metric.h>

namespace shapespace {
namespace {

// A vertex without elements, or with collapsed ones only, has this share of the mean area.
constexpr double kMinArea = 1e-3;
// A twin, which has no element either, has this share of that: it changes nothing, and no matrix is
// singular.
constexpr double kTwinArea = 1e-9;

struct Measures {
  Eigen::VectorXd triangle_area, squared_length;  // means over the poses
};

Measures Measure(const Connectivity& connectivity, const std::vector<Shape>& poses) {
  Measures result;
  result.triangle_area = Eigen::VectorXd::Zero(connectivity.NumTriangles());
  result.squared_length = Eigen::VectorXd::Zero(connectivity.NumEdges());
  for (const Shape& pose : poses) {
    internal::ForIndices(connectivity.NumTriangles(), [&](int f) {
      result.triangle_area(f) +=
          internal::TriangleArea(pose, connectivity.Triangles().col(f)) / poses.size();
    });
    internal::ForIndices(connectivity.NumEdges(), [&](int e) {
      const Eigen::Vector2i v = connectivity.Edges().col(e);
      result.squared_length(e) += (pose.col(v(1)) - pose.col(v(0))).squaredNorm() / poses.size();
    });
  }
  return result;
}

// Adds to every vertex half of the length of its edges, times `width`.
void AddLengths(const Connectivity& connectivity, const Measures& measures, double width,
                Eigen::VectorXd* vertex_area) {
  for (int e = 0; e < connectivity.NumEdges(); ++e) {
    for (const int v : connectivity.Edges().col(e)) {
      (*vertex_area)(v) += 0.5 * width * std::sqrt(measures.squared_length(e));
    }
  }
}

// Computes A_p. Of a graph it is a length.
Eigen::VectorXd VertexAreas(const Connectivity& connectivity, const Measures& measures) {
  const int num_vertices = connectivity.NumVertices();
  Eigen::VectorXd area = Eigen::VectorXd::Zero(num_vertices);
  if (connectivity.IsGraph()) {
    AddLengths(connectivity, measures, 1, &area);
  } else {
    for (int f = 0; f < connectivity.NumTriangles(); ++f) {
      for (const int v : connectivity.Triangles().col(f)) area(v) += measures.triangle_area(f) / 3;
    }
    // A segment without triangles is a strip as wide as a cell of the surface.
    const auto on_surface = [&](int v) { return connectivity.TrianglesOfVertices()[v].size() > 0; };
    int surface = 0;
    for (int v = 0; v < num_vertices; ++v) surface += on_surface(v) ? 1 : 0;
    Eigen::VectorXd strip = Eigen::VectorXd::Zero(num_vertices);
    AddLengths(connectivity, measures, std::sqrt(area.sum() / surface), &strip);
    for (int v = 0; v < num_vertices; ++v) {
      if (!on_surface(v)) area(v) = strip(v);
    }
  }
  const int num_twins = static_cast<int>(connectivity.Twins().size());
  const double least = kMinArea * area.sum() / (num_vertices - num_twins);
  area = area.cwiseMax(least);
  for (const int twin : connectivity.Twins()) area(twin) = kTwinArea * least;
  return area;
}

// Computes A_e, of a graph a length.
Eigen::VectorXd EdgeAreas(const Connectivity& connectivity, const Measures& measures,
                          const Eigen::VectorXd& vertex_area) {
  if (connectivity.IsGraph()) return measures.squared_length.cwiseSqrt();
  const int num_sides = connectivity.NumTriangleEdges();
  Eigen::VectorXd area = Eigen::VectorXd::Zero(connectivity.NumEdges());
  for (int e = 0; e < num_sides; ++e) {
    for (const int f : connectivity.TrianglesOfEdges()[e]) area(e) += measures.triangle_area(f) / 3;
  }
  // A stiffener or a segment has no triangle; it gets a share of the areas at its ends.
  for (int e = num_sides; e < connectivity.NumEdges(); ++e) {
    const Eigen::Vector2i ends = connectivity.Edges().col(e);
    area(e) = (vertex_area(ends(0)) + vertex_area(ends(1))) / 6;
  }
  return area;
}

Eigen::VectorXd HingeAreas(const Connectivity& connectivity, const std::vector<Shape>& poses) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(connectivity.NumHinges());
  for (const Shape& pose : poses) {
    internal::ForIndices(connectivity.NumHinges(), [&](int h) {
      const Eigen::Vector4i v = connectivity.Hinges().col(h);
      const Eigen::Vector3d a = pose.col(v(0)), e = pose.col(v(1)) - a;
      result(h) += (e.cross(pose.col(v(2)) - a).norm() + e.cross(pose.col(v(3)) - a).norm()) /
                   (6 * poses.size());
    });
  }
  return result;
}

// Rejects coordinates for which squares of lengths, or their products, overflow or underflow.
void CheckMagnitude(const Shape& pose) {
  const double extent = (pose.rowwise().maxCoeff() - pose.rowwise().minCoeff()).maxCoeff();
  if (pose.cwiseAbs().maxCoeff() > kLargestCoordinate ||
      (extent > 0 && extent < 1 / kLargestCoordinate)) {
    throw MeshError("a pose has coordinates beyond 1e60 or is smaller than 1e-60: scale it");
  }
}

// Checks the stiffness called `name`, and returns it per edge; 1 where there is none.
Eigen::VectorXd CheckedStiffness(const Eigen::VectorXd& field, StiffnessOn on, const char* name,
                                 const Connectivity& connectivity) {
  if (field.size() == 0) return Eigen::VectorXd::Ones(connectivity.NumEdges());
  const bool on_vertices = on == StiffnessOn::kVertices;
  if (field.size() != (on_vertices ? connectivity.NumVertices() : connectivity.NumEdges())) {
    throw InvalidOptions(name, "has " + std::to_string(field.size()) + " numbers; the mesh has " +
                                   std::to_string(connectivity.NumVertices()) + " vertices and " +
                                   std::to_string(connectivity.NumEdges()) +
                                   " edges, and stiffness_on says that the numbers belong to " +
                                   (on_vertices ? "vertices" : "edges"));
  }
  return EdgeStiffness(field, on, connectivity);
}

// The index of a side of a triangle among the edges.
int FindSide(const Connectivity& connectivity, int a, int b) {
  const Eigen::Matrix2Xi& edges = connectivity.Edges();
  const std::pair<int, int> side = std::minmax(a, b);
  int low = 0, high = connectivity.NumTriangleEdges();
  while (low < high) {
    const int middle = (low + high) / 2;
    if (std::pair<int, int>(edges(0, middle), edges(1, middle)) < side) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

void AssignStiffness(const MetricOptions& options, MetricBasis* basis) {
  const Connectivity& connectivity = *basis->connectivity;
  const StiffnessOn on = options.stiffness_on;
  basis->edge_stiffness =
      CheckedStiffness(options.stretching_stiffness, on, "stretching_stiffness", connectivity);
  basis->edge_bending_stiffness =
      CheckedStiffness(options.bending_stiffness, on, "bending_stiffness", connectivity);
  basis->triangle_stiffness.setOnes(connectivity.NumTriangles());
  const bool stretches = options.stretching_stiffness.size() > 0;
  for (int f = 0; f < connectivity.NumTriangles() && stretches; ++f) {
    double sum = 0;
    const Eigen::Vector3i t = connectivity.Triangles().col(f);
    for (int k = 0; k < 3; ++k) {
      const int a = t(k), b = t((k + 1) % 3);
      sum += a == b ? 1 : basis->edge_stiffness(FindSide(connectivity, a, b));
    }
    basis->triangle_stiffness(f) = sum / 3;
  }
  const bool bends = options.bending_stiffness.size() > 0;
  basis->hinge_stiffness.setOnes(connectivity.NumHinges());
  for (int h = 0; h < connectivity.NumHinges() && bends; ++h) {
    const Eigen::Vector4i hinge = connectivity.Hinges().col(h);
    basis->hinge_stiffness(h) =
        basis->edge_bending_stiffness(FindSide(connectivity, hinge(0), hinge(1)));
  }
}

}  // namespace

MetricBasis MakeMetricBasis(const MetricOptions& options,
                            const std::shared_ptr<const Connectivity>& connectivity,
                            const std::vector<Shape>& poses, double unit, PosePairs pairs) {
  if (poses.empty()) throw MeshError("a metric needs at least one pose to be frozen on");
  for (const Shape& pose : poses) {
    if (pose.cols() != connectivity->NumVertices()) {
      throw MeshError(internal::OfOtherMesh("a pose", pose.cols(), connectivity->NumVertices()));
    }
    if (!pose.allFinite()) throw MeshError("a pose has a coordinate that is not finite");
    CheckMagnitude(pose);
  }
  if (connectivity->NumEdges() == 0) throw MeshError("the mesh has no edge");

  // In two passes: the first computes the unit, the second measures in it.
  Measures measures = Measure(*connectivity, poses);
  MetricBasis basis;
  basis.connectivity = connectivity;
  basis.pairs = pairs;
  basis.weighting = options.weights;
  basis.unit = unit > 0                  ? unit
               : connectivity->IsGraph() ? measures.squared_length.cwiseSqrt().sum()
                                         : std::sqrt(measures.triangle_area.sum());
  if (!(basis.unit > 0) || !std::isfinite(basis.unit)) {
    throw MeshError("the mesh has no extent: all of its triangles or edges are of size zero");
  }
  for (const Shape& pose : poses) basis.poses.push_back(pose / basis.unit);
  measures = Measure(*connectivity, basis.poses);
  basis.vertex_area = VertexAreas(*connectivity, measures);
  basis.edge_area = EdgeAreas(*connectivity, measures, basis.vertex_area);
  basis.triangle_area = std::move(measures.triangle_area);
  basis.squared_length = std::move(measures.squared_length);
  basis.hinge_area = HingeAreas(*connectivity, basis.poses);
  AssignStiffness(options, &basis);
  return basis;
}

Eigen::VectorXd VertexStiffness(const Eigen::VectorXd& field, StiffnessOn on,
                                const Connectivity& connectivity) {
  if (on == StiffnessOn::kVertices) return field;
  const int num_vertices = connectivity.NumVertices();
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(num_vertices);
  Eigen::VectorXd count = Eigen::VectorXd::Zero(num_vertices);
  for (int e = 0; e < connectivity.NumEdges(); ++e) {
    for (const int v : connectivity.Edges().col(e)) {
      sum(v) += std::log(field(e));
      ++count(v);
    }
  }
  return (sum.array() / count.array().max(1)).exp();
}

Eigen::VectorXd EdgeStiffness(const Eigen::VectorXd& field, StiffnessOn on,
                              const Connectivity& connectivity) {
  if (on == StiffnessOn::kEdges) return field;
  const Eigen::Matrix2Xi& edges = connectivity.Edges();
  return 0.5 * (field(edges.row(0)) + field(edges.row(1)));
}

}  // namespace shapespace
