#include <shapespace/metric/metric.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include <shapespace/base/error.h>
#include <shapespace/mesh/volume.h>

namespace shapespace {
namespace {

// An edge far shorter than the rest would weigh A_e / |e|^4 and freeze whatever hangs on it; below
// this share of the root mean square length it is weighed as if it had that length.
constexpr double kShortestEdge = 1e-3;
// A vertex whose triangles all have no area, or that has none, keeps this share of the mean area.
constexpr double kLeastArea = 1e-3;
// |f|^2 / A_f of a hinge grows without bound on slivers; 8 is a triangle of aspect ratio 4.
constexpr double kGreatestHingeAspect = 8;
// Relative to the mesh's mean triangle and edge: where directions of collapsed ones are cut off.
constexpr double kCollapsed = 1e-8;

double Radians(double degrees) { return degrees * M_PI / 180; }

struct Measures {
  Eigen::VectorXd triangle_area, squared_length;  // means over the poses
};

Measures Measure(const Connectivity& connectivity, const std::vector<Shape>& poses) {
  Measures result;
  result.triangle_area = Eigen::VectorXd::Zero(connectivity.NumTriangles());
  result.squared_length = Eigen::VectorXd::Zero(connectivity.NumEdges());
  for (const Shape& pose : poses) {
    for (int f = 0; f < connectivity.NumTriangles(); ++f) {
      const Eigen::Vector3i t = connectivity.Triangles().col(f);
      const Eigen::Vector3d a = pose.col(t(0));
      result.triangle_area(f) +=
          0.5 * (pose.col(t(1)) - a).cross(pose.col(t(2)) - a).norm() / poses.size();
    }
    for (int e = 0; e < connectivity.NumEdges(); ++e) {
      const Eigen::Vector2i v = connectivity.Edges().col(e);
      result.squared_length(e) += (pose.col(v(1)) - pose.col(v(0))).squaredNorm() / poses.size();
    }
  }
  return result;
}

// A_e of every edge and A_p of every vertex, of sum 1 each where the mesh is a plain surface.
void AssignAreas(const Connectivity& connectivity, const Measures& measures,
                 Eigen::VectorXd* edge_area, Eigen::VectorXd* vertex_area) {
  const int num_vertices = connectivity.NumVertices();
  const int num_sides = connectivity.NumTriangleEdges();
  *edge_area = Eigen::VectorXd::Zero(connectivity.NumEdges());
  *vertex_area = Eigen::VectorXd::Zero(num_vertices);
  const Eigen::Matrix2Xi& edges = connectivity.Edges();
  if (connectivity.IsGraph()) {
    *edge_area = measures.squared_length.cwiseSqrt();
    for (int e = 0; e < connectivity.NumEdges(); ++e) {
      for (int k = 0; k < 2; ++k) (*vertex_area)(edges(k, e)) += 0.5 * (*edge_area)(e);
    }
  } else {
    const auto find_side = [&](int a, int b) {
      const std::pair<int, int> side(std::min(a, b), std::max(a, b));
      int low = 0, high = num_sides;
      while (low < high) {
        const int middle = (low + high) / 2;
        if (std::pair<int, int>(edges(0, middle), edges(1, middle)) < side) {
          low = middle + 1;
        } else {
          high = middle;
        }
      }
      return low;
    };
    for (int f = 0; f < connectivity.NumTriangles(); ++f) {
      const Eigen::Vector3i t = connectivity.Triangles().col(f);
      for (int k = 0; k < 3; ++k) {
        const int a = t(k), b = t((k + 1) % 3);
        (*vertex_area)(a) += measures.triangle_area(f) / 3;
        if (a != b) (*edge_area)(find_side(a, b)) += measures.triangle_area(f) / 3;
      }
    }
    // A stiffener has no triangle: it holds a share of the surface at its ends.
    for (int e = num_sides; e < connectivity.NumEdges(); ++e) {
      (*edge_area)(e) = ((*vertex_area)(edges(0, e)) + (*vertex_area)(edges(1, e))) / 6;
    }
  }
  *vertex_area = vertex_area->cwiseMax(kLeastArea * vertex_area->sum() / num_vertices);
}

Eigen::VectorXd HingeAreas(const Connectivity& connectivity, const std::vector<Shape>& poses) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(connectivity.NumHinges());
  for (const Shape& pose : poses) {
    for (int h = 0; h < connectivity.NumHinges(); ++h) {
      const Eigen::Vector4i v = connectivity.Hinges().col(h);
      const Eigen::Vector3d a = pose.col(v(0)), e = pose.col(v(1)) - a;
      result(h) += (e.cross(pose.col(v(2)) - a).norm() + e.cross(pose.col(v(3)) - a).norm()) /
                   (6 * poses.size());
    }
  }
  return result;
}

Dihedral MakeDihedral(double bending, const Connectivity& connectivity, const Measures& measures,
                      const Eigen::VectorXd& hinge_area, const std::vector<Shape>& poses,
                      PosePairs pairs) {
  Dihedral feature;
  const double mean_area = measures.triangle_area.mean();
  feature.normal_epsilon_squared = std::pow(kCollapsed * 2 * mean_area, 2);
  feature.edge_epsilon_squared = std::pow(kCollapsed, 2) * measures.squared_length.mean();
  feature.stencils = connectivity.Hinges();
  feature.weights.resize(connectivity.NumHinges());
  double x[12];
  std::vector<double> angles(poses.size());
  for (int h = 0; h < connectivity.NumHinges(); ++h) {
    double squared_length = 0, jump = 0, fold = 0;
    for (size_t i = 0; i < poses.size(); ++i) {
      Gather(feature, h, poses[i], x);
      const Eigen::Map<Eigen::Vector3d> a(x), b(x + 3);
      squared_length += (b - a).squaredNorm() / poses.size();
      angles[i] = feature.Angle(x);
      fold = std::max(fold, std::abs(angles[i]));
      for (size_t j = pairs == PosePairs::kAll || i == 0 ? 0 : i - 1; j < i; ++j) {
        jump = std::max(jump, std::abs(WrapAngle(angles[i] - angles[j])));
      }
    }
    // Given poses hold hinges that are folded, or that jump by more than 90 degrees from one to the
    // next; the chord would stick there, so such hinges are let go.
    const double ramp = std::clamp((fold - Radians(120)) / Radians(15), 0.0, 1.0);
    const double u = std::max(jump, ramp * fold) / Radians(60);
    const double area = hinge_area(h);
    const double aspect =
        area * kGreatestHingeAspect > squared_length ? squared_length / area : kGreatestHingeAspect;
    feature.weights(h) = bending * aspect / (1 + u * u * u * u);
  }
  return feature;
}

void CheckNonNegative(double value, const char* field) {
  if (!(value >= 0) || !std::isfinite(value)) {
    throw InvalidOptions(std::string(field) + ": must be a number, zero or more");
  }
}

/// Squares of lengths, and their products, must be numbers too.
void CheckMagnitude(const Shape& pose) {
  const double extent = (pose.rowwise().maxCoeff() - pose.rowwise().minCoeff()).maxCoeff();
  if (pose.cwiseAbs().maxCoeff() > kLargestCoordinate ||
      (extent > 0 && extent < 1 / kLargestCoordinate)) {
    throw MeshError("a pose has coordinates beyond 1e60 or is smaller than 1e-60: scale it");
  }
}

}  // namespace

