#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/metric/define_feature.h>
#include <shapespace/metric/feature_map.h>
#include <shapespace/metric/metric.h>

#include "support/features.h"
#include "support/message_of.h"
#include "support/own_features.h"

namespace shapespace {
namespace {

using testing::MessageOf;
using testing::Names;

TEST(RegisterFeature, MakesFeaturesKnownByName) {
  const ShapeFamily bar = MakeBar(4, 1, 1, 4, 1, 1);
  MetricOptions options;
  options.features = {{"no such feature", 1}};
  EXPECT_TRUE(Names(
      MessageOf<InvalidOptions>([&] { FreezeMetric(options, bar.connectivity, {bar.pose(0)}); }),
      {"no such feature:"}));
  testing::RegisterOwnFeatures();
  testing::RegisterOwnFeatures();  // again is no error
  EXPECT_TRUE(IsRegistered("own strain"));
  options.features = {{"own strain", 3}};
  const auto metric = FreezeMetric(options, bar.connectivity, {bar.pose(0)});
  const auto& own = testing::Get<testing::OwnStrain>(*metric);
  options.strain = 1;
  const auto both = FreezeMetric(options, bar.connectivity, {bar.pose(0)});
  EXPECT_TRUE(own.weights.isApprox(3 * testing::Get<TriangleStrain>(*both).weights, 1e-14));
}

// Another type with the name of a feature of the library.
struct Impostor : EdgeLength {
  static Impostor Freeze(const MetricBasis&) { return {}; }
};

TEST(RegisterFeature, RefusesANameThatIsTaken) {
  EXPECT_THROW(RegisterFeature<Impostor>(), InvalidOptions);
}

struct Damaged : ElementFeature<2, 1> {
  static constexpr const char* kName = "damaged";
  template <typename T>
  void operator()(const T* x, T* value) const {
    value[0] = x[0] - x[3];
  }
};

TEST(FreezeMetric, RefusesFeaturesThatDoNotFitTheMesh) {
  const ShapeFamily bar = MakeBar(4, 1, 1, 4, 1, 1);
  MetricOptions options;
  options.features = {{"damaged", 1}};
  const auto freeze = [&](const std::function<void(Damaged*)>& damage) {
    RegisterFeature<Damaged>([damage](const MetricBasis& basis) {
      Damaged feature;
      feature.stencils = basis.connectivity->Edges();
      feature.weights = Eigen::VectorXd::Ones(feature.stencils.cols());
      damage(&feature);
      return feature;
    });
    FreezeMetric(options, bar.connectivity, {bar.pose(0)});
  };
  EXPECT_NO_THROW(freeze([](Damaged*) {}));
  for (const auto& damage : std::vector<std::function<void(Damaged*)>>{
           [](Damaged* f) { f->stencils(0, 1) = -1; },
           [&](Damaged* f) { f->stencils(1, 0) = bar.connectivity->NumVertices(); },
           [](Damaged* f) { f->weights(2) = -1; }, [](Damaged* f) { f->weights(2) = NAN; },
           [](Damaged* f) { f->weights.conservativeResize(3); }}) {
    EXPECT_NE(MessageOf<InvalidOptions>([&] { freeze(damage); }).find("feature damaged: "),
              std::string::npos);
  }
}

TEST(MetricOptions, RefuseCoefficientsThatAreNoneOrNegative) {
  testing::RegisterOwnFeatures();
  MetricOptions options;
  for (double coefficient : {-1.0, double{NAN}, double{INFINITY}}) {
    options.features = {{"own strain", coefficient}};
    EXPECT_THROW(options.Validate(), InvalidOptions);
  }
}

TEST(Metric, KnowsWhetherItsOwnFeaturesAreRigidInvariant) {
  testing::RegisterOwnFeatures();
  const ShapeFamily bar = MakeBar(4, 1, 1, 4, 1, 1);
  MetricOptions options;
  options.features = {{"own strain", 1}};
  EXPECT_TRUE(
      FreezeMetric(options, bar.connectivity, {bar.pose(0)})->RigidInvariantButForPosition());
  options.features = {{"height", 1}};
  EXPECT_FALSE(
      FreezeMetric(options, bar.connectivity, {bar.pose(0)})->RigidInvariantButForPosition());
}

// Functions whose second derivatives along a line are known in closed form, with every operation
// that features may use.
TEST(LineJet, DifferentiatesTwice) {
  using internal::LineJet;
  struct Case {
    const char* name;
    LineJet (*jet)(const LineJet&);
    double (*plain)(double);
  };
  const Case cases[] = {
      {"exp", [](const LineJet& x) { return exp(x); }, [](double x) { return std::exp(x); }},
      {"pow", [](const LineJet& x) { return pow(x, 2.5); },
       [](double x) { return std::pow(x, 2.5); }},
      {"sin", [](const LineJet& x) { return sin(x); }, [](double x) { return std::sin(x); }},
      {"cos", [](const LineJet& x) { return cos(x); }, [](double x) { return std::cos(x); }},
      {"tan", [](const LineJet& x) { return tan(x); }, [](double x) { return std::tan(x); }},
      {"asin", [](const LineJet& x) { return asin(x); }, [](double x) { return std::asin(x); }},
      {"acos", [](const LineJet& x) { return acos(x); }, [](double x) { return std::acos(x); }},
      {"atan", [](const LineJet& x) { return atan(x); }, [](double x) { return std::atan(x); }},
      {"tanh", [](const LineJet& x) { return tanh(x); }, [](double x) { return std::tanh(x); }},
      {"log", [](const LineJet& x) { return log(x); }, [](double x) { return std::log(x); }},
      {"sqrt", [](const LineJet& x) { return sqrt(x); }, [](double x) { return std::sqrt(x); }},
      {"abs", [](const LineJet& x) { return abs(-2.0 * x * x); },
       [](double x) { return 2 * x * x; }},
      {"atan2, flat", [](const LineJet& x) { return atan2(x * x, -1 - x); },
       [](double x) { return std::atan2(x * x, -1 - x); }},
      {"atan2, steep", [](const LineJet& x) { return atan2(-1 - x, x * x); },
       [](double x) { return std::atan2(-1 - x, x * x); }},
      {"quotient", [](const LineJet& x) { return (LineJet(1) /= x) -= (LineJet(2) *= x); },
       [](double x) { return 1 / x - 2 * x; }},
  };
  const double x = 0.4, h = 1e-3;
  for (const Case& test : cases) {
    SCOPED_TRACE(test.name);
    const LineJet y = test.jet({x, 1, 0});
    const double f = test.plain(x), more = test.plain(x + h), less = test.plain(x - h);
    EXPECT_DOUBLE_EQ(y.value, f);
    EXPECT_NEAR(y.first, (more - less) / (2 * h), 1e-4);
    EXPECT_NEAR(y.second, (more - 2 * f + less) / (h * h), 2e-4);
  }
}

}  // namespace
}  // namespace shapespace
