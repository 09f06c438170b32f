#include "support/metric_flags.h"

#include <string>

#include <gflags/gflags.h>

#include <shapespace/base/error.h>
#include <shapespace/files/vertex_field.h>

#include "support/flag_group.h"
#include "support/tool.h"

DEFINE_string(metric, "strain",
              "preset of the metric's other flags: strain (the defaults shown here), isometric "
              "(strain 0, isometric 1), rigid (strain 0, rigid 1, bending 0), or paper (strain 0, "
              "isometric 1, bending 0, lambda 0.001, weights uniform, discretization trapezoid); "
              "shape-deform has one of its own, deformation. Costs that are given as well replace "
              "those of the preset");
DEFINE_double(strain, 1,
              "cost of logarithmic strains of triangles, with which paths can always be continued; "
              "all costs are pure numbers, for area 1");
DEFINE_double(isometric, 0, "cost of stretching edges, measured by their squared lengths");
DEFINE_double(rigid, 0, "cost of deviation from rigid motion of the whole body");
DEFINE_double(lambda, 1e-4, "cost of moving vertices; harmless up to 1e-3");
DEFINE_double(bending, 1e-5, "cost of bending: t^2 / 12 for a shell of thickness t");
DEFINE_double(volume, 0, "cost of changing the enclosed volume; start from 0.3");
DEFINE_string(weights, "area", "weights of edges: area, or uniform as in the paper");
DEFINE_string(
    discretization, "midpoint",
    "discretisation of --isometric along a segment: midpoint, or trapezoid as in the paper");

DEFINE_string(
    stiffness, "",
    "file of factors on the cost of stretching and bending, one positive number per "
    "vertex: a text with one number per line, or a property of a PLY file, as body.ply:name");
FLAG_GROUP(metric, "Metric");

namespace shapespace::tools {
namespace {

/// What --stiffness names, read once.
const Eigen::VectorXd& Stiffness() {
  static const Eigen::VectorXd stiffness = [] {
    Eigen::VectorXd field = ReadVertexField(FLAGS_stiffness);
    for (int v = 0; v < field.size(); ++v) {
      if (field(v) > 0) continue;
      throw FileError(FLAGS_stiffness + ": the stiffness of vertex " + std::to_string(v + 1) +
                      " is not positive");
    }
    return field;
  }();
  return stiffness;
}

}  // namespace

MetricOptions MetricFromFlags(const Poses* mesh) {
  MetricOptions options;
  if (FLAGS_metric == "deformation" && mesh != nullptr) {
    options = MetricOptions::Deformation(*mesh->connectivity, mesh->shapes[0]);
  } else if (FLAGS_metric == "rigid") {
    options = MetricOptions::Rigid();
  } else if (FLAGS_metric == "isometric") {
    options = MetricOptions::Isometric();
  } else if (FLAGS_metric == "paper") {
    options = MetricOptions::Paper();
  } else if (FLAGS_metric != "strain") {
    throw UsageError("--metric " + FLAGS_metric + ": must be strain, isometric, rigid or paper" +
                     (mesh != nullptr ? ", or deformation" : ""));
  }
  if (IsGiven("isometric")) options.isometric = FLAGS_isometric;
  if (IsGiven("strain")) options.strain = FLAGS_strain;
  if (IsGiven("rigid")) options.rigid = FLAGS_rigid;
  if (IsGiven("lambda")) options.lambda = FLAGS_lambda;
  if (IsGiven("bending")) options.bending = FLAGS_bending;
  if (IsGiven("volume")) options.volume = FLAGS_volume;
  if (IsGiven("weights")) {
    if (FLAGS_weights != "area" && FLAGS_weights != "uniform") {
      throw UsageError("--weights " + FLAGS_weights + ": must be area or uniform");
    }
    options.weights = FLAGS_weights == "area" ? Weighting::kArea : Weighting::kUniform;
  }
  if (IsGiven("discretization")) {
    if (FLAGS_discretization != "midpoint" && FLAGS_discretization != "trapezoid") {
      throw UsageError("--discretization " + FLAGS_discretization +
                       ": must be midpoint or trapezoid");
    }
    options.discretization =
        FLAGS_discretization == "midpoint" ? Discretization::kMidpoint : Discretization::kTrapezoid;
    if (options.discretization == Discretization::kTrapezoid && options.isometric == 0) {
      throw UsageError(AsTyped("discretization") +
                       ": is a form of the cost of edge lengths, which this metric has not; add "
                       "--metric isometric");
    }
  }
  if (!FLAGS_stiffness.empty()) {
    options.stretching_stiffness = options.bending_stiffness = Stiffness();
  }
  options.Validate();
  return options;
}

void CheckMetricFlags(const Connectivity& connectivity) {
  if (!FLAGS_stiffness.empty() && Stiffness().size() != connectivity.NumVertices()) {
    throw FileError(FLAGS_stiffness + ": has " + std::to_string(Stiffness().size()) +
                    " numbers, the mesh has " + std::to_string(connectivity.NumVertices()) +
                    " vertices; give one number a vertex");
  }
  if (IsGiven("bending") && FLAGS_bending > 0 && connectivity.NumHinges() == 0) {
    throw UsageError(AsTyped("bending") +
                     ": no two triangles of this mesh share an edge, so there is no bending; leave "
                     "the flag out");
  }
}

}  // namespace shapespace::tools
