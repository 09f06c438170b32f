#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/correspondence/correspondence.h>
#include <shapespace/deformation/deformation.h>
#include <shapespace/exponential/transport.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/geodesic/internal/memory.h>
#include <shapespace/spline/spline.h>
#include <shapespace/transfer/transfer.h>

#include "support/listener.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

using testing::Listener;
using testing::MessageOf;
using testing::Names;

// A solver's call with a memory limit. \return the estimate.
using Call = std::function<double(double memory_limit, Progress* progress)>;

struct Calls {
  ShapeFamily bar = MakeBar(6, 1, 1, 24, 4, 4);
  Shape straight = bar.pose(0), bent = bar.pose(30);
  std::shared_ptr<const Metric> metric = FreezeMetric({}, bar.connectivity, {straight, bent});
  Path path = MakePath(metric, {straight, bent}, {0, 1});

  Call Transporting() const {
    return [this](double limit, Progress* progress) {
      TransportOptions options;
      options.memory_limit = limit;
      return Transport(path, {bent - straight}, options, progress).summary.estimated_bytes;
    };
  }
  Call Transferring(TransferMethod method, bool hybrids) const {
    return [this, method, hybrids](double limit, Progress* progress) {
      TransferOptions options;
      options.method = method;
      options.hybrids = hybrids;
      options.memory_limit = limit;
      return Transfer(path, 1.2 * straight, options, progress).summary.estimated_bytes;
    };
  }
  Call Corresponding() const {
    return [this](double limit, Progress* progress) {
      CorrespondenceOptions options;
      options.memory_limit = limit;
      const int last = static_cast<int>(straight.cols()) - 1;
      const std::vector<CorrespondenceMarker> markers = {
          {0, 0}, {4, 4}, {last / 2, last / 2}, {last, last}};
      return Correspond(bar.connectivity, straight, bar.connectivity, straight, markers, options,
                        progress)
          .summary.estimated_bytes;
    };
  }
  Call Deforming() const {
    return [this](double limit, Progress* progress) {
      DeformationOptions options;
      options.memory_limit = limit;
      DeformationHandle handle;
      handle.vertices = {0};
      return Deform(bar.connectivity, straight, {handle}, options, progress)
          .summary.estimated_bytes;
    };
  }
  Call Interpolating() const {
    return [this](double limit, Progress* progress) {
      GeodesicOptions options;
      options.memory_limit = limit;
      return Interpolate(metric, {straight, bent}, options, progress).summary.estimated_bytes;
    };
  }
  Call Smoothing() const {
    return [this](double limit, Progress* progress) {
      SplineOptions options;
      options.geodesic.shapes = 1;
      options.geodesic.memory_limit = limit;
      // So many poses that they take more memory than the geodesics between them.
      const std::vector<Shape> poses = {straight, bent, straight, bent, straight, bent};
      return Spline(bar.connectivity, poses, options, progress).summary.estimated_bytes;
    };
  }
  Call InterpolatingBetween() const {
    return [this](double limit, Progress* progress) {
      GeodesicOptions options;
      options.memory_limit = limit;
      return Interpolator(bar.connectivity, {straight, bent}, options)
          .Between(straight, bent, progress)
          .summary.estimated_bytes;
    };
  }
};

TEST(MemoryLimit, IsKeptByAllSolvers) {
  const Calls calls;
  for (const auto& [name, call] : std::vector<std::pair<std::string, Call>>{
           {"transport", calls.Transporting()},
           {"features", calls.Transferring(TransferMethod::kFeatures, false)},
           {"features and hybrids", calls.Transferring(TransferMethod::kFeatures, true)},
           {"ladder", calls.Transferring(TransferMethod::kLadder, false)},
           {"correspondence", calls.Corresponding()},
           {"deformation", calls.Deforming()},
           {"geodesic", calls.Interpolating()},
           {"spline", calls.Smoothing()},
           {"geodesic between", calls.InterpolatingBetween()}}) {
    SCOPED_TRACE(name);
    const double needed = call(std::numeric_limits<double>::infinity(), nullptr);
    EXPECT_GT(needed, 1e5);
    EXPECT_LT(needed, 1e8);
    EXPECT_EQ(call(needed, nullptr), needed);
    Listener listener;
    const std::string message =
        MessageOf<SolverError>([&, &call = call] { call(0.99 * needed, &listener); });
    EXPECT_TRUE(Names(message, {"memory limit"}));
    EXPECT_NE(message.find("raise memory_limit"), std::string::npos) << message;
    EXPECT_EQ(listener.reports, 0);
    EXPECT_EQ(
        MessageOf<InvalidOptions>([&, &call = call] { call(0, nullptr); }).find("memory_limit:"),
        0u);
  }
}

// A path that jumps is solved again with twice as many shapes. Whether there is memory for them is
// asked before, so that no result depends on the limit.
TEST(MemoryLimit, OfAGeodesicCountsTheShapesThatRemoveAJump) {
  const Calls calls;
  const int shapes = GeodesicOptions().shapes;
  const double asked_for = internal::GeodesicBytes(*calls.metric, 2, shapes);
  const double twice = internal::GeodesicBytes(*calls.metric, 2, 2 * shapes + 1);
  for (const Call& call : {calls.Interpolating(), calls.InterpolatingBetween()}) {
    EXPECT_GE(call(std::numeric_limits<double>::infinity(), nullptr), twice);
    EXPECT_NE(MessageOf<SolverError>([&] { call(1.01 * asked_for, nullptr); }).find("memory limit"),
              std::string::npos);
  }
}

// Each is held before and after a step.
TEST(MemoryLimit, OfATransportCountsItsTangents) {
  const Calls calls;
  const auto estimate = [&](int tangents) {
    const std::vector<Tangent> all(tangents, calls.bent - calls.straight);
    return Transport(calls.path, all).summary.estimated_bytes;
  };
  const double of_one = 2 * sizeof(double) * calls.straight.size();
  EXPECT_GE(estimate(9) - estimate(1), 8 * of_one);
}

TEST(MemoryLimit, OfATransferIsThatOfItsParts) {
  const Calls calls;
  const double no_limit = std::numeric_limits<double>::infinity();
  const auto estimate = [&](TransferMethod method, bool hybrids) {
    return calls.Transferring(method, hybrids)(no_limit, nullptr);
  };
  const double features = estimate(TransferMethod::kFeatures, false);
  const double ladder = estimate(TransferMethod::kLadder, false);
  EXPECT_DOUBLE_EQ(estimate(TransferMethod::kFeatures, true), features + ladder);
  EXPECT_GT(ladder, calls.Transporting()(no_limit, nullptr));
}

}  // namespace
}  // namespace shapespace
