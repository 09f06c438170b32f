// The steps that a line search tries, one by one.
#include <shapespace/minimise/detail/line_search.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace shapespace::internal {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

struct Line {
  std::function<double(double)> value, slope;

  // The steps that are tried, of which the last is that of the result.
  std::vector<double> Tried(double longest = kUnlimited) const {
    std::vector<double> steps;
    const auto evaluate = [&](double step) {
      steps.push_back(step);
      return LinePoint{step, value(step), slope(step)};
    };
    const LinePoint end = SearchLine({0, value(0), slope(0)}, evaluate, longest);
    EXPECT_EQ(end.step, steps.back());
    EXPECT_EQ(end.value, value(end.step));
    return steps;
  }
};

void ExpectSteps(const std::vector<double>& tried, const std::vector<double>& expected) {
  ASSERT_EQ(tried.size(), expected.size());
  for (size_t i = 0; i < tried.size(); ++i) EXPECT_NEAR(tried[i], expected[i], 1e-9) << i;
}

Line ParabolaWithMinimumAt(double t) {
  return {[=](double x) { return (x - t) * (x - t); }, [=](double x) { return 2 * (x - t); }};
}

TEST(LineSearchSteps, AWholeStepOrTheLongestThatIsAllowed) {
  ExpectSteps(ParabolaWithMinimumAt(0.8).Tried(), {1});
  ExpectSteps(ParabolaWithMinimumAt(0.8).Tried(0.25), {0.25});
  ExpectSteps(ParabolaWithMinimumAt(300).Tried(0.25), {0.25});
}

// Beyond a point that is too steep still, to where the slope would vanish, ten times as far at
// most, and no further than allowed.
TEST(LineSearchSteps, GoFurtherWhereItIsSteep) {
  ExpectSteps(ParabolaWithMinimumAt(30).Tried(), {1, 10});
  ExpectSteps(ParabolaWithMinimumAt(300).Tried(4), {1, 4});
  ExpectSteps(ParabolaWithMinimumAt(300).Tried(), {1, 10, 100});
  // Of slopes -1, -5 and -1 at 0, 1 and 10: where it would vanish, 12.25 further on, is tried.
  const auto slope = [](double t) { return t < 0.5 ? -1 : t < 5 ? -5 : t < 11 ? -1 : 0; };
  ExpectSteps(Line{[](double t) { return -t; }, slope}.Tried(), {1, 10, 20});
  // Slopes -1, -3 and -2: 18 further.
  const auto flatter = [](double t) { return t < 0.5 ? -1 : t < 5 ? -3 : t < 11 ? -2 : 0; };
  ExpectSteps(Line{[](double t) { return -t; }, flatter}.Tried(), {1, 10, 28});
}

// The minimum of the cubic, which is exact for one: t^3 / 3 - t^2 / 8 - t / 8 has it at 1/2.
TEST(LineSearchSteps, GoBackToTheMinimumOfTheCubic) {
  ExpectSteps(Line{[](double t) { return t * t * t / 3 - t * t / 8 - t / 8; },
                   [](double t) { return t * t - t / 4 - 1. / 8; }}
                  .Tried(),
              {1, 0.5});
  // From between 1 and 10 too, where 10 is too high.
  const auto value = [](double t) { return t < 9 ? -t : 100; };
  const auto slope = [](double t) { return t < 2 ? -1. : t < 9 ? 0. : 1000.; };
  const std::vector<double> tried = Line{value, slope}.Tried();
  ASSERT_EQ(tried.size(), 3u);
  EXPECT_EQ(tried[1], 10);
  EXPECT_GE(tried[2], 1.9);
  EXPECT_LE(tried[2], 9.1);
}

TEST(LineSearchSteps, StayAwayFromTheBeginningOfTheBracket) {
  const auto enormous = [](double t) { return t > 0.5 ? 1e9 : -t; };
  const auto flat = [](double t) { return t > 0 ? 0. : -1.; };
  ExpectSteps(Line{enormous, flat}.Tried(), {1, 0.1});
}

TEST(LineSearchSteps, HalveABracketWithAnEndThatIsNotFinite) {
  for (double bad : {kUnlimited, std::nan("")}) {
    ExpectSteps(Line{[=](double t) { return t > 0.3 ? bad : -t; },
                     [=](double t) { return t > 0.3 ? bad
                                            : t > 0 ? 0.
                                                    : -1.; }}
                    .Tried(),
                {1, 0.5, 0.25});
    // A value that is finite but whose slope is not.
    ExpectSteps(Line{[](double t) { return -t; },
                     [=](double t) { return t > 0.3 ? bad
                                            : t > 0 ? 0.
                                                    : -1.; }}
                    .Tried(),
                {1, 0.5, 0.25});
  }
}

TEST(LineSearchSteps, AcceptAPointBeyondTheMinimumThatIsLower) {
  const auto slope = [](double t) { return t > 0 ? 5. : -1.; };
  ExpectSteps(Line{[](double t) { return t > 0 ? 0.5 : 1.; }, slope}.Tried(), {1});
  const Line higher = {[](double t) { return 1 + 1e-3 * t; }, slope};
  const LinePoint end = SearchLine({0, 1, -1}, [&](double t) {
    return LinePoint{t, higher.value(t), higher.slope(t)};
  });
  EXPECT_EQ(end.step, 0);
}

// A straight descent is followed ten times as far each time, and evaluated last where it ends.
TEST(LineSearchSteps, EndAfterTwentyTrials) {
  const std::vector<double> tried =
      Line{[](double t) { return -t; }, [](double) { return -1.; }}.Tried();
  ASSERT_EQ(tried.size(), 21u);
  EXPECT_EQ(tried[0], 1);
  EXPECT_NEAR(tried[19] / 1e19, 1, 1e-9);
  EXPECT_EQ(tried[20], tried[19]);
  int evaluations = 0;
  const LinePoint start = {0, 1, -1};
  EXPECT_EQ(SearchLine(start,
                       [&](double t) {
                         ++evaluations;
                         return LinePoint{t, 2, 1};
                       })
                .step,
            0);
  EXPECT_EQ(evaluations, 20);
}

}  // namespace
}  // namespace shapespace::internal
