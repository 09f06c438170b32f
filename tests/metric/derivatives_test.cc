#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <shapespace/metric/define_feature.h>
#include <shapespace/metric/dihedral.h>
#include <shapespace/metric/triangle_strain.h>

namespace shapespace {
namespace {

// Values and derivatives by hand and by Jets agree to rounding, that of derivatives relative to the
// largest of an element.
template <typename Struct>
void ExpectThoseOfJets(const Struct& feature, const double* x, double tolerance,
                       double tolerance_of_values = 1e-14) {
  constexpr int kCount = 3 * Struct::kVertices * Struct::kValues;
  double value[Struct::kValues], expected_value[Struct::kValues];
  Eigen::Matrix<double, kCount, 1> own, expected;
  feature.Derivatives(x, value, own.data());
  internal::DeriveAutomatically(feature, x, expected_value, expected.data());
  for (int k = 0; k < Struct::kValues; ++k) {
    EXPECT_NEAR(value[k], expected_value[k], tolerance_of_values);
  }
  EXPECT_TRUE(own.allFinite());
  EXPECT_LE((own - expected).cwiseAbs().maxCoeff(), tolerance * expected.cwiseAbs().maxCoeff());
}

template <typename Struct>
Eigen::VectorXd RandomElement(std::mt19937* random) {
  std::normal_distribution<double> normal;
  return Eigen::VectorXd::NullaryExpr(Struct::kInputs, [&] { return normal(*random); });
}

TEST(TriangleStrainDerivatives, AreThoseOfJets) {
  std::mt19937 random(1);
  TriangleStrain feature;
  for (const double epsilon : {0.0, 1e-16, 1e-2}) {
    feature.epsilon_squared = epsilon;
    for (int i = 0; i < 200; ++i) {
      ExpectThoseOfJets(feature, RandomElement<TriangleStrain>(&random).data(), 1e-11);
    }
  }
}

// On both sides of the ratio at which the logarithm is replaced by its series.
TEST(TriangleStrainDerivatives, AreThoseOfJetsWhereTrianglesAreNearlyEquilateral) {
  std::mt19937 random(2);
  TriangleStrain feature;
  feature.epsilon_squared = 1e-16;
  for (const double size : {0.0, 1e-6, 1e-3, 1e-2, 2e-2, 5e-2}) {
    for (int i = 0; i < 50; ++i) {
      Eigen::VectorXd x = size * RandomElement<TriangleStrain>(&random);
      x.tail<4>() = TriangleStrain::UsualNumbers();
      x(3) += 1;
      x(6) += 0.5;
      x(7) += std::sqrt(0.75);
      ExpectThoseOfJets(feature, x.data(), 1e-10);
    }
  }
}

// The area of a sliver is a difference of products of which its height's share remains. Where the
// compiler fuses products and sums, as on ARM, it rounds in one way in the one and otherwise in the
// other.
TEST(TriangleStrainDerivatives, AreThoseOfJetsForSlivers) {
  TriangleStrain feature;
  feature.epsilon_squared = 1e-16;
  for (const double height : {1e-2, 1e-4, 1e-6}) {
    const double x[] = {0, 0, 0, 1, .2, .1, .4, .08 + height, .04, 1, 0, 0, 1};
    ExpectThoseOfJets(feature, x, 1e-8, 1e-16 / height);
  }
}

TEST(DihedralDerivatives, AreThoseOfJets) {
  std::mt19937 random(3);
  Dihedral feature;
  for (const double epsilon : {0.0, 1e-16, 1e-2}) {
    feature.normal_epsilon_squared = feature.edge_epsilon_squared = epsilon;
    for (int i = 0; i < 200; ++i) {
      ExpectThoseOfJets(feature, RandomElement<Dihedral>(&random).data(), 1e-12);
    }
  }
}

TEST(DihedralDerivatives, AreThoseOfJetsWhereTrianglesHaveCollapsed) {
  Dihedral feature;
  feature.normal_epsilon_squared = feature.edge_epsilon_squared = 1e-16;
  const double flat[12] = {0, 0, 0, 1, 0, 0, .5, 0, 0, .5, -1, 0};
  ExpectThoseOfJets(feature, flat, 1e-12);
  const double point[12] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 2, 1};
  ExpectThoseOfJets(feature, point, 1e-12);
}

}  // namespace
}  // namespace shapespace
