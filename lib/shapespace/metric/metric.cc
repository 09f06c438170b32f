#include <shapespace/metric/metric.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/mesh/volume.h>
#include <shapespace/metric/feature_registry.h>
#include <shapespace/metric/turning_angle.h>

namespace shapespace {
namespace {

void CheckNonNegative(double value, const char* field) {
  if (!(value >= 0) || !std::isfinite(value)) {
    throw InvalidOptions(field, "must be a number, zero or more");
  }
}

void CheckStiffness(const Eigen::VectorXd& field, const char* name) {
  for (int i = 0; i < field.size(); ++i) {
    if (!(field(i) > 0) || !std::isfinite(field(i))) {
      throw InvalidOptions(name, "entry " + std::to_string(i) + " is not a positive number");
    }
  }
}

}  // namespace

// Chosen on bent and twisted bars and cylinders and a lifted plate (benchmarks/deformation_table).
// With less bending the bodies kink and buckle, with more they stretch; with strains only, a few
// triangles of the plate stretch strongly; with lengths only, the bar is compressed.
MetricOptions MetricOptions::Deformation(const Connectivity& connectivity, const Shape& rest) {
  if (rest.cols() != connectivity.NumVertices()) {
    throw MeshError("the shape has " + std::to_string(rest.cols()) + " vertices, the mesh " +
                    std::to_string(connectivity.NumVertices()));
  }
  const bool solid = EnclosesVolume(connectivity.Triangles(), rest);
  MetricOptions options;
  options.isometric = 0.3;
  options.strain = 0.7;
  options.lambda = 0;
  options.bending = solid ? 7e-5 : 3e-5;
  options.volume = solid ? 0.05 : 0;
  return options;
}

MetricOptions MetricOptions::Isometric() {
  MetricOptions options;
  options.isometric = 1;
  options.strain = 0;
  return options;
}

MetricOptions MetricOptions::Rigid() {
  MetricOptions options;
  options.strain = 0;
  options.rigid = 1;
  options.bending = 0;
  return options;
}

MetricOptions MetricOptions::Paper() {
  MetricOptions options = Isometric();
  options.lambda = 1e-3;
  options.bending = 0;
  options.weights = Weighting::kUniform;
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
  double own = 0;
  for (const FeatureTerm& term : features) {
    CheckNonNegative(term.coefficient, ("features, " + term.name).c_str());
    own += term.coefficient;
  }
  if (isometric + strain + rigid + lambda + own == 0) {
    throw InvalidOptions({"isometric", "strain", "rigid", "lambda"},
                         "all zero, so motion costs nothing; set one");
  }
  CheckStiffness(stretching_stiffness, "stretching_stiffness");
  CheckStiffness(bending_stiffness, "bending_stiffness");
}

bool Metric::RigidInvariantButForPosition() const {
  const bool features_are = std::all_of(features.begin(), features.end(), [](const auto& feature) {
    return feature->IsRigidInvariant() || feature->template As<PositionFeature>() != nullptr;
  });
  return features_are && !rigid.Active() && options.discretization == Discretization::kMidpoint;
}

std::shared_ptr<const Metric> FreezeMetric(const MetricOptions& options,
                                           const std::shared_ptr<const Connectivity>& connectivity,
                                           const std::vector<Shape>& poses, double unit,
                                           PosePairs pairs) {
  options.Validate();
  MetricBasis basis = MakeMetricBasis(options, connectivity, poses, unit, pairs);
  const auto metric = std::make_shared<Metric>();
  metric->options = options;
  if (!Bends(*connectivity)) metric->options.bending = 0;

  std::vector<FeatureTerm> terms = {
      {EdgeLength::kName, options.isometric}, {TriangleStrain::kName, options.strain},
      {LogLength::kName, options.strain},     {PositionFeature::kName, options.lambda},
      {Dihedral::kName, options.bending},     {TurningAngle::kName, options.bending},
      {VolumeFeature::kName, options.volume}};
  terms.insert(terms.end(), options.features.begin(), options.features.end());
  for (const FeatureTerm& term : terms) {
    const internal::FeatureKind kind = internal::FindFeature(term.name);
    if (term.coefficient == 0) continue;
    auto feature = kind.freeze(basis, term.coefficient);
    internal::CheckFeature(*feature, connectivity->NumVertices());
    if (feature->NumElements() > 0) metric->features.push_back(std::move(feature));
  }
  if (options.rigid > 0) {
    metric->rigid.weights = options.rigid * basis.vertex_area;
    if (options.weights == Weighting::kUniform) metric->rigid.weights.setConstant(options.rigid);
    for (const int twin : connectivity->Twins()) {
      metric->rigid.weights(twin) = options.rigid * basis.vertex_area(twin);
    }
  }
  metric->connectivity = connectivity;
  metric->unit = basis.unit;
  metric->vertex_area = std::move(basis.vertex_area);
  metric->edge_area = std::move(basis.edge_area);
  metric->hinge_area = std::move(basis.hinge_area);
  return metric;
}

bool Bends(const Connectivity& connectivity) {
  return connectivity.NumHinges() > 0 || Turns(connectivity).cols() > 0;
}

std::string DescribeMetric(const MetricOptions& options) {
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
  for (const FeatureTerm& term : options.features) add(term.name.c_str(), term.coefficient);
  text << (options.weights == Weighting::kUniform ? ", uniform weights" : "")
       << (options.discretization == Discretization::kTrapezoid ? ", trapezoid" : "")
       << (options.stretching_stiffness.size() > 0 ? ", stretching stiffness by place" : "")
       << (options.bending_stiffness.size() > 0 ? ", bending stiffness by place" : "");
  return text.str();
}

}  // namespace shapespace
