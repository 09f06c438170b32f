// Deformation transfer in feature space, by the ladder, and by Sumner and Popovic's method, on
// bodies with known results: prints the tables of docs/measurements.md, section 11, in Markdown.
// Seconds depend on the machine.

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <shapespace/analysis/quality.h>
#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/skinned.h>
#include <shapespace/files/read.h>
#include <shapespace/path/align.h>
#include <shapespace/transfer/detail/gradient_transfer.h>
#include <shapespace/transfer/transfer.h>

namespace shapespace {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

double Diameter(const Shape& shape) {
  return (shape.rowwise().maxCoeff() - shape.rowwise().minCoeff()).norm();
}

// Root mean square distance after alignment, over the diameter.
double Apart(const Shape& a, const Shape& b, const Eigen::VectorXd& area) {
  const Shape off = FitRigidMotion(a, b, area)(a) - b;
  return std::sqrt(off.colwise().squaredNorm().dot(area) / area.sum()) / Diameter(b);
}

// The angle between the bar's end faces, in degrees.
double BendOf(const Shape& straight, const Shape& bent) {
  Matrix3d ends[2];
  for (int end : {0, 1}) {
    const double x = end == 0 ? straight.row(0).minCoeff() : straight.row(0).maxCoeff();
    const Eigen::VectorXd face = (straight.row(0).array() == x).cast<double>().transpose();
    ends[end] = FitRigidMotion(straight, bent, face).rotation;
  }
  return std::abs(Eigen::AngleAxisd(Matrix3d(ends[0].transpose() * ends[1])).angle()) * 180 / M_PI;
}

TransferOptions ByLadder(const MetricOptions& metric, TransportConnection connection, bool placed) {
  TransferOptions options;
  options.method = TransferMethod::kLadder;
  options.ladder.metric = metric;
  options.ladder.connection = connection;
  options.ladder.scale = options.ladder.align = placed;
  return options;
}

void PrintBars() {
  const ShapeFamily thick = MakeBar(6, 1, 1, 12, 2, 2);
  const Shape thin = MakeBar(8, 1.6, 0.6, 12, 2, 2).pose(0);
  std::vector<Shape> bending;
  for (int i = 0; i <= 6; ++i) bending.push_back(thick.pose(10.0 * i));
  Path source;
  source.metric = FreezeMetric({}, thick.connectivity, bending);
  AlignedPoses aligned = AlignPoses(*source.metric, bending);
  source.shapes = aligned.shapes;
  source.motions = aligned.motions;
  for (int i = 0; i <= 6; ++i) source.parameters.push_back(i / 6.0);
  const Shape onto = FitRigidMotion(thin, bending[0], source.metric->vertex_area)(thin);
  const Shape theirs = internal::GradientTransfer(thick.connectivity, bending[0], onto)(bending[6]);
  std::printf("Sumner and Popovic: %.1f degrees\n\n", BendOf(thin, theirs));
  MetricOptions lengths = MetricOptions::Isometric();
  lengths.bending = 0;
  const std::pair<const char*, TransferOptions> modes[] = {
      {"the paper's transport, metric (4)",
       ByLadder(lengths, TransportConnection::kConstrainedProjection, false)},
      {"ladder, metric (4), not placed",
       ByLadder(lengths, TransportConnection::kLeviCivita, false)},
      {"ladder", ByLadder(LadderOptions::Strains(), TransportConnection::kLeviCivita, true)},
      {"features", TransferOptions()}};
  const Matrix3d z(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ())),
      y(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitY()));
  const std::pair<Matrix3d, double> places[] = {{Matrix3d::Identity(), 1},
                                                {z, 1},
                                                {y, 1},
                                                {Matrix3d::Identity(), 3},
                                                {Matrix3d::Identity(), 0.2}};
  std::printf("| | same | z 90 | y 90 | x 3 | x .2 |\n|---|---|---|---|---|---|\n");
  for (const auto& [name, options] : modes) {
    std::printf("| %s |", name);
    for (const auto& [turn, scale] : places) {
      try {
        const Path path = Transfer(source, scale * turn * thin, options).path;
        const Shape end = turn.transpose() * path.Placed(6) / scale;
        std::printf(" %.1f, %.4f |", BendOf(thin, end),
                    Apart(end, theirs, source.metric->vertex_area));
      } catch (const std::exception&) {
        std::printf(" fails |");
      }
    }
    std::printf("\n");
  }
}

// Difference between the changes of target and source: strains (log |e|) as shares, angles in
// degrees.
struct Off {
  double strain = 0, angle = 0;
};

