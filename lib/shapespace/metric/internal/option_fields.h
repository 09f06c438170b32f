#ifndef SHAPESPACE_METRIC_INTERNAL_OPTION_FIELDS_H_
#define SHAPESPACE_METRIC_INTERNAL_OPTION_FIELDS_H_

#include <optional>
#include <string>

#include <shapespace/base/internal/fields.h>
#include <shapespace/metric/metric.h>

// The fields of options, and the words of enumerations (base/internal/fields.h).

namespace shapespace::internal {

inline Words<Weighting> WordsOf(Of<Weighting>) {
  return {{"area", Weighting::kArea}, {"uniform", Weighting::kUniform}};
}

inline Words<Discretization> WordsOf(Of<Discretization>) {
  return {{"midpoint", Discretization::kMidpoint}, {"trapezoid", Discretization::kTrapezoid}};
}

inline Words<StiffnessOn> WordsOf(Of<StiffnessOn>) {
  return {{"vertices", StiffnessOn::kVertices}, {"edges", StiffnessOn::kEdges}};
}

inline Words<PosePairs> WordsOf(Of<PosePairs>) {
  return {{"consecutive", PosePairs::kConsecutive}, {"all", PosePairs::kAll}};
}

template <typename Visit>
void ForOptions(Of<MetricOptions>, const Visit& visit) {
  visit("isometric", &MetricOptions::isometric,
        "Cost of a change of edge lengths, measured by their squares; costs are pure numbers, for "
        "area 1.");
  visit("strain", &MetricOptions::strain,
        "Cost of a change of the triangles' logarithmic strains, with which paths can always be "
        "continued.");
  visit("rigid", &MetricOptions::rigid, "Cost of deviation from rigid motion of the whole body.");
  visit("lambda", &MetricOptions::lambda, "Cost of the motion of vertices; harmless up to 1e-3.");
  visit("bending", &MetricOptions::bending,
        "Cost of a change of dihedral angles: t^2 / 12 for a shell of thickness t.");
  visit("volume", &MetricOptions::volume,
        "Cost of a change of the enclosed volume, closed meshes only; start from 0.3.");
  visit("features", &MetricOptions::features,
        "Features of one's own: the coefficient, zero or more, of each by its name.");
  visit("weights", &MetricOptions::weights,
        "Weights of edges and triangles: by the surface around them, or 1 as in the paper.");
  visit("discretization", &MetricOptions::discretization,
        "How the cost of edge lengths is integrated along a segment of a path: at its midpoint, or "
        "at both ends as in the paper.");
  visit("stretching_stiffness", &MetricOptions::stretching_stiffness,
        "Positive factors on the cost of stretching, one number for each vertex or edge, as "
        "`stiffness_on` says. None: 1 everywhere.");
  visit("bending_stiffness", &MetricOptions::bending_stiffness,
        "Positive factors on the cost of bending, likewise.");
  visit("stiffness_on", &MetricOptions::stiffness_on,
        "What the numbers of both stiffnesses belong to: the vertices, or the rows of `edges`.");
}

/// The metric that is known by a name of this list; `deformation` is none, because it depends on
/// the mesh.
inline std::optional<MetricOptions> MetricPreset(const std::string& name) {
  if (name == "strain") return MetricOptions::Strain();
  if (name == "isometric") return MetricOptions::Isometric();
  if (name == "rigid") return MetricOptions::Rigid();
  if (name == "paper") return MetricOptions::Paper();
  return std::nullopt;
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_METRIC_INTERNAL_OPTION_FIELDS_H_
