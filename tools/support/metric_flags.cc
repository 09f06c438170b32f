#include "support/metric_flags.h"

#include <string>

#include <gflags/gflags.h>

#include <shapespace/base/error.h>
#include <shapespace/files/vertex_field.h>
#include <shapespace/metric/internal/option_fields.h>

#include "support/command_line.h"
#include "support/flag_group.h"
#include "support/option_flags.h"
#include "support/tool.h"

DEFINE_string(metric, "strain",
              "preset of the metric's other flags: strain (the defaults shown here), isometric "
              "(strain 0, isometric 1), rigid (strain 0, rigid 1, bending 0), or paper (strain 0, "
              "isometric 1, bending 0, lambda 0.001, weighting uniform, discretization trapezoid); "
              "shape-deform has one of its own, deformation. Costs that are given as well replace "
              "those of the preset (strain, isometric, rigid, paper)");
DEFINE_string(
    stiffness, "",
    "file of factors on the cost of stretching and bending, one positive number per "
    "vertex: a text with one number per line, or a property of a PLY file, as body.ply:name, "
    "or point data of a VTK file, as body.vtp:name");
FLAG_GROUP(metric, "Metric", "");
static const shapespace::tools::OptionFlags<shapespace::MetricOptions> costs(
    __FILE__, {{"strain", "strain"},
               {"isometric", "isometric"},
               {"rigid", "rigid"},
               {"lambda", "lambda"},
               {"bending", "bending"},
               {"volume", "volume"},
               {"weights", "weighting"},
               {"discretization", "discretization"}});

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
  } else if (const auto preset = internal::MetricPreset(FLAGS_metric)) {
    options = *preset;
  } else {
    throw UsageError("--metric " + FLAGS_metric + ": must be strain, isometric, rigid or paper" +
                     (mesh != nullptr ? ", or deformation" : ""));
  }
  if (!FLAGS_stiffness.empty()) {
    options.stretching_stiffness = options.bending_stiffness = Stiffness();
  }
  costs.Set(&options);
  if (IsGiven("discretization") && options.discretization == Discretization::kTrapezoid &&
      options.isometric == 0) {
    throw UsageError(AsTyped("discretization") +
                     ": is a form of the cost of edge lengths, which this metric has not; add "
                     "--metric isometric");
  }
  return options;
}

void CheckMetricFlags(const Connectivity& connectivity) {
  if (!FLAGS_stiffness.empty() && Stiffness().size() != connectivity.NumVertices()) {
    throw FileError(FLAGS_stiffness + ": has " + std::to_string(Stiffness().size()) +
                    " numbers, the mesh has " + std::to_string(connectivity.NumVertices()) +
                    " vertices; give one number a vertex");
  }
  const auto bending = gflags::GetCommandLineFlagInfoOrDie("bending");
  if (!bending.is_default && std::stod(bending.current_value) > 0 && !Bends(connectivity)) {
    throw UsageError(AsTyped("bending") +
                     ": no two triangles of this mesh share an edge, and no two segments form a "
                     "curve, so there is no bending; leave the flag out");
  }
}

}  // namespace shapespace::tools
