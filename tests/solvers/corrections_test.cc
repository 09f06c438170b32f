#include <shapespace/spline/detail/corrections.h>

#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace shapespace::internal {
namespace {

using Columns = Eigen::Matrix3Xd;

// Velocities of the chain at the ends of intervals, for which the corrections have to make up.
std::vector<Interval> ChainThrough(const std::vector<double>& times,
                                   const std::vector<Columns>& values) {
  std::vector<Interval> intervals;
  for (size_t i = 0; i + 1 < times.size(); ++i) {
    const double place = static_cast<double>(i);
    Interval interval;
    interval.length = times[i + 1] - times[i];
    interval.way = values[i + 1] - values[i];
    interval.first_velocity = 1.5 * interval.way.array() + 0.3 - place;
    interval.last_velocity = 0.25 * interval.way.array() - 0.7 + 2 * place;
    intervals.push_back(interval);
  }
  return intervals;
}

// The velocities of the corrected chain at both ends of an interval, per unit of time.
std::pair<Columns, Columns> VelocitiesOf(const Corrections& corrections,
                                         const std::vector<Interval>& intervals, int i) {
  // The cubic without values at the ends, through its values at a third and two thirds.
  const Columns c = corrections.At(i, 1. / 3), d = corrections.At(i, 2. / 3);
  const double length = intervals[i].length;
  return {(9 * c - 4.5 * d + intervals[i].first_velocity) / length,
          (4.5 * c - 9 * d + intervals[i].last_velocity) / length};
}

// The accelerations at both ends of the cubic through an interval with these velocities.
std::pair<Columns, Columns> AccelerationsOf(const Interval& interval, const Columns& first,
                                            const Columns& last) {
  const double h = interval.length;
  const Columns way = 6 * interval.way / (h * h);
  return {way - (4 * first + 2 * last) / h, (2 * first + 4 * last) / h - way};
}

Columns At(double t, double (*first)(double), double (*second)(double)) {
  Columns columns(3, 2);
  columns << first(t), second(t), 2 * first(t), -second(t), 1 - first(t), 3 + second(t);
  return columns;
}

double Cubic(double t) { return 2 - t + 3 * t * t - 0.5 * t * t * t; }
double CubicSlope(double t) { return -1 + 6 * t - 1.5 * t * t; }
double Parabola(double t) { return 1 + 4 * t - 0.7 * t * t; }
double ParabolaSlope(double t) { return 4 - 1.4 * t; }
Columns SlopeAt(double t, double (*first)(double), double (*second)(double)) {
  Columns columns = At(t, first, second);
  columns.row(2).array() -= Eigen::RowVector2d(1, 3).array();
  return columns;
}

void ExpectVelocities(const std::vector<double>& times, SplineEnds ends, double (*value)(double),
                      double (*slope)(double)) {
  std::vector<Columns> values;
  for (double t : times) values.push_back(At(t, value, Parabola));
  const std::vector<Interval> intervals = ChainThrough(times, values);
  const Corrections corrections(intervals, ends, 0, SlopeAt(times.front(), slope, ParabolaSlope),
                                SlopeAt(times.back(), slope, ParabolaSlope));
  for (int i = 0; i < static_cast<int>(intervals.size()); ++i) {
    const auto [first, last] = VelocitiesOf(corrections, intervals, i);
    EXPECT_LT((first - SlopeAt(times[i], slope, ParabolaSlope)).norm(), 1e-10) << i;
    EXPECT_LT((last - SlopeAt(times[i + 1], slope, ParabolaSlope)).norm(), 1e-10) << i;
    EXPECT_EQ(corrections.At(i, 0).norm(), 0);
    EXPECT_EQ(corrections.At(i, 1).norm(), 0);
  }
}

TEST(Corrections, MakeCubicsOfChainsThroughThem) {
  for (const std::vector<double>& times : {std::vector<double>{0, 2, 3, 7, 7.5}, {-1, 0.5, 1, 4}}) {
    ExpectVelocities(times, SplineEnds::kNotAKnot, Cubic, CubicSlope);
    ExpectVelocities(times, SplineEnds::kClamped, Cubic, CubicSlope);
  }
  ExpectVelocities({0, 2, 3}, SplineEnds::kNotAKnot, Parabola, ParabolaSlope);
  ExpectVelocities({0, 2, 3}, SplineEnds::kClamped, Cubic, CubicSlope);
  ExpectVelocities({1, 4}, SplineEnds::kClamped, Cubic, CubicSlope);
}

double Uneven(double t) { return std::sin(2 * t) + 0.3 * t; }
double Other(double t) { return std::cos(3 * t + 1); }

TEST(Corrections, HaveNoJumpOfAcceleration) {
  for (const std::vector<double>& times :
       {std::vector<double>{0, 1.5}, {0, 1, 3}, {0, 2, 2.5, 4}, {0, 1, 1.25, 3, 3.5, 5.5}}) {
    const int count = static_cast<int>(times.size()) - 1;
    for (const SplineEnds ends : {SplineEnds::kNatural, SplineEnds::kPeriodic}) {
      if (ends == SplineEnds::kPeriodic && count == 1) continue;
      SCOPED_TRACE(::testing::Message() << count << " intervals, ends " << static_cast<int>(ends));
      std::vector<Columns> values;
      for (double t : times) values.push_back(At(t, Uneven, Other));
      if (ends == SplineEnds::kPeriodic) values.back() = values.front();
      const std::vector<Interval> intervals = ChainThrough(times, values);
      const Columns none = Columns::Zero(3, 2);
      const Corrections corrections(intervals, ends, 0, none, none);
      Columns velocity, acceleration, first_velocity, first_acceleration;
      for (int i = 0; i < count; ++i) {
        const auto [first, last] = VelocitiesOf(corrections, intervals, i);
        const auto [start, end] = AccelerationsOf(intervals[i], first, last);
        if (i > 0) {
          EXPECT_LT((first - velocity).norm(), 1e-10) << i;
          EXPECT_LT((start - acceleration).norm(), 1e-9) << i;
        } else {
          first_velocity = first;
          first_acceleration = start;
        }
        velocity = last;
        acceleration = end;
      }
      if (ends == SplineEnds::kPeriodic) {
        EXPECT_LT((velocity - first_velocity).norm(), 1e-10);
        EXPECT_LT((acceleration - first_acceleration).norm(), 1e-9);
      } else {
        EXPECT_LT(first_acceleration.norm(), 1e-9);
        EXPECT_LT(acceleration.norm(), 1e-9);
      }
    }
  }
}

// Three intervals 2, 1 and 4 long. The first column goes 6, 1 and 20 units, at speeds 3, 1 and 5;
// the second goes nowhere in the last interval.
std::vector<Interval> UnevenChain() {
  std::vector<Columns> values(4, Columns::Zero(3, 2));
  values[1].col(0) << 6, 0, 0;
  values[2].col(0) << 7, 0, 0;
  values[3].col(0) << 7, 0, 20;
  values[1].col(1) << 0, 8, 0;
  values[2].col(1) << 0, 8, 2;
  values[3].col(1) = values[2].col(1);
  return ChainThrough({0, 2, 3, 7}, values);
}

// The speeds at both ends of all intervals, a row for each, a column for each quantity.
Eigen::MatrixXd Speeds(SplineEnds ends, double limit) {
  const std::vector<Interval> intervals = UnevenChain();
  Columns first(3, 2), last(3, 2);
  first << 100, 0, 0, -200, 0, 0;
  last << 0, 0, 300, 0, 0, 400;
  const Corrections corrections(intervals, ends, limit, first, last);
  Eigen::MatrixXd speeds(6, 2);
  for (int i = 0; i < 3; ++i) {
    const auto [start, end] = VelocitiesOf(corrections, intervals, i);
    speeds.row(2 * i) = start.colwise().norm();
    speeds.row(2 * i + 1) = end.colwise().norm();
  }
  return speeds;
}

// Of the intervals at a pose the slower one counts, by quantity; given velocities have no limit.
TEST(Corrections, VelocitiesAreLimitedByTheSlowerInterval) {
  constexpr double kLimit = 0.01;
  Eigen::MatrixXd natural(6, 2), clamped(6, 2), periodic(6, 2);
  natural << 3, 4, 1, 2, 1, 2, 1, 0, 1, 0, 5, 0;
  clamped = periodic = natural;
  clamped.row(0) << 100 / kLimit, 200 / kLimit;
  clamped.row(5) << 300 / kLimit, 400 / kLimit;
  periodic.row(0) << 3, 0;
  periodic.row(5) << 3, 0;
  EXPECT_LT((Speeds(SplineEnds::kNatural, kLimit) - kLimit * natural).norm(), 1e-9);
  EXPECT_LT((Speeds(SplineEnds::kNotAKnot, kLimit) - kLimit * natural).norm(), 1e-9);
  EXPECT_LT((Speeds(SplineEnds::kClamped, kLimit) - kLimit * clamped).norm(), 1e-9);
  EXPECT_LT((Speeds(SplineEnds::kPeriodic, kLimit) - kLimit * periodic).norm(), 1e-9);
  // A limit that none reaches changes nothing, and neither does 0.
  const Eigen::MatrixXd free = Speeds(SplineEnds::kNatural, 0);
  EXPECT_GT(free(5, 0), 5);
  EXPECT_LT((Speeds(SplineEnds::kNatural, 1e6) - free).col(0).norm(), 1e-9);
}

}  // namespace
}  // namespace shapespace::internal