// Chosen on bars and cylinders that are bent and twisted and a plate that is lifted
// (benchmarks/deformation_table): less bending lets the bodies kink and buckle, more lets them
// stretch; strains alone stretch few triangles of the plate much, lengths alone squash the bar.
MetricOptions MetricOptions::Deformation(const Connectivity& connectivity) {
  const bool solid = IsClosed(connectivity.Triangles());
  MetricOptions options;
  options.isometric = 0.3;
  options.strain = 0.7;
  options.lambda = 0;
  options.bending = solid ? 7e-5 : 3e-5;
  options.volume = solid ? 0.05 : 0;
  return options;
}

MetricOptions MetricOptions::Strain() {
  MetricOptions options;
  options.isometric = 0;
  options.strain = 1;
  return options;
}

MetricOptions MetricOptions::Rigid() {
  MetricOptions options;
  options.isometric = 0;
  options.rigid = 1;
  options.bending = 0;
  return options;
}

MetricOptions MetricOptions::Paper() {
  MetricOptions options;
  options.lambda = 1e-3;
  options.bending = 0;
  options.weights = Weights::kUniform;
  options.discretization = Discretization::kTrapezoid;
  return options;
}

void MetricOptions::Validate() const {
  CheckNonNegative(isometric, "isometric");
  CheckNonNegative(strain, "strain");
  CheckNonNegative(rigid, "rigid");
  CheckNonNegative(lambda, "lambda");
  CheckNonNegative(bending, "bending");
  CheckNonNegative(volume, "volume");
  if (isometric + strain + rigid + lambda == 0) {
    throw InvalidOptions(
        "isometric, strain, rigid, lambda: all zero, so motion costs nothing; set one");
  }
}

bool Metric::RigidInvariantButForPosition() const {
  return !rigid.Active() && options.discretization == Discretization::kMidpoint;
}

