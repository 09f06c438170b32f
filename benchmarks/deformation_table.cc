// Deformation by handles: the four cases of Botsch and Sorkine's survey ("On Linear Variational
// Surface Deformation Methods", 2008) with generated bodies, compared with CGAL's SRE_ARAP if the
// program was built with CGAL; parts of real bodies; seconds, cold and warm; repair. Prints tables
// of docs/measurements.md and docs/performance.md, in Markdown. Seconds depend on the machine.
//   deformation_table [folder for the shapes, as OBJ]

#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/bodies/tube.h>
#include <shapespace/deformation/deformation.h>
#include <shapespace/deformation/repair.h>
#include <shapespace/files/read.h>
#include <shapespace/files/write.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/output/frames.h>

#ifdef SHAPESPACE_HAS_CGAL
#include "arap.h"
#endif

namespace shapespace {
namespace {

using Eigen::Vector3d;

std::string folder;

constexpr double kRadians = M_PI / 180;

struct Case {
  std::string name;
  std::shared_ptr<const Connectivity> connectivity;
  Shape rest;
  std::vector<DeformationHandle> handles;
};

std::vector<int> Where(const Shape& shape, const std::function<bool(const Vector3d&)>& holds) {
  std::vector<int> vertices;
  for (int v = 0; v < shape.cols(); ++v) {
    if (holds(shape.col(v))) vertices.push_back(v);
  }
  return vertices;
}

DeformationHandle Moving(std::vector<int> vertices, const ScrewMotion& motion = {}) {
  DeformationHandle handle;
  handle.vertices = std::move(vertices);
  handle.motion = motion;
  return handle;
}

// Rotates the end of a body that lies along x upwards about y, so that its middle line, of length
// `length` from `begin` on, becomes an arc.
ScrewMotion AlongAnArc(double begin, double length, double degrees) {
  ScrewMotion motion;
  motion.axis = -Vector3d::UnitY();
  motion.angle = degrees * kRadians;
  motion.point = Vector3d(begin + length, 0, 0);
  const double radius = length / motion.angle;
  motion.translation =
      Vector3d(begin + radius * std::sin(motion.angle), 0, radius * (1 - std::cos(motion.angle))) -
      motion.point;
  return motion;
}

std::vector<Case> SurveyCases(int cells) {
  std::vector<Case> cases;
  const ShapeFamily bar = MakeBar(6, 1, 1, 6 * cells, cells, cells);
  const Shape straight = bar.pose(0);
  const auto left = Where(straight, [](const auto& p) { return p.x() < -2.7 + 1e-9; });
  const auto right = Where(straight, [](const auto& p) { return p.x() > 2.7 - 1e-9; });
  ScrewMotion twist;
  twist.axis = Vector3d::UnitX();
  twist.angle = 135 * kRadians;
  cases.push_back({"bar twisted by 135 degrees",
                   bar.connectivity,
                   straight,
                   {Moving(left), Moving(right, twist)}});
  cases.push_back({"bar bent by 120",
                   bar.connectivity,
                   straight,
                   {Moving(left), Moving(right, AlongAnArc(-2.7, 5.4, 120))}});

  TubeForm form;
  form.length = 8;
  form.base_radius = form.tip_radius = 0.6;
  form.knuckle = 0;
  const ShapeFamily tube = MakeTube(40 * cells * cells, form);
  const Shape rest = tube.pose(0);
  cases.push_back({"cylinder bent by 120",
                   tube.connectivity,
                   rest,
                   {Moving(Where(rest, [](const auto& p) { return p.x() < 0.2; })),
                    Moving(Where(rest, [](const auto& p) { return p.x() > 7.8; }),
                           AlongAnArc(0.2, 7.6, 120))}});

  const ShapeFamily sheet = MakeSheet(2, 2, 5 * cells, 5 * cells);
  Shape plate = sheet.pose(0);
  for (int v = 0; v < plate.cols(); ++v) {
    const double x = plate(0, v), y = plate(1, v);
    plate(2, v) =
        0.04 * std::sin(9 * x) * std::sin(8 * y) + 0.02 * std::sin(21 * x + 1) * std::cos(17 * y);
  }
  ScrewMotion up;
  up.translation = Vector3d(0, 0, 0.8);
  cases.push_back(
      {"bumpy plate lifted",
       sheet.connectivity,
       plate,
       {Moving(Where(
            plate, [](const auto& p) { return std::max(std::abs(p.x()), std::abs(p.y())) > .95; })),
        Moving(Where(plate, [](const auto& p) { return p.template head<2>().norm() < 0.25; }),
               up)}});
  return cases;
}

void Save(const Case& problem, const std::string& method, const Shape& shape) {
  if (folder.empty()) return;
  std::string name = problem.name + " " + method;
  for (char& c : name) {
    if (c == ' ' || c == ',') c = '-';
  }
  WriteMesh(folder + "/" + name + ".obj", shape, FrameSoup(*problem.connectivity));
}

void PrintRow(const Case& problem, const std::string& method, const ShapeError& error,
              double residual, double seconds) {
  std::printf("| %s | %d | %s | %.1e | %.2f | %.1f | %.1f | %+.2f | %d | %.2f |\n",
              problem.name.c_str(), problem.connectivity->NumTriangles(), method.c_str(), residual,
              100 * error.edge_rms, 100 * error.edge_p99, 100 * error.edge_max, 100 * error.volume,
              error.inverted_hinges, seconds);
}

void PrintHead() {
  std::printf(
      "| case | triangles | method | handles off | edges rms, %% | p99 | max | volume, %% | "
      "hinges turned over | seconds |\n|---|--:|---|--:|--:|--:|--:|--:|--:|--:|\n");
}

Shape PrintOurs(const Case& problem, const std::string& method,
                const DeformationOptions& options = {}) {
  const DeformationResult result =
      Deform(problem.connectivity, problem.rest, problem.handles, options);
  double residual = 0;
  for (const auto& handle : result.summary.handles) {
    residual = std::max(residual, handle.residual_max);
  }
  PrintRow(problem, method + (result.summary.Converged() ? "" : " (not converged)"),
           result.summary.error, residual, result.summary.total_seconds);
  Shape last = result.path.Placed(options.shapes);
  Save(problem, method, last);
  return last;
}

void PrintWithAndWithoutVolume(const Case& problem) {
  MetricOptions metric = MetricOptions::Deformation(*problem.connectivity, problem.rest);
  DeformationOptions options;
  for (double volume : {0.0, metric.volume, 30.0}) {
    if (volume == 0 && metric.volume == 0) {
      PrintOurs(problem, "ours", options);
      return;
    }
    options.metric = metric;
    options.metric->volume = volume;
    char name[40];
    std::snprintf(name, sizeof name, "ours, volume %g", volume);
    PrintOurs(problem, name, options);
  }
}

void PrintArap(const Case& problem) {
#ifdef SHAPESPACE_HAS_CGAL
  const auto metric = FreezeMetric(MetricOptions(), problem.connectivity, {problem.rest});
  for (const auto& [steps, iterations] : {std::make_pair(10, 30), {10, 300}}) {
    const internal::Stopwatch stopwatch;
    const Shape shape = benchmarks::DeformByArap(*problem.connectivity, problem.rest,
                                                 problem.handles, steps, iterations);
    const double seconds = stopwatch.Seconds();
    const std::string method = "SRE_ARAP, 10 steps of " + std::to_string(iterations);
    PrintRow(problem, method, CompareShapes(metric, problem.rest, shape), 0, seconds);
    Save(problem, method, shape);
  }
#else
  (void)problem;
#endif
}

Vector3d Size(const Shape& shape) {
  return shape.rowwise().maxCoeff() - shape.rowwise().minCoeff();
}

// A part to move: the vertices within a share of the body's size from the one that is farthest in
// the direction `way`, rotated about a point at `arm` sizes from the body's centre.
struct Limb {
  Vector3d way;
  double share;
  Vector3d axis;
  double degrees;
  Vector3d arm;
};

// The lowest part of the body, y up, by a share of its height, is fixed, and a limb moves.
Case RealCase(const std::string& name, const std::string& file, double feet, const Limb& limb) {
  const Poses poses = ReadPoses({std::string(SHAPESPACE_DATA_DIR) + "/" + file});
  const Shape& rest = poses.shapes[0];
  const double top = rest.row(1).minCoeff() + feet * Size(rest).y();
  int tip = 0;
  (limb.way.transpose() * rest).maxCoeff(&tip);
  const double size = Size(rest).norm();
  DeformationHandle moved = Moving(
      Where(rest, [&](const auto& p) { return (p - rest.col(tip)).norm() < limb.share * size; }));
  moved.motion.axis = limb.axis;
  moved.motion.angle = limb.degrees * kRadians;
  moved.motion.point = rest(Eigen::all, moved.vertices).rowwise().mean() + size * limb.arm;
  return {name,
          poses.connectivity,
          rest,
          {Moving(Where(rest, [&](const auto& p) { return p.y() < top; })), moved}};
}

std::vector<Case> RealCases() {
  std::vector<Case> cases;
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  try {
    cases.push_back(RealCase("armadillo, an arm lifted by 80 degrees", "armadillo/arms_down.obj",
                             0.1, {x, 0.08, z, 80, Vector3d(-0.18, 0.12, 0)}));
    cases.push_back(RealCase("cat, the head turned by 60 degrees", "cat/reference.obj", 0.1,
                             {Vector3d(0, 0.2, 1), 0.12, y, 60, Vector3d(0, 0, -0.1)}));
    cases.push_back(RealCase("elephant, the trunk raised by 70 degrees", "elephant/reference.obj",
                             0.05, {Vector3d(0, -1, 0.7), 0.05, -x, 70, Vector3d(0, 0.18, -0.05)}));
  } catch (const Error& error) {
    std::printf("\nNo real meshes: %s\n", error.what());
  }
  return cases;
}

void PrintSeconds() {
  std::printf(
      "\nSeconds, 5 shapes (bar bent by 120, held by its ends or by ten vertices)\n\n"
      "| triangles | handles | cold | warm, by 2 degrees |\n|--:|---|--:|--:|\n");
  for (int cells : {14, 36}) {
    Case problem = SurveyCases(cells)[1];
    for (bool single : {false, true}) {
      if (single) {
        std::vector<DeformationHandle> few;
        for (const DeformationHandle& handle : problem.handles) {
          const size_t stride = handle.vertices.size() / 5;
          for (int k = 0; k < 5; ++k) {
            const int v = handle.vertices[k * stride];
            few.push_back(Moving({v}, handle.motion));
            few.back().positions = Shape(handle.motion.At(1, problem.rest.col(v)));
          }
        }
        problem.handles = few;
      }
      Deformer deformer(problem.connectivity, problem.rest);
      const double cold = deformer.Deform(problem.handles).summary.total_seconds;
      for (DeformationHandle& handle : problem.handles) {
        if (handle.motion.angle == 0) continue;
        handle.motion.angle += 2 * kRadians;
        if (handle.positions) {
          *handle.positions = handle.motion.At(1, problem.rest.col(handle.vertices[0]));
        }
      }
      const DeformationSummary warm = deformer.Deform(problem.handles).summary;
      std::printf("| %d | %s | %.2f | %.2f%s |\n", problem.connectivity->NumTriangles(),
                  single ? "ten vertices" : "two ends", cold, warm.total_seconds,
                  warm.warm ? "" : " (not warm)");
    }
  }
}

void PrintRepair() {
  std::printf(
      "\nRepair of half a straight-line blend with twelve dents, against the first pose\n\n"
      "| poses | volume before, %% | after | edges rms before, %% | after | hinges turned "
      "over | after | seconds |\n|---|--:|--:|--:|--:|--:|--:|--:|\n");
  const std::string data = SHAPESPACE_DATA_DIR "/";
  for (const auto& [first, second] : {std::make_pair("human/000", "human/007"),
                                      {"cat/reference", "cat/01"},
                                      {"hand/rest", "hand/curl65"},
                                      {"horse_lowpoly/base", "horse_lowpoly/m03"},
                                      {"armadillo/arms_up", "armadillo/arms_down"}}) {
    try {
      const Poses poses = ReadPoses({data + first + ".obj", data + second + ".obj"});
      const auto metric = FreezeMetric({}, poses.connectivity, {poses.shapes[0]});
      const Shape& reference = poses.shapes[0];
      const Shape other =
          FitRigidMotion(poses.shapes[1], reference, metric->vertex_area)(poses.shapes[1]);
      Shape distorted = 0.5 * (reference + other);
      const Vector3d centre = Centroid(reference, metric->vertex_area);
      for (int k = 0; k < 12; ++k) {
        const Vector3d at = reference.col((k * 7919 + 13) % reference.cols());
        const Vector3d inwards = (centre - at).normalized();
        for (int v = 0; v < reference.cols(); ++v) {
          const double share = (reference.col(v) - at).norm() / (0.12 * metric->unit);
          if (share < 1) {
            distorted.col(v) += 0.06 * metric->unit * std::pow(1 - share * share, 2) * inwards;
          }
        }
      }
      const RepairSummary summary = Repair(poses.connectivity, reference, distorted).summary;
      std::printf("| %s, %s | %.1f | %.2f | %.1f | %.1f | %d | %d | %.2f |\n", first, second,
                  100 * summary.before.volume, 100 * summary.after.volume,
                  100 * summary.before.edge_rms, 100 * summary.after.edge_rms,
                  summary.before.inverted_hinges, summary.after.inverted_hinges,
                  summary.deformation.total_seconds);
    } catch (const Error& error) {
      std::printf("| %s, %s | %s |\n", first, second, error.what());
    }
  }
}

}  // namespace
}  // namespace shapespace

int main(int argc, char** argv) {
  using namespace shapespace;
  if (argc > 1) folder = argv[1];
  PrintHead();
  for (const Case& problem : SurveyCases(10)) {
    PrintWithAndWithoutVolume(problem);
    PrintArap(problem);
  }
  for (const Case& problem : RealCases()) {
    PrintWithAndWithoutVolume(problem);
    PrintArap(problem);
  }
  PrintSeconds();
  PrintRepair();
}
