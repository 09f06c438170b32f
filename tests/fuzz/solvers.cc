#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include <shapespace/correspondence/correspondence.h>
#include <shapespace/deformation/deformation.h>
#include <shapespace/exploration/explore.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/path/energy.h>
#include <shapespace/spline/spline.h>
#include <shapespace/statistics/average.h>
#include <shapespace/transfer/transfer.h>

#include "fuzz/targets.h"

namespace shapespace::fuzz {
namespace {

// Numbers made of bytes, and of zeros after their end.
class Bytes {
 public:
  explicit Bytes(const std::string& bytes) : bytes_(bytes) {}

  unsigned Byte() { return at_ < bytes_.size() ? static_cast<unsigned char>(bytes_[at_++]) : 0; }
  int Below(int count) { return static_cast<int>(Byte()) % count; }
  bool Coin() { return Byte() % 2 == 1; }
  // From -1 to 1.
  double Coordinate() { return (static_cast<int>(Byte()) - 128) / 128.0; }
  // From 1e-8 to 1e8, or now and then a number that no option allows.
  double Positive() {
    const unsigned byte = Byte();
    if (byte == 255) return -1;
    if (byte == 254) return std::nan("");
    return std::pow(10, (static_cast<int>(byte) - 127) / 16.0);
  }