Metric FreezeMetric(const MetricOptions& options,
                    const std::shared_ptr<const Connectivity>& connectivity,
                    const std::vector<Shape>& poses, double unit, PosePairs pairs) {
  options.Validate();
  if (poses.empty()) throw MeshError("a metric needs at least one pose to be frozen on");
  for (const Shape& pose : poses) {
    if (pose.cols() != connectivity->NumVertices()) {
      throw MeshError("a pose has " + std::to_string(pose.cols()) + " vertices, the mesh " +
                      std::to_string(connectivity->NumVertices()));
    }
    if (!pose.allFinite()) throw MeshError("a pose has a coordinate that is not finite");
    CheckMagnitude(pose);
  }
  if (connectivity->NumEdges() == 0) throw MeshError("the mesh has no edge");

  // Two rounds: the first finds the unit, the second measures in it.
  Measures measures = Measure(*connectivity, poses);
  Metric metric;
  metric.options = options;
  if (connectivity->NumHinges() == 0) metric.options.bending = 0;
  metric.connectivity = connectivity;
  metric.unit = unit > 0                  ? unit
                : connectivity->IsGraph() ? measures.squared_length.cwiseSqrt().sum()
                                          : std::sqrt(measures.triangle_area.sum());
  if (!(metric.unit > 0) || !std::isfinite(metric.unit)) {
    throw MeshError("the mesh has no extent: all of its triangles or edges are of size zero");
  }
  std::vector<Shape> scaled;
  for (const Shape& pose : poses) scaled.push_back(pose / metric.unit);
  measures = Measure(*connectivity, scaled);

  AssignAreas(*connectivity, measures, &metric.edge_area, &metric.vertex_area);
  metric.hinge_area = HingeAreas(*connectivity, scaled);
  const bool uniform = options.weights == Weights::kUniform;
  const double mean_squared_length = measures.squared_length.mean();
  const Eigen::ArrayXd squared_length =
      measures.squared_length.array().max(kShortestEdge * kShortestEdge * mean_squared_length);

  if (options.isometric > 0) {
    EdgeLength feature;
    feature.stencils = connectivity->Edges();
    feature.weights = uniform
                          ? Eigen::VectorXd::Constant(metric.edge_area.size(), options.isometric)
                          : Eigen::VectorXd(options.isometric * metric.edge_area.array() /
                                            squared_length.square());
    metric.features.emplace_back(std::move(feature));
  }
  const double collapsed_squared = kCollapsed * kCollapsed * mean_squared_length;
  if (options.strain > 0 && !connectivity->IsGraph()) {
    TriangleStrain feature;
    feature.stencils = connectivity->Triangles();
    feature.weights = uniform
                          ? Eigen::VectorXd::Constant(connectivity->NumTriangles(), options.strain)
                          : Eigen::VectorXd(options.strain * measures.triangle_area);
    feature.epsilon_squared = collapsed_squared;
    metric.features.emplace_back(std::move(feature));
  }
  // Edges that are no sides of triangles are strained by themselves.
  const int loose_edges = connectivity->NumEdges() - connectivity->NumTriangleEdges();
  if (options.strain > 0 && loose_edges > 0) {
    LogLength feature;
    feature.stencils = connectivity->Edges().rightCols(loose_edges);
    feature.weights = uniform
                          ? Eigen::VectorXd::Constant(loose_edges, options.strain)
                          : Eigen::VectorXd(options.strain * metric.edge_area.tail(loose_edges));
    feature.epsilon_squared = collapsed_squared;
    metric.features.emplace_back(std::move(feature));
  }
  if (options.lambda > 0) {
    Position feature;
    feature.stencils.setLinSpaced(connectivity->NumVertices(), 0, connectivity->NumVertices() - 1);
    feature.weights = options.lambda * metric.vertex_area;
    metric.features.emplace_back(std::move(feature));
  }
  if (metric.options.bending > 0) {
    metric.features.emplace_back(
        MakeDihedral(options.bending, *connectivity, measures, metric.hinge_area, scaled, pairs));
  }
  if (options.volume > 0) {
    if (!IsClosed(connectivity->Triangles())) {
      throw InvalidOptions(
          "volume: the mesh is not closed, so it encloses none; use volume 0, or fill its holes");
    }
    Volume feature;
    feature.stencils = connectivity->Triangles();
    double volume = 0;
    for (const Shape& pose : scaled)
      volume += EnclosedVolume(connectivity->Triangles(), pose) / scaled.size();
    if (std::abs(volume) < kCollapsed) {
      throw InvalidOptions("volume: the mesh encloses none; use volume 0");
    }
    feature.reference = std::abs(volume);
    feature.weights = Eigen::VectorXd::Constant(1, options.volume);
    metric.features.emplace_back(std::move(feature));
  }
  if (options.rigid > 0) {
    metric.rigid.weights =
        uniform ? Eigen::VectorXd::Constant(connectivity->NumVertices(), options.rigid)
                : Eigen::VectorXd(options.rigid * metric.vertex_area);
  }
  return metric;
}

std::string Describe(const MetricOptions& options) {
  std::ostringstream text;
  const auto add = [&](const char* name, double value) {
    if (value > 0) text << (text.tellp() > 0 ? ", " : "") << name << ' ' << value;
  };
  add("isometric", options.isometric);
  add("strain", options.strain);
  add("rigid", options.rigid);
  add("lambda", options.lambda);
  add("bending", options.bending);
  add("volume", options.volume);
  text << (options.weights == Weights::kUniform ? ", uniform weights" : "")
       << (options.discretization == Discretization::kTrapezoid ? ", trapezoid" : "");
  return text.str();
}

}  // namespace shapespace