Off WhatIsOff(const Metric& metric, const Shape& source, const Shape& deformed, const Shape& target,
              const Shape& made) {
  const Connectivity& connectivity = *metric.connectivity;
  Off off;
  for (int e = 0; e < connectivity.NumEdges(); ++e) {
    const auto length = [&](const Shape& s) {
      return (s.col(connectivity.Edges()(1, e)) - s.col(connectivity.Edges()(0, e))).norm();
    };
    const double strain =
        std::log(length(made) / length(target) * length(source) / length(deformed));
    if (std::isfinite(strain)) off.strain += metric.edge_area(e) * strain * strain;
  }
  off.strain = std::sqrt(off.strain / metric.edge_area.sum());
  Eigen::VectorXd angles = DihedralAngles(connectivity, made);
  angles -= DihedralAngles(connectivity, target);
  angles -= DihedralAngles(connectivity, deformed);
  angles += DihedralAngles(connectivity, source);
  off.angle = 180 / M_PI *
              std::sqrt(metric.hinge_area.dot(angles.unaryExpr(&WrapAngle).cwiseAbs2()) /
                        metric.hinge_area.sum());
  return off;
}

struct Pose {
  std::shared_ptr<const Connectivity> connectivity;
  Shape source, deformed, target, own;  // own: the expected shape of the target, if known
};

// A row: means over the poses of the distance from their own, of the differences, and of the time.
void PrintLine(const char* name, const std::vector<Pose>& poses, const TransferOptions* options) {
  double distance = 0, greatest = 0, seconds = 0;
  Off off;
  bool converged = true;
  for (const Pose& pose : poses) {
    const auto metric =
        FreezeMetric(MetricOptions::Strain(), pose.connectivity, {pose.source, pose.target});
    const internal::Stopwatch stopwatch;
    Shape made;
    if (options != nullptr) {
      const PoseTransferResult result =
          TransferPoses(pose.connectivity, {pose.source, pose.deformed}, pose.target, {}, *options);
      made = result.path.Placed(1);
      converged = converged && result.summary.Converged();
    } else {
      const RigidMotion onto = FitRigidMotion(pose.source, pose.target, metric->vertex_area);
      made = internal::GradientTransfer(pose.connectivity, onto(pose.source),
                                        pose.target)(onto(pose.deformed));
    }
    seconds += stopwatch.Seconds() / poses.size();
    const Off here = WhatIsOff(*metric, pose.source, pose.deformed, pose.target, made);
    off.strain += here.strain / poses.size();
    off.angle += here.angle / poses.size();
    if (pose.own.size() == 0) continue;
    const double apart = Apart(made, pose.own, metric->vertex_area);
    distance += apart / poses.size();
    greatest = std::max(greatest, apart);
  }
  std::printf("| %s | %.2f %%, %.2f %% | %.1f %% | %.2f | %.2f%s |\n", name, 100 * distance,
              100 * greatest, 100 * off.strain, off.angle, seconds,
              converged ? "" : ", NOT CONVERGED");
}

void PrintPoses(const char* title, const std::vector<Pose>& poses) {
  std::printf(
      "\n| %s: lambda, b | distance, greatest | strain | degrees | seconds a pose |\n"
      "|---|---|---|---|---|\n",
      title);
  const auto line = [&](const char* name, double lambda, double bending) {
    TransferOptions options;
    options.metric.lambda = lambda;
    options.metric.bending = bending;
    PrintLine(name, poses, &options);
  };
  line("1e-6, 1e-3", 1e-6, 1e-3);
  line("10, 1e-4", 10, 1e-4);
  line("100, 1e-4", 100, 1e-4);
  line("**1000, 1e-4**", 1000, 1e-4);
  line("1000, 1e-3", 1000, 1e-3);
  PrintLine("Sumner and Popovic", poses, nullptr);
}

std::vector<Pose> Quadrupeds() {
  const SkinnedBody normal = MakeSkinnedBody("quadruped", 8000);
  std::vector<Pose> poses;
  for (const char* proportions : {"long", "short", "heavy"}) {
    const SkinnedBody other = MakeSkinnedBody("quadruped", 8000, proportions);
    for (const char* pose : {"stride", "rear", "sit"}) {
      poses.push_back({normal.connectivity, normal.pose("stand"), normal.pose(pose),
                       other.pose("stand"), other.pose(pose)});
    }
  }
  return poses;
}

}  // namespace
}  // namespace shapespace

int main() {
  using namespace shapespace;
  PrintBars();
  PrintPoses("quadruped", Quadrupeds());
  const std::string folder = SHAPESPACE_DATA_DIR;
  if (folder.empty()) {
    std::printf("\nno real meshes: set the CMake cache path SHAPESPACE_DATA_DIR\n");
    return 0;
  }
  const Poses people = ReadPoses(
      {folder + "/human/000.obj", folder + "/human/007.obj", folder + "/human_b/024.obj"});
  PrintPoses("people", {{people.connectivity, people.shapes[0], people.shapes[1], people.shapes[2],
                         Shape()}});
}
