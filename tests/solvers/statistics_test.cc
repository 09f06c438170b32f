// Regressions, comparisons of groups, files and tables of modes that were made by hand, for which
// everything can be worked out.

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include <shapespace/base/error.h>
#include <shapespace/statistics/modes_file.h>
#include <shapespace/statistics/pose_table.h>
#include <shapespace/statistics/regression.h>

#include "mesh/files.h"
#include "support/message_of.h"
#include "support/motions.h"

namespace shapespace {
namespace {

using testing::MessageOf;
using testing::Names;
using testing::Refuses;

// Modes of a triangle with these coordinates of its poses, whose weights are as 1, 2, 3, ...
PoseModes TriangleModes(const Eigen::MatrixXd& coordinates, const Eigen::VectorXd& variances,
                        double total) {
  PoseModes modes;
  Shape triangle(3, 3);
  triangle << 0, 3, 1, 0, 0, 2, 0, 0, 0;
  modes.metric =
      FreezeMetric({}, Connectivity::FromTriangles(3, Eigen::Vector3i(0, 1, 2)), {triangle});
  const auto count = static_cast<int>(coordinates.rows());
  modes.weights = Eigen::VectorXd::LinSpaced(count, 1, count);
  modes.weights /= modes.weights.sum();
  for (int i = 0; i < count; ++i) {
    modes.poses.push_back((1 + 0.125 * i) * triangle);
    modes.motions.push_back({testing::Rotation(20 * i, {1, 2, 3}), Eigen::Vector3d(i, 2 * i, 7)});
    modes.names.push_back("pose " + std::to_string(i + 1));
  }
  modes.mean = 1.0625 * triangle;
  modes.place = {testing::Rotation(50, {3, 1, 2}), Eigen::Vector3d(4, 5, 6)};
  modes.variances = variances;
  modes.total_variance = total;
  modes.coefficients = modes.weights.asDiagonal() * coordinates;
  for (int k = 0; k < coordinates.cols(); ++k) {
    modes.modes.push_back(Tangent::Constant(3, 3, 0.5 + k));
  }
  return modes;
}

Eigen::MatrixXd SixRows() {
  Eigen::MatrixXd rows(6, 3);
  rows << 0.3, -1.2, 0.8,  //
      1.7, 0.4, -0.6,      //
      -0.9, 0.9, 1.4,      //
      0.2, -0.7, -1.1,     //
      -1.4, 1.5, 0.1,      //
      0.6, -0.3, -0.5;
  return rows;
}

PoseModes SixPoses() { return TriangleModes(SixRows(), Eigen::Vector3d(0.5, 0.25, 0.125), 1); }

TEST(PoseModes, SharesAndCoordinatesAreThoseOfTheNumbers) {
  const PoseModes modes = SixPoses();
  EXPECT_TRUE(modes.Coordinates().isApprox(SixRows(), 1e-14));
  EXPECT_EQ(modes.Share(0), 0);
  EXPECT_EQ(modes.Share(1), 0.5);
  EXPECT_EQ(modes.Share(3), 0.875);
  PoseModes none = modes;
  none.total_variance = 0;
  EXPECT_EQ(none.Share(0), 1);
  const PoseModes two = FirstModes(modes, 2);
  EXPECT_EQ(two.NumModes(), 2);
  EXPECT_EQ(two.variances, Eigen::Vector2d(0.5, 0.25));
  EXPECT_EQ(two.coefficients, modes.coefficients.leftCols(2));
  EXPECT_EQ(two.total_variance, 1);
  EXPECT_EQ(FirstModes(modes, 0).NumModes(), 0);
  EXPECT_TRUE(Refuses<InvalidOptions>([&] { FirstModes(modes, -1); }, {"modes:", "0", "3"}));
  EXPECT_TRUE(Refuses<InvalidOptions>([&] { FirstModes(modes, 4); }, {"modes:", "0", "3"}));
}

TEST(PoseModes, WhatDoesNotFitTogetherIsSaid) {
  const auto message = [](void (*change)(PoseModes*)) {
    PoseModes modes = SixPoses();
    change(&modes);
    return MessageOf<MeshError>([&] { modes.Validate(); });
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message([](PoseModes*) {}), "nothing was thrown");
  EXPECT_TRUE(Names(message([](PoseModes* m) { m->poses.clear(); }), {"the modes:", "pose"}));
  EXPECT_TRUE(Names(message([](PoseModes* m) { m->names.pop_back(); }), {"the modes:", "weights"}));
  EXPECT_TRUE(
      Names(message([](PoseModes* m) { m->motions.pop_back(); }), {"the modes:", "weights"}));
  EXPECT_TRUE(Names(message([](PoseModes* m) { m->weights = Eigen::VectorXd::Constant(5, 0.2); }),
                    {"the modes:", "weights"}));
  EXPECT_TRUE(Names(message([](PoseModes* m) { m->coefficients.conservativeResize(5, 3); }),
                    {"the modes:", "weights"}));
  EXPECT_TRUE(Names(message([](PoseModes* m) { m->variances.conservativeResize(2); }),
                    {"the modes:", "variances"}));
  EXPECT_TRUE(Names(message([](PoseModes* m) { m->coefficients.conservativeResize(6, 2); }),
                    {"the modes:", "variances"}));
  EXPECT_TRUE(
      Names(message([](PoseModes* m) { m->modes.pop_back(); }), {"the modes:", "variances"}));
  EXPECT_TRUE(Names(message([](PoseModes* m) { m->mean(0, 1) = kNan; }), {"the modes:", "mean"}));
  EXPECT_TRUE(Names(message([](PoseModes* m) { m->mean.conservativeResize(3, 2); }),
                    {"the modes:", "mean"}));
  EXPECT_TRUE(
      Names(message([](PoseModes* m) { m->poses[5](0, 1) = kNan; }), {"the modes:", "pose"}));
  EXPECT_TRUE(
      Names(message([](PoseModes* m) { m->modes[2](0, 1) = kNan; }), {"the modes:", "mode"}));
  const std::string place = "the modes: the place of a pose is not finite";
  EXPECT_EQ(message([](PoseModes* m) { m->motions[5].rotation(0, 1) = kNan; }), place);
  EXPECT_EQ(message([](PoseModes* m) { m->motions[5].translation(1) = kNan; }), place);
  EXPECT_TRUE(Names(message([](PoseModes* m) {
                      m->motions[5].rotation.setConstant(1e308);
                      m->poses[5].setConstant(1e10);
                    }),
                    {"the modes:", "pose"}));
  EXPECT_TRUE(Names(message([](PoseModes* m) {
                      m->place.rotation.setConstant(1e308);
                      m->mean.setConstant(1e10);
                    }),
                    {"the modes:", "mean"}));
  EXPECT_TRUE(
      Names(message([](PoseModes* m) { m->coefficients(5, 2) = kNan; }), {"the modes:", "number"}));
  const std::string weights = "the modes: the weights are not positive, or their sum is not 1";
  EXPECT_EQ(message([](PoseModes* m) { m->weights(0) *= 1.001; }), weights);
  EXPECT_EQ(message([](PoseModes* m) {
              m->weights(5) += m->weights(0);
              m->weights(0) = 0;
            }),
            weights);
  const std::string variance = "the modes: a variance is not positive, or they exceed the total";
  EXPECT_EQ(message([](PoseModes* m) { m->variances(2) = 0; }), variance);
  EXPECT_EQ(message([](PoseModes* m) { m->total_variance = 0.87; }), variance);
  EXPECT_EQ(
      message([](PoseModes* m) { m->total_variance = std::numeric_limits<double>::infinity(); }),
      variance);
  EXPECT_EQ(message([](PoseModes* m) { m->total_variance = 0.875; }), "nothing was thrown");
}

// Against the normal equations, with the weights as a matrix.
TEST(Regress, IsTheWeightedLeastSquaresFit) {
  const PoseModes modes = SixPoses();
  Eigen::MatrixXd values(6, 2);
  values << 10, 3, 12, -1, 17, 4, 11, 5, 19, -2, 14, 6;
  const Regression regression = Regress(modes, {"age", "weight"}, values);
  Eigen::MatrixXd design(6, 3);
  design << Eigen::VectorXd::Ones(6), values;
  const Eigen::MatrixXd weights = modes.weights.asDiagonal();
  const Eigen::MatrixXd beta =
      (design.transpose() * weights * design).inverse() * design.transpose() * weights * SixRows();
  EXPECT_TRUE(regression.intercept.isApprox(beta.row(0).transpose(), 1e-9));
  EXPECT_TRUE(regression.slopes.isApprox(beta.bottomRows(2).transpose(), 1e-9));
  EXPECT_EQ(regression.scalars, (std::vector<std::string>{"age", "weight"}));
  EXPECT_EQ(regression.least, Eigen::Vector2d(10, -2));
  EXPECT_EQ(regression.most, Eigen::Vector2d(19, 6));
  EXPECT_TRUE(regression.mean.isApprox(values.transpose() * modes.weights, 1e-14));
  double left = 0, all = 0;
  const Eigen::MatrixXd residuals = SixRows() - design * beta;
  const Eigen::MatrixXd centred =
      SixRows().rowwise() - Eigen::RowVectorXd(modes.weights.transpose() * SixRows());
  for (int k = 0; k < 3; ++k) {
    left += modes.variances(k) * residuals.col(k).cwiseAbs2().dot(modes.weights);
    all += modes.variances(k) * centred.col(k).cwiseAbs2().dot(modes.weights);
  }
  EXPECT_NEAR(regression.r_squared, 1 - left / all, 1e-9);
  EXPECT_TRUE(regression.CoordinatesAt(values.row(3).transpose())
                  .isApprox((design.row(3) * beta).transpose(), 1e-9));
}

// Of scalars that have nothing to do with the poses, a twentieth seem to at 5 %, also if weights
// are very unlike, and if they go with a scalar.
TEST(Regress, WeightsMakeNoScalarSignificant) {
  constexpr int kTrials = 300, kPoses = 12;
  std::mt19937_64 random(5);
  const auto normal = [&] {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += static_cast<double>(random() >> 11) * 0x1p-53;
    return sum;
  };
  PermutationOptions options;
  options.permutations = 99;
  for (const bool with_scalar : {false, true}) {
    int together = 0, alone = 0;
    for (int t = 0; t < kTrials; ++t) {
      const Eigen::MatrixXd rows = Eigen::MatrixXd::NullaryExpr(kPoses, 3, normal);
      const Eigen::MatrixXd scalars = Eigen::MatrixXd::NullaryExpr(kPoses, 2, normal);
      PoseModes modes = TriangleModes(rows, Eigen::Vector3d(1, 0.5, 0.25), 1.75);
      for (int i = 0; i < kPoses; ++i) {
        modes.weights(i) = std::exp(1.5 * (with_scalar ? scalars(i, 0) : normal()));
      }
      modes.weights /= modes.weights.sum();
      modes.coefficients = modes.weights.asDiagonal() * rows;
      const Regression regression = Regress(modes, {"a", "b"}, scalars, options);
      together += regression.p_value <= 0.05;
      alone += regression.p_values[0] <= 0.05;
    }
    EXPECT_LT(together, 0.09 * kTrials) << with_scalar;
    EXPECT_LT(alone, 0.12 * kTrials) << with_scalar;
  }
}

TEST(Regress, AModelWithoutModesHasNothingToExplain) {
  EXPECT_EQ(MessageOf<InvalidOptions>([] {
              Regress(FirstModes(SixPoses(), 0), {"a"}, SixRows().leftCols(1));
            }).find("modes: "),
            0u);
}

TEST(Regress, OneChanceValueIsTheLeastProbability) {
  // The first coordinate is the scalar, and of all orders but its own none explains as much.
  Eigen::MatrixXd coordinates(6, 1);
  coordinates << 1, 2.3, 3.1, 4.7, 5.2, 9;
  const PoseModes modes = TriangleModes(coordinates, Eigen::VectorXd::Ones(1), 1);
  PermutationOptions options;
  options.permutations = 3;
  const Regression regression = Regress(modes, {"own"}, 2 * coordinates, options);
  EXPECT_NEAR(regression.r_squared, 1, 1e-12);
  EXPECT_EQ(regression.p_value, 0.25);
  ASSERT_EQ(regression.p_values.size(), 1u);
  EXPECT_EQ(regression.p_values[0], 0.25);
  options.permutations = 0;
  EXPECT_TRUE(Refuses<InvalidOptions>([&] { options.Validate(); }, {"permutations:", "1"}));
  options.permutations = 1;
  EXPECT_NO_THROW(options.Validate());
}

TEST(Regress, RefusalsNameTheScalarAndTheRemedy) {
  const PoseModes modes = SixPoses();
  const auto message = [&](const std::vector<std::string>& names, const Eigen::MatrixXd& values) {
    return MessageOf<InvalidOptions>([&] { Regress(modes, names, values); });
  };
  const std::string number = "scalars: must be one or more, with a value for each of the 6 poses";
  const Eigen::MatrixXd random = SixRows();
  EXPECT_EQ(message({"a"}, random.topLeftCorner(5, 1)), number);
  EXPECT_EQ(message({"a"}, random.leftCols(2)), number);
  EXPECT_EQ(message({}, random.leftCols(0)), number);
  Eigen::MatrixXd values = random.leftCols(1);
  values(5, 0) = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(Names(message({"a"}, values), {"scalars:"}));
  Eigen::MatrixXd five(6, 5), four(6, 4);
  five << random, random.leftCols(2).cwiseAbs2();
  four << random, random.col(0).cwiseAbs2();
  EXPECT_TRUE(Names(message({"a", "b", "c", "d", "e"}, five), {"scalars:", "6"}));
  EXPECT_EQ(message({"a", "b", "c", "d"}, four), "nothing was thrown");
  values = random.leftCols(2);
  values.col(1).setConstant(3);
  EXPECT_TRUE(Names(message({"a", "b"}, values), {"scalars:", "b"}));
  const Regression regression = Regress(modes, {"a", "b"}, random.leftCols(2));
  EXPECT_TRUE(Refuses<InvalidOptions>([&] { regression.CoordinatesAt(Eigen::Vector3d(1, 2, 3)); },
                                      {"values:", "2"}));
  EXPECT_TRUE(Refuses<InvalidOptions>(
      [&] {
        regression.CoordinatesAt(Eigen::Vector2d(1, std::numeric_limits<double>::infinity()));
      },
      {"values:", "2"}));
}

// Three groups of two, three and four poses, of different weights; the labels are mixed.
TEST(CompareGroups, IsHotellingsTSquaredOfEveryPair) {
  Eigen::MatrixXd rows(9, 3);
  rows << SixRows(), 2 * SixRows().topRows(3).array() + 0.25;
  const PoseModes modes = TriangleModes(rows, Eigen::Vector3d(0.5, 0.25, 0.125), 1);
  const std::vector<std::string> labels = {"c", "a", "b", "c", "b", "c", "a", "b", "c"};
  GroupOptions options;
  options.modes = 1;
  options.permutation.permutations = 99;
  const std::vector<GroupDifference> one = CompareGroups(modes, labels, options);
  ASSERT_EQ(one.size(), 3u);
  options.modes = 2;
  const std::vector<GroupDifference> two = CompareGroups(modes, labels, options);
  const std::pair<const char*, const char*> pairs[] = {{"a", "b"}, {"a", "c"}, {"b", "c"}};
  for (int p = 0; p < 3; ++p) {
    const auto& [first, second] = pairs[p];
    const auto of = [&](const std::string& label) {
      std::vector<int> members;
      for (int i = 0; i < 9; ++i) {
        if (labels[i] == label) members.push_back(i);
      }
      return members;
    };
    const std::vector<int> members_a = of(first), members_b = of(second);
    const Eigen::MatrixXd a = rows(members_a, Eigen::seq(0, 1));
    const Eigen::MatrixXd b = rows(members_b, Eigen::seq(0, 1));
    // Weights of mean 1.
    Eigen::VectorXd of_a = modes.weights(members_a), of_b = modes.weights(members_b);
    const double count = static_cast<double>(a.rows() + b.rows());
    const double scale = count / (of_a.sum() + of_b.sum());
    of_a *= scale;
    of_b *= scale;
    const auto mean = [](const Eigen::MatrixXd& x, const Eigen::VectorXd& w) -> Eigen::Vector2d {
      return x.transpose() * w / w.sum();
    };
    const auto scatter = [&](const Eigen::MatrixXd& x,
                             const Eigen::VectorXd& w) -> Eigen::Matrix2d {
      return x.transpose() * w.asDiagonal() * x - w.sum() * mean(x, w) * mean(x, w).transpose();
    };
    const Eigen::Vector2d way = mean(b, of_b) - mean(a, of_a);
    const Eigen::Matrix2d pooled = (scatter(a, of_a) + scatter(b, of_b)) / (count - 2);
    const double factor = of_a.sum() * of_b.sum() / count;
    EXPECT_EQ(one[p].first, first);
    EXPECT_EQ(one[p].second, second);
    EXPECT_EQ(one[p].first_count, a.rows());
    EXPECT_EQ(one[p].second_count, b.rows());
    EXPECT_EQ(one[p].modes, 1);
    EXPECT_EQ(two[p].modes, 2);
    EXPECT_NEAR(one[p].t_squared, factor * way(0) * way(0) / pooled(0, 0), 1e-9);
    EXPECT_NEAR(two[p].t_squared, factor * way.dot(pooled.inverse() * way),
                1e-9 * two[p].t_squared);
    EXPECT_NEAR(one[p].distance, std::sqrt(0.5) * std::abs(way(0)), 1e-12);
    EXPECT_NEAR(two[p].distance, std::sqrt(0.5 * way(0) * way(0) + 0.25 * way(1) * way(1)), 1e-12);
    // As many ways as there are to choose two of five, two of six and three of seven.
    const double least = 1 / std::vector<double>{10, 15, 35}[p];
    for (const double probability : {two[p].t_squared_p, two[p].distance_p}) {
      // Of a hundred, counted with the true one.
      if (probability > least) {
        EXPECT_NEAR(100 * probability, std::round(100 * probability), 1e-9);
      }
      EXPECT_GE(probability, least);
      EXPECT_LE(probability, 1);
    }
  }
}

PoseModes EvenlyWeighted(const Eigen::MatrixXd& coordinates, const Eigen::VectorXd& variances) {
  PoseModes modes = TriangleModes(coordinates, variances, variances.sum());
  modes.weights.setConstant(1.0 / static_cast<double>(coordinates.rows()));
  modes.coefficients = modes.weights.asDiagonal() * coordinates;
  return modes;
}

// A mode that separates the groups and does not vary within them: the covariance within is
// singular, and groups that are apart must not count as alike.
TEST(CompareGroups, GroupsThatAreWhollyApartAreAsFarAsCanBe) {
  const std::vector<std::string> labels = {"a", "a", "a", "a", "b", "b", "b", "b"};
  GroupOptions options;
  options.modes = 2;
  for (const double noise : {0.0, 1e-16, 1e-7, 1e-3}) {
    Eigen::MatrixXd rows(8, 2);
    for (int i = 0; i < 8; ++i) {
      rows(i, 0) = std::sin(1 + 2.3 * i * i);
      rows(i, 1) = (i < 4 ? -1 : 1) + noise * std::cos(3 + 1.9 * i * i);
    }
    const GroupDifference difference =
        CompareGroups(EvenlyWeighted(rows, Eigen::Vector2d(1, 0.5)), labels, options)[0];
    EXPECT_NEAR(difference.t_squared_p, 2 / 70.0, 0.006) << noise;
    EXPECT_GE(difference.t_squared_p, 2 / 70.0) << noise;
    EXPECT_EQ(std::isinf(difference.t_squared), noise < 1e-6) << noise;
    EXPECT_GT(difference.t_squared, 1e4) << noise;
  }
  // Copies of one pose against copies of another, in numbers that are not alike.
  for (const int first : {2, 3, 4}) {
    Eigen::MatrixXd copies(8, 1);
    std::vector<std::string> of_copies;
    for (int i = 0; i < 8; ++i) {
      copies(i, 0) = (i < first ? 0.7 : 0.1) / 3;
      of_copies.push_back(i < first ? "a" : "b");
    }
    options.modes = 1;
    const GroupDifference difference =
        CompareGroups(EvenlyWeighted(copies, Eigen::VectorXd::Ones(1)), of_copies, options)[0];
    const double ways = first == 2 ? 28 : first == 3 ? 56 : 35;
    EXPECT_GE(difference.t_squared_p, 1 / ways);
    EXPECT_NEAR(difference.t_squared_p, 1 / ways, 0.006);
    EXPECT_EQ(difference.t_squared_p, difference.distance_p);
    EXPECT_TRUE(std::isinf(difference.t_squared));
  }
  // One pose alone: nothing differs, and every order is as good.
  const GroupDifference none =
      CompareGroups(EvenlyWeighted(Eigen::MatrixXd::Constant(8, 1, 0.3), Eigen::VectorXd::Ones(1)),
                    labels, options)[0];
  EXPECT_EQ(none.t_squared_p, 1);
  EXPECT_EQ(none.t_squared, 0);
}

// Chance values are few, and could all miss the groups that are given.
TEST(CompareGroups, NoProbabilityIsLessThanThatOfAllWaysToChoose) {
  Eigen::MatrixXd rows(5, 1);
  rows << 0, 0.1, 5, 5.1, 5.2;
  GroupOptions options;
  options.permutation.permutations = 20;
  double least = 1;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    options.permutation.seed = seed;
    const GroupDifference difference = CompareGroups(EvenlyWeighted(rows, Eigen::VectorXd::Ones(1)),
                                                     {"a", "a", "b", "b", "b"}, options)[0];
    least = std::min({least, difference.t_squared_p, difference.distance_p});
  }
  EXPECT_EQ(least, 0.1);
}

// Of two groups without any difference a twentieth are found to differ at 5 %, also if weights are
// very unlike.
TEST(CompareGroups, WeightsMakeNoDifference) {
  constexpr int kTrials = 300, kPoses = 12;
  std::mt19937_64 random(3);
  const auto normal = [&] {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += static_cast<double>(random() >> 11) * 0x1p-53;
    return sum;
  };
  GroupOptions options;
  options.modes = 2;
  options.permutation.permutations = 99;
  std::vector<std::string> labels(kPoses, "a");
  std::fill(labels.begin() + 5, labels.end(), "b");
  int found = 0, distant = 0;
  for (int t = 0; t < kTrials; ++t) {
    const Eigen::MatrixXd rows = Eigen::MatrixXd::NullaryExpr(kPoses, 2, normal);
    PoseModes modes = EvenlyWeighted(rows, Eigen::Vector2d(1, 0.5));
    for (double& weight : modes.weights) weight = std::exp(1.5 * normal());
    modes.weights /= modes.weights.sum();
    modes.coefficients = modes.weights.asDiagonal() * rows;
    const GroupDifference difference = CompareGroups(modes, labels, options)[0];
    found += difference.t_squared_p <= 0.05;
    distant += difference.distance_p <= 0.05;
  }
  EXPECT_LT(found, 0.09 * kTrials);
  EXPECT_LT(distant, 0.09 * kTrials);
}

TEST(CompareGroups, TakesTheModesWithMostOfTheVarianceButNotTooMany) {
  Eigen::MatrixXd rows(12, 4);
  for (int i = 0; i < rows.size(); ++i) rows.data()[i] = std::sin(1 + 1.7 * i * i);
  const PoseModes modes = TriangleModes(rows, Eigen::Vector4d(0.6, 0.3, 0.07, 0.02), 1);
  GroupOptions options;
  options.permutation.permutations = 9;
  const auto chosen = [&](const PoseModes& of, std::vector<std::string> labels) {
    labels.resize(12, "c");
    return CompareGroups(of, labels, options)[0].modes;
  };
  const std::vector<std::string> four = {"a", "a", "b", "b"};
  const std::vector<std::string> six = {"a", "a", "b", "b", "a", "b"};
  const std::vector<std::string> ten = {"a", "a", "b", "b", "a", "b", "a", "b", "a", "b"};
  EXPECT_EQ(chosen(modes, four), 1);
  EXPECT_EQ(chosen(modes, six), 2);
  EXPECT_EQ(chosen(modes, ten), 3);  // a share of 0.97
  EXPECT_EQ(chosen(FirstModes(modes, 2), ten), 2);
}

TEST(CompareGroups, RefusalsNameTheGroup) {
  const PoseModes modes = SixPoses();
  const auto message = [&](const std::vector<std::string>& labels, int count = 0) {
    GroupOptions options;
    options.modes = count;
    return MessageOf<InvalidOptions>([&] { CompareGroups(modes, labels, options); });
  };
  EXPECT_TRUE(Names(message({"a", "b"}), {"labels:", "6"}));
  EXPECT_TRUE(Names(message({"a", "a", "a", "a", "a", "a"}), {"labels:"}));
  EXPECT_TRUE(Names(message({"a", "a", "b", "a", "a", "a"}), {"labels:", "b"}));
  const std::vector<std::string> good = {"a", "a", "b", "b", "c", "c"};
  EXPECT_TRUE(Names(message(good, 3), {"modes:", "2"}));
  EXPECT_TRUE(Names(message({"a", "a", "b", "b", "b", "b"}, 4), {"modes:", "3"}));
  EXPECT_TRUE(Names(message(good, -1), {"modes:", "0"}));
  EXPECT_EQ(message(good, 2), "nothing was thrown");
  EXPECT_TRUE(
      Refuses<InvalidOptions>([&] { CompareGroups(FirstModes(modes, 0), good); }, {"modes:"}));
}

class StatisticsFileTest : public testing::FilesTest {};

TEST_F(StatisticsFileTest, ModesAreReadAsTheyWereWritten) {
  PoseModes modes = SixPoses();
  modes.appearance.vertex_colours = Eigen::MatrixXd::Constant(3, 3, 0.25);
  modes.total_variance = 1.5;
  WriteModes(Path("m.modes"), modes);
  const PoseModes read = ReadModes(Path("m.modes"));
  EXPECT_EQ(read.size, PoseSize::kKeep);
  EXPECT_EQ(read.weights, modes.weights);
  EXPECT_EQ(read.coefficients, modes.coefficients);
  EXPECT_EQ(read.variances, modes.variances);
  EXPECT_EQ(read.total_variance, 1.5);
  EXPECT_EQ(read.mean, modes.mean);
  EXPECT_EQ(read.place.rotation, modes.place.rotation);
  EXPECT_EQ(read.place.translation, modes.place.translation);
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(read.poses[i], modes.poses[i]);
    EXPECT_EQ(read.motions[i].rotation, modes.motions[i].rotation);
    EXPECT_EQ(read.motions[i].translation, modes.motions[i].translation);
    EXPECT_EQ(read.names[i], "pose " + std::to_string(i + 1));
  }
  for (int k = 0; k < 3; ++k) EXPECT_EQ(read.modes[k], modes.modes[k]);
  EXPECT_EQ(read.metric->unit, modes.metric->unit);
  EXPECT_EQ(DescribeMetric(read.metric->options), DescribeMetric(modes.metric->options));
  EXPECT_EQ(read.appearance.vertex_colours, modes.appearance.vertex_colours);
  modes.names.pop_back();
  EXPECT_TRUE(Refuses<MeshError>([&] { WriteModes(Path("m.modes"), modes); },
                                 {Path("m.modes"), "coefficients"}));
}

