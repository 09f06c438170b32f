#include <shapespace/metric/line_jet.h>

#include <cmath>

#include <gtest/gtest.h>

namespace shapespace::internal {
namespace {

// Of functions of t at 0, with first and second derivatives.
const LineJet kA = {0.4, -1.3, 2.1}, kB = {-1.7, 0.6, -0.9};

void ExpectEqual(const LineJet& found, const LineJet& expected) {
  EXPECT_NEAR(found.value, expected.value, 1e-12);
  EXPECT_NEAR(found.first, expected.first, 1e-12);
  EXPECT_NEAR(found.second, expected.second, 1e-12);
}

TEST(LineJet, SumsProductsAndQuotientsFollowTheirRules) {
  ExpectEqual(-kA, {-0.4, 1.3, -2.1});
  ExpectEqual(kA + kB, {-1.3, -0.7, 1.2});
  ExpectEqual(kA - kB, {2.1, -1.9, 3});
  ExpectEqual(kA * kB, {-0.68, 2.21 + 0.24, -3.57 - 1.56 - 0.36});
  ExpectEqual(kA / kB * kB, kA);
  ExpectEqual(kB / kA * kA, kB);
  ExpectEqual(LineJet(3) * kA, {1.2, -3.9, 6.3});
  LineJet jet = kA;
  ExpectEqual(jet += kB, kA + kB);
  ExpectEqual(jet -= kA, kB);
  ExpectEqual(jet *= kA, kA * kB);
  ExpectEqual(jet /= kB, kA);
  ExpectEqual(jet, kA);
}

TEST(LineJet, IsComparedByItsValue) {
  const LineJet steep = {0.4, 7, -8}, more = {0.5, -2, 0};
  EXPECT_TRUE(kA == steep && kA <= steep && kA >= steep);
  EXPECT_FALSE(kA != steep || kA < steep || kA > steep || kA == more);
  EXPECT_TRUE(kA < more && kA <= more && kA != more && more > kA && more >= kA);
  EXPECT_FALSE(kA > more || kA >= more || more < kA || more <= kA);
}

// Of arguments that are functions of t themselves, with a slope and a curvature of their own.
TEST(LineJet, FunctionsOfFunctionsUndoEachOther) {
  ExpectEqual(sqrt(kA) * sqrt(kA), kA);
  ExpectEqual(exp(log(kA)), kA);
  ExpectEqual(log(exp(kB)), kB);
  ExpectEqual(pow(kA, 2.5) * pow(kA, 0.5), kA * kA * kA);
  ExpectEqual(pow(kA, -1), 1 / kA);
  ExpectEqual(sin(kA) * sin(kA) + cos(kA) * cos(kA), 1);
  ExpectEqual(sin(kA + kB), sin(kA) * cos(kB) + cos(kA) * sin(kB));
  ExpectEqual(cos(kA + kB), cos(kA) * cos(kB) - sin(kA) * sin(kB));
  ExpectEqual(tan(kB) * cos(kB), sin(kB));
  ExpectEqual(sin(asin(kA)), kA);
  ExpectEqual(cos(acos(kA)), kA);
  ExpectEqual(tan(atan(kB)), kB);
  ExpectEqual(tanh(kB) * (exp(2 * kB) + 1), exp(2 * kB) - 1);
  ExpectEqual(abs(kA), kA);
  ExpectEqual(abs(kB), -kB);
  ExpectEqual(abs(LineJet(0, 1, 2)), {0, 1, 2});
}

TEST(LineJet, TheAngleOfAPointTurnsWithIt) {
  for (const double turn : {-3.0, -2.0, -1.0, -0.5, 0.0, 0.3, M_PI / 2, 2.0, 2.8}) {
    const LineJet angle = {turn, -1.3, 2.1};
    ExpectEqual(atan2(exp(kB) * sin(angle), exp(kB) * cos(angle)), angle);
  }
}

}  // namespace
}  // namespace shapespace::internal
