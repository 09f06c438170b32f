#include <shapespace/metric/define_feature.h>

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/metric/edge_length.h>
#include <shapespace/metric/metric_basis.h>
#include <shapespace/metric/triangle_strain.h>

#include "support/message_of.h"

namespace shapespace {
namespace {

using testing::MessageOf;
using testing::Names;
using testing::Refuses;
using Numbers = std::vector<double>;

// x0 y1 and c y0^2 + z1, for vertices 0 and 1.
struct Products : ElementFeature<2, 2> {
  static constexpr bool kRigidInvariant = false;
  static constexpr const char* kName = "products";
  double c = 3;

  template <typename T>
  void operator()(const T* x, T* value) const {
    value[0] = x[0] * x[4];
    value[1] = c * x[1] * x[1] + x[5];
  }
  template <typename Self, typename Visit>
  static void ForConstants(Self* self, const Visit& visit) {
    visit("c", self->c);
  }
};

Products ThreeProducts() {
  Products products;
  products.stencils.resize(2, 3);
  products.stencils << 0, 4, 2, 3, 1, 5;
  products.weights = Eigen::Vector3d(0.5, 2, 7);
  return products;
}

const Numbers kTwoElements = {2, 3, 5, 7, 11, 13, -1, 4, 6, 8, 10, -9};

TEST(FeatureOf, DescribesItsStruct) {
  const auto feature = MakeFeature(ThreeProducts());
  EXPECT_EQ(feature->Name(), "products");
  EXPECT_EQ(feature->VerticesPerElement(), 2);
  EXPECT_EQ(feature->ValuesPerElement(), 2);
  EXPECT_EQ(feature->NumElements(), 3);
  EXPECT_EQ(feature->NumValues(), 6);
  EXPECT_EQ(feature->NumScalarRows(), 6);
  EXPECT_FALSE(feature->IsSum());
  EXPECT_FALSE(feature->IsRigidInvariant());
  EXPECT_EQ(feature->Element(1)[0], 4);
  EXPECT_EQ(feature->Element(1)[1], 1);
  EXPECT_EQ(feature->Weight(2), 7);
  EXPECT_EQ(feature->Weights(), Eigen::Vector3d(0.5, 2, 7));
  EXPECT_EQ(feature->Constants(), (std::vector<std::pair<std::string, double>>{{"c", 3}}));
  EXPECT_EQ(feature->As<Products>()->c, 3);
  EXPECT_EQ(feature->As<EdgeLength>(), nullptr);
}

TEST(FeatureOf, GathersTheVerticesOfARangeOfElements) {
  Shape shape(3, 6);
  for (int v = 0; v < 6; ++v) shape.col(v) << v, 10 + v, 20 + v;
  Numbers x(12);
  MakeFeature(ThreeProducts())->GatherCoordinates(1, 3, shape, x.data());
  EXPECT_EQ(x, (Numbers{4, 14, 24, 1, 11, 21, 2, 12, 22, 5, 15, 25}));
}

TEST(FeatureOf, DerivesEveryElementByCornerValueAndAxis) {
  const auto feature = MakeFeature(ThreeProducts());
  Numbers values(4), derivatives(24);
  feature->Evaluate(2, kTwoElements.data(), values.data());
  EXPECT_EQ(values, (Numbers{22, 40, -10, 39}));
  values.assign(4, 0);
  feature->Evaluate(2, kTwoElements.data(), values.data(), derivatives.data());
  EXPECT_EQ(values, (Numbers{22, 40, -10, 39}));
  EXPECT_EQ(derivatives, (Numbers{11, 0, 0, 0, 18, 0, 0, 2,  0, 0, 0, 1,  //
                                  10, 0, 0, 0, 24, 0, 0, -1, 0, 0, 0, 1}));
}

TEST(FeatureOf, DerivesEveryElementTwiceAlongItsOwnLine) {
  const Numbers along = {1, 2, 3, 4, 5, 6, -1, -3, 2, 0, 7, 1};
  Numbers second(4);
  MakeFeature(ThreeProducts())
      ->SecondDerivatives(2, kTwoElements.data(), along.data(), second.data());
  EXPECT_EQ(second, (Numbers{2 * 1 * 5, 2 * 3 * 4, 2 * -1 * 7, 2 * 3 * 9}));
}

TEST(FeatureOf, TheLeastChangeIsTheWeightedSumOfSquaresOverTheSegments) {
  const double a[] = {1, 2, 3, 4}, b[] = {3, 1, 3, 7}, weights[] = {0.5, 2};
  EXPECT_DOUBLE_EQ(MakeFeature(ThreeProducts())->LeastChange(2, a, b, weights, 4),
                   (0.5 * (4 + 1) + 2 * 9) / 4);
}

TEST(FeatureOf, ScalarRowsOfAFeatureWithoutOwnOnesAreThoseOfItsDerivatives) {
  Numbers rows(24);
  MakeFeature(ThreeProducts())->ScalarRows(2, kTwoElements.data(), rows.data());
  // For each element, value and axis: the derivative by the first vertex and by the second.
  const double expected[24] = {11, 0, 0, 2,  0, 0, 0, 0, 18, 0, 0, 1,
                               10, 0, 0, -1, 0, 0, 0, 0, 24, 0, 0, 1};
  for (int k = 0; k < 24; ++k) {
    EXPECT_NEAR(rows[k], std::sqrt(0.6) * expected[k], 1e-12) << k;
  }
}

// The tip of a cap is as stiff as its height says, although no side is short. A stretch by e along
// one direction has the values (e / 2, e / (2 sqrt 2), 0), up to their order and signs.
TEST(FeatureOf, ScalarRowsOfACapKnowItsHeight) {
  TriangleStrain strain;
  strain.stencils.setZero(3, 2);
  strain.weights.setOnes(2);
  const auto feature = MakeFeature(strain);
  for (const double height : {1e-2, 1e-3, 1e-4}) {
    const Numbers x = {0, 0, 7, 1, 0, 7, 0.5, height, 7, 1, 0, 0, 1};
    Numbers rows(3 * feature->NumScalarRows());
    feature->ScalarRows(1, x.data(), rows.data());
    double tip = 0;
    for (int row = 0; row < feature->NumScalarRows(); ++row) tip += std::pow(rows[3 * row + 2], 2);
    const double expected = 0.6 * (1.0 / 4 + 1.0 / 8) / (height * height);
    EXPECT_NEAR(tip / expected, 1, 100 * height);
  }
}

TEST(FeatureKind, FreezesWithTheCoefficientAndRestoresFromNumbers) {
  const internal::FeatureKind kind =
      internal::KindOf<Products>([](const MetricBasis&) { return ThreeProducts(); });
  EXPECT_EQ(kind.vertices, 2);
  EXPECT_FALSE(kind.is_sum);
  const auto frozen = kind.freeze(MetricBasis(), 10);
  EXPECT_EQ(frozen->Weights(), Eigen::Vector3d(5, 20, 70));
  Eigen::MatrixXi stencils(2, 2);
  stencils << 7, 8, 9, 6;
  std::vector<std::string> asked;
  const auto constant = [&](const std::string& name) -> double {
    asked.push_back(name);
    return -2;
  };
  const auto restored =
      kind.restore(stencils, Eigen::Vector2d(3, 4), Eigen::MatrixXd(0, 2), constant);
  EXPECT_EQ(asked, std::vector<std::string>{"c"});
  EXPECT_EQ(restored->As<Products>()->c, -2);
  EXPECT_EQ(restored->As<Products>()->stencils, stencils);
  EXPECT_EQ(restored->Weights(), Eigen::Vector2d(3, 4));
}

// The difference of two heights as a multiple of the element's first number, plus its second.
struct Incline : ElementFeature<2, 1, 2> {
  static constexpr const char* kName = "incline";
  template <typename T>
  void operator()(const T* x, T* value) const {
    value[0] = (x[5] - x[2]) * (x[5] - x[2]) / x[6] + x[7];
  }
};

TEST(FeatureOf, ElementsHaveNumbersOfTheirOwn) {
  Incline incline;
  incline.stencils.resize(2, 2);
  incline.stencils << 0, 1, 1, 2;
  incline.weights.setOnes(2);
  incline.numbers.resize(2, 2);
  incline.numbers << 2, 4, 10, 20;
  Shape shape = Shape::Zero(3, 3);
  shape.row(2) << 0, 6, 10;
  const auto feature = MakeFeature(incline);
  ASSERT_EQ(feature->InputsPerElement(), 8);
  Numbers x(16), values(2), slopes(12), seconds(2);
  feature->GatherCoordinates(0, 2, shape, x.data());
  feature->Evaluate(2, x.data(), values.data(), slopes.data());
  EXPECT_EQ(values, (Numbers{6.0 * 6 / 2 + 10, 4.0 * 4 / 4 + 20}));
  EXPECT_EQ(slopes, (Numbers{0, 0, -6, 0, 0, 6, 0, 0, -2, 0, 0, 2}));
  Numbers along(16, 1);  // numbers do not change along the line
  along[2] = along[10] = 0;
  feature->SecondDerivatives(2, x.data(), along.data(), seconds.data());
  EXPECT_EQ(seconds, (Numbers{1, 0.5}));
  EXPECT_NO_THROW(internal::CheckFeature(*feature, 3));
  incline.numbers(1, 1) = NAN;
  EXPECT_THROW(internal::CheckFeature(*MakeFeature(incline), 3), InvalidOptions);
  incline.numbers.setOnes(2, 1);
  EXPECT_THROW(internal::CheckFeature(*MakeFeature(incline), 3), InvalidOptions);
  incline.numbers.setOnes(2, 2);
  const internal::FeatureKind kind =
      internal::KindOf<Incline>([](const MetricBasis&) { return Incline(); });
  const auto restored = kind.restore(incline.stencils, incline.weights, incline.numbers,
                                     [](const std::string&) { return 0.0; });
  EXPECT_EQ(restored->As<Incline>()->numbers, incline.numbers);
}

struct SumOfHeights : ElementFeature<1, 1> {
  static constexpr bool kSum = true;
  static constexpr const char* kName = "sum of heights";
  template <typename T>
  void operator()(const T* x, T* value) const {
    value[0] = x[2];
  }
};

TEST(FeatureOf, ASumHasOneValueAndOneWeight) {
  SumOfHeights sum;
  sum.stencils.setLinSpaced(4, 0, 3);
  sum.weights = Eigen::VectorXd::Constant(1, 2.5);
  const auto feature = MakeFeature(sum);
  EXPECT_TRUE(feature->IsSum());
  EXPECT_TRUE(feature->IsRigidInvariant());
  EXPECT_EQ(feature->NumElements(), 4);
  EXPECT_EQ(feature->NumValues(), 1);
  EXPECT_EQ(feature->Weight(3), 2.5);
  EXPECT_TRUE(internal::KindOf<SumOfHeights>([&](const MetricBasis&) { return sum; }).is_sum);
  internal::CheckFeature(*feature, 4);
  sum.weights.setOnes(4);
  EXPECT_TRUE(Refuses<InvalidOptions>([&] { internal::CheckFeature(*MakeFeature(sum), 4); },
                                      {"feature sum of heights:", "4", "1"}));
}

TEST(CheckFeature, MessagesNameElementVertexAndWeight) {
  const auto message = [](const std::function<void(Products*)>& damage) {
    Products products = ThreeProducts();
    damage(&products);
    return MessageOf<InvalidOptions>(
        [&] { internal::CheckFeature(*MakeFeature(std::move(products)), 6); });
  };
  EXPECT_EQ(message([](Products*) {}), "nothing was thrown");
  EXPECT_EQ(message([](Products* p) { p->weights(1) = 0; }), "nothing was thrown");
  EXPECT_TRUE(Names(message([](Products* p) { p->stencils(1, 2) = 6; }),
                    {"feature products:", "element 2", "vertex 6"}));
  EXPECT_TRUE(Names(message([](Products* p) { p->stencils(0, 1) = -1; }),
                    {"feature products:", "element 1", "vertex -1"}));
  EXPECT_TRUE(
      Names(message([](Products* p) { p->weights.setOnes(2); }), {"feature products:", "2", "3"}));
  EXPECT_TRUE(
      Names(message([](Products* p) { p->weights.setOnes(4); }), {"feature products:", "4", "3"}));
  for (const double wrong : {-1e-9, double{NAN}, std::numeric_limits<double>::infinity()}) {
    EXPECT_TRUE(Names(message([&](Products* p) { p->weights(2) = wrong; }),
                      {"feature products:", "weight 2"}));
  }
}

// Another type with the name of a feature of the library.
struct OtherStrain : Products {
  static constexpr const char* kName = TriangleStrain::kName;
};

TEST(RegisterFeature, SaysWhichNameIsTakenOrUnknownAndWhatToDo) {
  EXPECT_TRUE(Refuses<InvalidOptions>(
      [] { RegisterFeature<OtherStrain>([](const MetricBasis&) { return OtherStrain(); }); },
      {"feature triangle strain:", "kName"}));
  EXPECT_FALSE(IsRegistered("nothing of the kind"));
  EXPECT_TRUE(Refuses<InvalidOptions>(
      [] { internal::FindFeature("nothing of the kind"); },
      {"feature nothing of the kind:", "define_feature.h", "define_feature"}));
  for (const char* known :
       {"edge length", "log length", "triangle strain", "position", "dihedral", "volume"}) {
    EXPECT_TRUE(IsRegistered(known)) << known;
  }
}

}  // namespace
}  // namespace shapespace