TEST_F(StatisticsFileTest, TablesAreWrittenWithQuotesWhereTheyAreNeeded) {
  Eigen::MatrixXd numbers(2, 3);
  numbers << 0.5, -2, 1e300, 0.1, 7, 0;
  WritePoseTable(Path("t.csv"), {"a b", "say \"a, b\""}, {"x", "y, z", "line\nend"}, numbers);
  EXPECT_EQ(testing::Content(Path("t.csv")),
            "pose,x,\"y, z\",\"line\nend\"\n"
            "a b,0.5,-2,1.0000000000000001e+300\n"
            "\"say \"\"a, b\"\"\",0.10000000000000001,7,0\n");
  const std::string message = "numbers: must have a row for each pose and a column for each name";
  EXPECT_EQ(MessageOf<InvalidOptions>([&] {
              WritePoseTable(Path("t.csv"), {"a"}, {"x", "y", "z"}, numbers);
            }),
            message);
  EXPECT_EQ(MessageOf<InvalidOptions>([&] {
              WritePoseTable(Path("t.csv"), {"a", "b"}, {"x", "y"}, numbers);
            }),
            message);
}

TEST_F(StatisticsFileTest, RowsOfATableBelongToTheirPoses) {
  const std::string file = File("t.csv",
                                "\nname,kind,age\n"
                                "in/cat.obj,feline,3\n"
                                " \n"
                                "dog,canine,\n"
                                "cow,,5\n"
                                "emu,bird,nan\n");
  const PoseTable table = ReadPoseTable(file);
  EXPECT_EQ(table.file, file);
  EXPECT_EQ(table.columns, (std::vector<std::string>{"kind", "age"}));
  EXPECT_EQ(table.poses, (std::vector<std::string>{"in/cat.obj", "dog", "cow", "emu"}));
  EXPECT_EQ(table.lines, (std::vector<int>{3, 5, 6, 7}));
  EXPECT_EQ(table.RowsOf({"cow", "cat", "dog.ply", "cow"}), (std::vector<int>{2, 0, 1, 2}));
  EXPECT_EQ(table.LabelsOf({"emu", "dog", "cat"}),
            (std::vector<std::string>{"bird", "canine", "feline"}));
  EXPECT_TRUE(Refuses<FileError>([&] { table.LabelsOf({"dog", "cow"}); }, {file + ":6:", "'cow'"}));
  EXPECT_TRUE(Refuses<FileError>([&] { table.RowsOf({"cat", "ape"}); }, {file, "'ape'"}));
  const std::string ages = "name,age,size\ncat,3,4\ndog,5,\nemu,nan,1\n";
  const PoseTable numbers = ReadPoseTable(File("n.csv", ages));
  EXPECT_TRUE(Refuses<FileError>(
      [&] {
        numbers.NumbersOf({"cat", "dog"});
      },
      {Path("n.csv") + ":3:", "'dog'", "''"}));
  EXPECT_TRUE(Refuses<FileError>([&] { numbers.NumbersOf({"emu"}); },
                                 {Path("n.csv") + ":4:", "'emu'", "'nan'"}));
  EXPECT_EQ(numbers.NumbersOf({"cat"}), Eigen::RowVector2d(3, 4));
  const auto message = [&](const std::string& text) {
    return MessageOf<FileError>([&] { ReadPoseTable(File("b.csv", text)); });
  };
  EXPECT_TRUE(Names(message("f,a\n\nsit.obj,1\nx,2\nin/sit.ply,3\n"),
                    {Path("b.csv") + ":5:", "'in/sit.ply'", "line 3"}));
  EXPECT_TRUE(Names(message("f,a,b\n\nsit,1\n"), {Path("b.csv") + ":3:", "2", "3"}));
  EXPECT_TRUE(Names(message("\nf\n"), {Path("b.csv") + ":2:"}));
}

}  // namespace
}  // namespace shapespace
