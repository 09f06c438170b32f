#include "properties/methods.h"

#include <memory>

#include <shapespace/deformation/deformation.h>
#include <shapespace/deformation/repair.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/exponential/transport.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/path/path.h>
#include <shapespace/spline/spline.h>
#include <shapespace/statistics/average.h>
#include <shapespace/transfer/transfer.h>

namespace shapespace::testing {
namespace {

constexpr double kTolerance = 1e-11;
constexpr int kMaxIterations = 5000;

std::vector<Shape> RunInterpolate(const RandomBody& body) {
  return Interpolate(body.connectivity, body.poses, AccurateGeodesic(body, 3)).path.Placed();
}

// A pose where it is nearest to the first.
Shape AtFirst(const RandomBody& body, const Metric& metric, int pose) {
  return FitRigidMotion(body.poses[pose], body.poses[0], metric.vertex_area)(body.poses[pose]);
}

std::vector<Shape> RunExtrapolate(const RandomBody& body) {
  const auto metric = FreezeMetric(body.metric, body.connectivity, {body.poses[0]});
  const Tangent velocity = 0.3 * (AtFirst(body, *metric, 1) - body.poses[0]);
  return Extrapolate(metric, body.poses[0], velocity, 4).path.Placed();
}

std::vector<Shape> RunTransport(const RandomBody& body) {
  const auto metric = FreezeMetric(body.metric, body.connectivity, body.poses);
  const Shape last = AtFirst(body, *metric, 1);
  std::vector<Shape> shapes;
  for (const double t : {0., 0.1, 0.2, 0.3}) {
    shapes.push_back((1 - t) * body.poses[0] + t * last);
  }
  const Tangent tangent = AtFirst(body, *metric, 2) - body.poses[0];
  const Path path = MakePath(metric, shapes);
  const Tangent result = Transport(path, {tangent}).tangents[0];
  return {shapes.back() + result};
}

std::vector<Shape> RunDeform(const RandomBody& body) {
  DeformationOptions options;
  options.metric = body.metric;
  options.shapes = 2;
  options.tolerance = kTolerance;
  options.max_iterations = kMaxIterations;
  const auto metric = FreezeMetric(body.metric, body.connectivity, {body.poses[0]});
  // A part of the way, because a hinge that handles fold up whole has no derivative.
  const Shape goal = 0.7 * body.poses[0] + 0.3 * AtFirst(body, *metric, 1);
  std::vector<DeformationHandle> handles(2);
  handles[0].vertices = body.held;
  handles[1].vertices = body.moved;
  handles[1].positions = goal(Eigen::all, body.moved);
  return Deform(body.connectivity, body.poses[0], handles, options).path.Placed();
}

std::vector<Shape> RunRepair(const RandomBody& body) {
  RepairOptions options;
  options.deformation.metric = body.metric;
  options.deformation.tolerance = kTolerance;
  options.deformation.max_iterations = kMaxIterations;
  return Repair(body.connectivity, body.poses[0], body.poses[1], options).path.Placed();
}

std::vector<Shape> RunTransfer(const RandomBody& body) {
  const auto metric = FreezeMetric(body.metric, body.connectivity, {body.poses[0], body.poses[1]});
  const Path source = MakePath(metric, {body.poses[0], body.poses[1]});
  TransferOptions options;
  options.metric.bending = body.metric.bending;
  options.metric.lambda = body.metric.lambda;
  options.tolerance = 1e-10;
  options.max_iterations = kMaxIterations;
  return Transfer(source, body.poses[2], options).path.Placed();
}

std::vector<Shape> RunAverage(const RandomBody& body) {
  AverageOptions options;
  options.certify = false;
  options.tolerance = 1e-12;
  options.max_iterations = kMaxIterations;
  options.geodesic.metric = body.metric;
  return {Average(body.connectivity, body.poses, options).shape};
}

std::vector<Shape> RunSpline(const RandomBody& body) {
  SplineOptions options;
  options.geodesic = AccurateGeodesic(body, 3);
  return Spline(body.connectivity, body.poses, options).path.Placed();
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const Method& method) { return out << method.name; }

GeodesicOptions AccurateGeodesic(const RandomBody& body, int shapes) {
  GeodesicOptions options;
  options.metric = body.metric;
  options.shapes = shapes;
  options.tolerance = kTolerance;
  options.max_iterations = kMaxIterations;
  options.assess = false;
  return options;
}

const std::vector<Method>& AllMethods() {
  static const std::vector<Method> kMethods = {{"Interpolate", 3, 1e-5, true, RunInterpolate},
                                               {"Extrapolate", 2, 1e-7, true, RunExtrapolate},
                                               {"Transport", 3, 1e-7, true, RunTransport},
                                               {"Deform", 2, 1e-4, false, RunDeform},
                                               {"Repair", 2, 1e-5, false, RunRepair},
                                               {"Transfer", 3, 1e-5, false, RunTransfer},
                                               {"Average", 3, 1e-5, true, RunAverage},
                                               {"Spline", 3, 1e-5, true, RunSpline}};
  return kMethods;
}

}  // namespace shapespace::testing
