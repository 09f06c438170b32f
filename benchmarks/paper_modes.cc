// The paper's methods for the exponential map and for parallel transport, compared with this
// library's: the decrease of their errors with the step, as tables in Markdown
// (docs/measurements.md, sections 8 and 10). No times.

#include <algorithm>
#include <cstdio>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/bricard.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/exponential/transport.h>
#include <shapespace/path/align.h>
#include "support/runge_kutta.h"

namespace shapespace {
namespace {

struct Motion {
  const char* name;
  std::shared_ptr<const Metric> metric;
  Shape shape;
  Tangent velocity;  // per unit of time
};

Eigen::Matrix3d Rotation(double degrees) {
  return Eigen::AngleAxisd(degrees * M_PI / 180, Eigen::Vector3d(0.3, 1, 0.5).normalized())
      .toRotationMatrix();
}

Motion Make(const char* name, const ShapeFamily& body, double at, const Shape& before,
            const Shape& after, double time, const MetricOptions& options) {
  const Shape shape = body.pose(at);
  return {name, FreezeMetric(options, body.connectivity, {shape}), shape, (after - before) / time};
}

std::vector<Motion> Motions() {
  MetricOptions membrane = MetricOptions::Isometric();
  membrane.bending = 0;
  membrane.lambda = 1e-3;
  constexpr double kTime = 2e-4;  // of the differences from which velocities are computed
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 1, 1), strip = MakeStrip(1, 0.9, 16),
                    bricard = MakeBricard();
  const auto deforming = [&](const char* name, const ShapeFamily& body, double at, double rate) {
    return Make(name, body, at, body.pose(at - rate * kTime / 2), body.pose(at + rate * kTime / 2),
                kTime, membrane);
  };
  return {Make("bar, turning by 90 degrees", bar, 30, Rotation(-45 * kTime) * bar.pose(30),
               Rotation(45 * kTime) * bar.pose(30), kTime, membrane),
          deforming("bar, bending from 30 to 90 degrees", bar, 30, 60),
          deforming("strip, rolling", strip, 5, 10), deforming("Bricard, flexing", bricard, 0, 25)};
}

// Errors at t = 1 and, for the paper's (7), the number of steps that were solved.
void PrintExponentials() {
  std::printf(
      "| error at t = 1, share of the way | steps | variational | Runge-Kutta 4 | (7), L-BFGS | "
      "(7), "
      "Levenberg-Marquardt |\n"
      "|---|---:|---:|---:|---:|---:|\n");
  for (const Motion& motion : Motions()) {
    const auto shoot = [&](int steps, const ExponentialOptions& options) {
      return Extrapolate(motion.metric, motion.shape, motion.velocity, steps, options);
    };
    const auto runge_kutta = [&](int steps) {
      return testing::RungeKutta(motion.metric, motion.shape, motion.velocity, steps).back();
    };
    ExponentialOptions variational, lbfgs, levenberg_marquardt;
    lbfgs.integrator = levenberg_marquardt.integrator = GeodesicIntegrator::kFirstIntegral;
    lbfgs.max_iterations = levenberg_marquardt.max_iterations = 1000;
    lbfgs.first_integral_solver = FirstIntegralSolver::kLbfgs;
    levenberg_marquardt.first_integral_solver = FirstIntegralSolver::kLevenbergMarquardt;
    const Shape exact = runge_kutta(512);
    const auto error = [&](const Shape& end) {
      return (end - exact).norm() / (exact - motion.shape).norm();
    };
    for (int steps : {8, 16, 32, 64}) {
      std::printf("| %s | %d |", motion.name, steps);
      for (const auto& options : {variational, lbfgs, levenberg_marquardt}) {
        const auto [path, summary] = shoot(steps, options);
        std::printf(" %.1e", error(path.Placed(path.NumShapes() - 1)));
        if (options.integrator == GeodesicIntegrator::kFirstIntegral) {
          const auto solved =
              std::count_if(summary.steps.begin(), summary.steps.end(),
                            [](const ExponentialSummary::Step& step) { return step.converged; });
          std::printf(", %d solved", static_cast<int>(solved));
        }
        std::printf(" |");
        if (options.integrator == GeodesicIntegrator::kVariational) {
          std::printf(" %.1e |", error(runge_kutta(steps)));
        }
      }
      std::printf("\n");
    }
  }
}

void PrintTransports() {
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 2, 2);
  const Shape shape = bar.pose(5);
  const auto metric = FreezeMetric(MetricOptions::Isometric(), bar.connectivity, {shape});
  const Tangent bend = 100 * (bar.pose(5.01) - shape);
  const Tangent stretch = 0.1 * Eigen::Vector3d(1, 0, 0).asDiagonal() * shape;
  const auto turning = [&](int segments) {
    Path path;
    path.metric = metric;
    const Shape centred = shape.colwise() - Centroid(shape, metric->vertex_area);
    for (int i = 0; i <= segments; ++i) {
      path.shapes.push_back(Rotation(90.0 * i / segments) * centred / metric->unit);
      path.parameters.push_back(static_cast<double>(i) / segments);
    }
    path.motions.resize(segments + 1);
    path.poses = {0, segments};
    return path;
  };
  const auto carry = [&](const Tangent& x, int segments, TransportConnection connection,
                         bool align) {
    TransportOptions options;
    options.connection = connection;
    options.align = align;
    return Transport(turning(segments), {x}, options);
  };
  std::printf(
      "\n| along a bar that turns by 90 degrees: norm, error | segments | ours, aligned | ours, "
      "not aligned | the paper's |\n|---|---:|---:|---:|---:|\n");
  for (const auto& [name, x] : {std::make_pair("its bending", bend), {"its stretching", stretch}}) {
    // Two references: the tangent rotated with the body, and the limit of many segments without
    // alignment.
    const Tangent turned = Rotation(90) * x;
    const Tangent limit = carry(x, 512, TransportConnection::kLeviCivita, false).tangents[0];
    for (int segments : {4, 16, 64}) {
      std::printf("| %s | %d |", name, segments);
      const auto print = [&](TransportConnection connection, bool align, const Tangent& exact) {
        const TransportResult result = carry(x, segments, connection, align);
        std::printf(" %.4f, %.1e |", result.summary.last_norm[0] / result.summary.first_norm[0],
                    (result.tangents[0] - exact).norm() / x.norm());
      };
      print(TransportConnection::kLeviCivita, true, turned);
      print(TransportConnection::kLeviCivita, false, limit);
      print(TransportConnection::kConstrainedProjection, false, limit);
      std::printf("\n");
    }
  }
}

}  // namespace
}  // namespace shapespace

int main() {
  shapespace::PrintExponentials();
  shapespace::PrintTransports();
}