 private:
  const std::string& bytes_;
  size_t at_ = 0;
};

// A sheet of triangles in some poses; now and then without some triangles, with polygons of which a
// vertex occurs twice, with vertices at one place, flat, tiny, huge or far away.
struct RandomPoses {
  explicit RandomPoses(Bytes* bytes, int count) {
    const int nx = 1 + bytes->Below(4), ny = 1 + bytes->Below(4);
    const int num_vertices = (nx + 1) * (ny + 1);
    Eigen::Matrix3Xi triangles(3, 2 * nx * ny);
    int num_triangles = 0;
    const bool damaged = bytes->Below(4) == 0;
    for (int x = 0; x < nx; ++x) {
      for (int y = 0; y < ny; ++y) {
        const int a = x * (ny + 1) + y, b = a + ny + 1;
        for (const Eigen::Vector3i& t :
             {Eigen::Vector3i(a, b, b + 1), Eigen::Vector3i(a, b + 1, a + 1)}) {
          if (damaged && bytes->Below(5) == 0) continue;
          triangles.col(num_triangles) = t;
          if (damaged && bytes->Below(9) == 0) {
            triangles(0, num_triangles) = bytes->Below(num_vertices);
          }
          ++num_triangles;
        }
      }
    }
    connectivity = Connectivity::FromTriangles(num_vertices, triangles.leftCols(num_triangles));
    const double scale = bytes->Below(4) == 0 ? bytes->Positive() : 1;
    const double away = bytes->Below(4) == 0 ? 1e6 * bytes->Coordinate() : 0;
    const double noise = bytes->Below(3) * 0.3;
    for (int i = 0; i < count; ++i) {
      Shape shape(3, num_vertices);
      const double bend = 2 * bytes->Coordinate();
      for (int v = 0; v < num_vertices; ++v) {
        const double x = v / (ny + 1), y = v % (ny + 1), angle = bend * x;
        shape.col(v) << (bend == 0 ? x : std::sin(angle) / bend), y,
            (bend == 0 ? 0 : (1 - std::cos(angle)) / bend);
        for (int axis = 0; axis < 3 && noise > 0; ++axis) {
          shape(axis, v) += noise * bytes->Coordinate();
        }
      }
      if (bytes->Below(16) == 0) shape.row(2).setZero();
      if (bytes->Below(16) == 0) shape.col(0) = shape.col(num_vertices - 1);
      shapes.push_back((scale * shape).array() + scale * away);
    }
  }
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<Shape> shapes;
};

MetricOptions RandomMetric(Bytes* bytes) {
  MetricOptions metric;
  const int preset = bytes->Below(6);
  if (preset == 1) metric = MetricOptions::Isometric();
  if (preset == 2) metric = MetricOptions::Strain();
  if (preset == 3) metric = MetricOptions::Rigid();
  if (preset == 4) metric.bending = bytes->Positive();
  if (preset == 5) metric.lambda = bytes->Positive();
  if (bytes->Below(8) == 0) metric.discretization = Discretization::kTrapezoid;
  return metric;
}

GeodesicOptions RandomGeodesic(Bytes* bytes) {
  GeodesicOptions options;
  options.metric = RandomMetric(bytes);
  options.shapes = 1 + bytes->Below(4);
  options.max_iterations = 1 + bytes->Below(60);
  if (bytes->Below(4) == 0) options.tolerance = bytes->Positive();
  options.coarsest = 4 + bytes->Below(20);
  options.avoid_contact = bytes->Below(4) == 0;
  options.assess = bytes->Coin();
  return options;
}

void CheckPath(const Path& path) {
  path.Validate();
  for (const Shape& shape : path.Placed()) Expect(shape.allFinite(), "a shape is not finite");
}

// Whether a path between two poses that is said to have converged has: no step against the gradient
// of its energy lowers it by a notable share, a few hundred times the tolerance.
void CheckConverged(const Path& path) {
  constexpr double kNotable = 0.05, kNothing = 1e-9;
  PathEnergy energy(path.metric, path.NumShapes() - 2);
  std::vector<double> unknowns(energy.Size()), gradient(energy.Size());
  energy.Load(path.shapes, unknowns.data());
  const double before = energy.Evaluate(unknowns.data(), gradient.data());
  double square = 0;
  for (const double slope : gradient) square += slope * slope;
  if (!(before > kNothing) || square == 0) return;
  std::vector<double> moved(unknowns.size());
  for (double step = before / square; step > 1e-12 * before / square; step /= 4) {
    for (size_t i = 0; i < moved.size(); ++i) moved[i] = unknowns[i] - step * gradient[i];
    Expect(!(energy.Evaluate(moved.data(), nullptr) < (1 - kNotable) * before),
           "a path has converged, and a step lowers its energy");
  }
}

// How far two shapes are apart, as a share of their size and their distance from the origin.
double Apart(const Shape& a, const Shape& b) {
  return (a - b).cwiseAbs().maxCoeff() / std::max(1e-300, b.cwiseAbs().maxCoeff());
}

constexpr double kRounding = 1e-6;

void FuzzInterpolate(const std::string& data) {
  Bytes bytes(data);
  const RandomPoses poses(&bytes, 2 + bytes.Below(2));
  const GeodesicOptions options = RandomGeodesic(&bytes);
  const GeodesicResult result = Interpolate(poses.connectivity, poses.shapes, options);
  CheckPath(result.path);
  const GeodesicSummary& summary = result.summary;
  for (size_t i = 0; i < poses.shapes.size(); ++i) {
    Expect(Apart(result.path.Placed(result.path.poses[i]), poses.shapes[i]) < kRounding,
           "a pose is not met");
  }
  Expect(!(summary.energy < (1 - kRounding) * summary.lower_bound - 1e-20),
         "the energy is below its lower bound");
  // The energy, from the shapes.
  double energy = 0;
  const std::vector<double> squared = SquaredLengths(result.path.metric, result.path.shapes);
  const int segments = options.shapes + 1;
  for (const double length : squared) energy += segments * length;
  // Of triangles that have collapsed, a long way from the origin, rounding is a notable share.
  if (options.metric.rigid == 0) {
    Expect(std::abs(energy - summary.energy) <= 100 * kRounding * (energy + 1e-9),
           "the energy that is reported is not that of the shapes");
  }
  Expect(result.path.converged == (summary.termination == Termination::kConverged),
         "the path and its summary differ on whether it has converged");
  if (result.path.converged && poses.shapes.size() == 2 && !options.avoid_contact &&
      options.tolerance <= GeodesicOptions().tolerance) {
    CheckConverged(result.path);
  }
}

void FuzzExtrapolate(const std::string& data) {
  Bytes bytes(data);
  const RandomPoses poses(&bytes, 2);
  const Path path = Interpolate(poses.connectivity, poses.shapes, RandomGeodesic(&bytes)).path;
  ExponentialOptions options;
  options.max_iterations = 1 + bytes.Below(60);
  if (bytes.Below(4) == 0) options.tolerance = bytes.Positive();
  options.stop_at_contact = bytes.Below(4) == 0;
  options.slide_at_contact = bytes.Below(4) == 0;
  const ExponentialResult result = Extrapolate(path, 1 + bytes.Below(4), options);
  CheckPath(result.path);
  for (int i = 0; i < path.NumShapes(); ++i) {
    Expect(Apart(result.path.Placed(i), path.Placed(i)) < kRounding, "the path has changed");
  }
}

void FuzzDeform(const std::string& data) {
  Bytes bytes(data);
  const RandomPoses poses(&bytes, 1);
  const int num_vertices = poses.connectivity->NumVertices();
  const double size =
      (poses.shapes[0].rowwise().maxCoeff() - poses.shapes[0].rowwise().minCoeff()).maxCoeff();
  std::vector<DeformationHandle> handles;
  for (int h = bytes.Below(4); h >= 0; --h) {
    DeformationHandle handle;
    handle.vertices = {bytes.Below(num_vertices)};
    const int second = bytes.Below(num_vertices);
    if (second != handle.vertices[0]) handle.vertices.push_back(second);
    handle.hard = bytes.Coin();
    if (bytes.Coin()) {
      handle.motion.angle = 4 * bytes.Coordinate();
      handle.motion.translation << size * bytes.Coordinate(), size * bytes.Coordinate(), 0;
    }
    handles.push_back(handle);
  }
  DeformationOptions options;
  options.shapes = 1 + bytes.Below(4);
  options.balance = bytes.Below(4) == 0 ? bytes.Positive() : 0.01;
  options.max_iterations = 1 + bytes.Below(60);
  options.coarsest = 4 + bytes.Below(20);
  options.avoid_contact = bytes.Below(4) == 0;
  const DeformationResult result = Deform(poses.connectivity, poses.shapes[0], handles, options);
  CheckPath(result.path);
  Expect(Apart(result.path.Placed(0), poses.shapes[0]) < kRounding, "the mesh has moved");
  if (handles.size() > 1 || !handles[0].hard) return;
  for (size_t k = 0; k < handles[0].vertices.size(); ++k) {
    const int v = handles[0].vertices[k];
    const Eigen::Vector3d wanted =
        handles[0].Target(static_cast<int>(k), 1, poses.shapes[0].col(v));
    const double off = (result.path.Placed(options.shapes).col(v) - wanted).norm();
    Expect(off <= kRounding * (size + wanted.norm()), "the only hard handle is not met");
  }
}

void FuzzTransfer(const std::string& data) {
  Bytes bytes(data);
  const RandomPoses poses(&bytes, 3);
  const Path path =
      Interpolate(poses.connectivity, {poses.shapes[0], poses.shapes[1]}, RandomGeodesic(&bytes))
          .path;
  TransferOptions options;
  options.method = bytes.Coin() ? TransferMethod::kFeatures : TransferMethod::kLadder;
  options.hybrids = bytes.Coin();
  options.max_iterations = 1 + bytes.Below(60);
  options.avoid_contact = bytes.Below(4) == 0;
  const TransferResult result = Transfer(path, poses.shapes[2], options);
  CheckPath(result.path);
  Expect(Apart(result.path.Placed(0), poses.shapes[2]) < kRounding, "the target has moved");
}

void FuzzAverage(const std::string& data) {
  Bytes bytes(data);
  const RandomPoses poses(&bytes, 1 + bytes.Below(4));
  AverageOptions options;
  options.geodesic.metric = RandomMetric(&bytes);
  options.certify = bytes.Coin();
  const AverageResult result = Average(poses.connectivity, poses.shapes, options);
  Expect(result.shape.allFinite(), "the mean is not finite");
  Expect(!(result.summary.energy < (1 - kRounding) * result.summary.lower_bound - 1e-20),
         "the energy is below its lower bound");
}

void FuzzSpline(const std::string& data) {
  Bytes bytes(data);
  const RandomPoses poses(&bytes, 2 + bytes.Below(3));
  SplineOptions options;
  options.geodesic = RandomGeodesic(&bytes);
  options.ends = bytes.Coin() ? SplineEnds::kNatural : SplineEnds::kPeriodic;
  options.by_length = bytes.Below(4) == 0;
  const SplineResult result = Spline(poses.connectivity, poses.shapes, options);
  CheckPath(result.path);
  for (size_t i = 0; i < poses.shapes.size(); ++i) {
    Expect(Apart(result.path.Placed(result.path.poses[i]), poses.shapes[i]) < kRounding,
           "a pose is not met");
  }
}

void FuzzExplore(const std::string& data) {
  Bytes bytes(data);
  const RandomPoses poses(&bytes, 2 + bytes.Below(3));
  ExploreOptions options;
  options.geodesic.metric = RandomMetric(&bytes);
  options.geodesic.max_iterations = 1 + bytes.Below(60);
  options.depth = bytes.Below(2);
  const ExploreResult result = Explore(poses.connectivity, poses.shapes, {}, options);
  const PoseSpace& space = result.space;
  space.Validate();
  for (int i = 0; i < space.NumNodes(); ++i) {
    Expect(space.nodes[i].allFinite(), "a node is not finite");
  }
}

void FuzzCorrespond(const std::string& data) {
  Bytes bytes(data);
  const RandomPoses poses(&bytes, 1), target(&bytes, 1);
  std::vector<CorrespondenceMarker> markers;
  // Most often spread over both meshes: others are refused before anything is fitted.
  const int count = 1 + bytes.Below(7), last = std::max(1, count - 1);
  const bool spread = bytes.Below(8) > 0;
  const auto vertex = [&](int k, int num_vertices) {
    return spread ? k * (num_vertices - 1) / last : bytes.Below(num_vertices);
  };
  for (int k = 0; k < count; ++k) {
    markers.push_back({vertex(k, poses.connectivity->NumVertices()),
                       vertex(k, target.connectivity->NumVertices())});
  }
  const CorrespondenceResult result = Correspond(poses.connectivity, poses.shapes[0],
                                                 target.connectivity, target.shapes[0], markers);
  Expect(result.fitted.allFinite(), "the fitted mesh is not finite");
}

}  // namespace

std::vector<Target> Solvers() {
  return {{"interpolate", FuzzInterpolate}, {"extrapolate", FuzzExtrapolate},
          {"deform", FuzzDeform},           {"transfer", FuzzTransfer},
          {"average", FuzzAverage},         {"spline", FuzzSpline},
          {"explore", FuzzExplore},         {"correspond", FuzzCorrespond}};
}

}  // namespace shapespace::fuzz
