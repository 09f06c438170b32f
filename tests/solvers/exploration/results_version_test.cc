// Notices when the solver's results change, so that geodesics that an earlier version of it stored
// are not taken for results of the present one.
#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/exploration/detail/pair_solver.h>
#include <shapespace/exploration/explore.h>

#include "solvers/exploration/spaces.h"

namespace shapespace {
namespace {

using internal::kResultsVersion;
using internal::PairResult;
using internal::PairSolver;

// Two numbers of a geodesic that change when its solution does: its length, and the root mean
// square deviation of its middle from the middle of the straight line.
using Numbers = std::array<double, 2>;

// The results of `Cases()` in order, and the version that they belong to.
constexpr int kRecordedVersion = 7;
const std::vector<Numbers> kRecorded = {{0.09603587525, 0.02850898185},
                                        {0.1001513431, 0.05044630164},
                                        {0.09627688984, 0.05236907042},
                                        {0.100154794, 0.05082410509},
                                        {0.09603268082, 0.02859308253}};

// Geodesics of small bodies, which rounding hardly changes: input that is perturbed by 1e-12
// changes these numbers by less than a part in 10^9. Other orders of levels, starts or tolerances
// change some of them by a part in 10^5 or more.
constexpr double kTolerance = 1e-6;

struct Case {
  std::string name;
  Shape from, to;
  GeodesicOptions options;
};

// With every metric option named, so that new defaults, which records distinguish, are no new
// results.
GeodesicOptions Options(double isometric, double strain, int coarsest, GeodesicSolver solver) {
  GeodesicOptions options = ExploreOptions::Defaults();
  options.metric.isometric = isometric;
  options.metric.strain = strain;
  options.metric.lambda = 1e-4;
  options.metric.bending = 1e-5;
  options.coarsest = coarsest;
  options.solver = solver;
  return options;
}

std::vector<Case> Cases(const ShapeFamily& tube) {
  const std::vector<Shape> poses = testing::TubePoses(tube);
  constexpr auto kDefault = GeodesicSolver::kAutomatic;
  return {{"lengths", poses[0], poses[3], Options(1, 0, 200, kDefault)},
          {"strains", poses[1], poses[2], Options(0, 1, 200, kDefault)},
          {"lengths, more levels", poses[1], poses[2], Options(1, 0, 60, kDefault)},
          {"strains, more levels", poses[1], poses[2], Options(0, 1, 60, kDefault)},
          {"threaded", poses[0], poses[3], Options(1, 0, 200, GeodesicSolver::kThreadedLbfgs)}};
}

Numbers Solve(const ShapeFamily& body, const Case& given) {
  ProcessPool alone;
  PairSolver solver(body.connectivity, {given.from, given.to}, given.options, &alone, "");
  const double unit = solver.GetMetric()->unit;
  const Shape from = given.from / unit, to = given.to / unit;
  const PairResult result = solver.Solve({{&from, &to, 0.5}}, "", nullptr).front();
  const double squares = (result.shape - (from + to) / 2).squaredNorm();
  return {result.length, std::sqrt(squares / static_cast<double>(from.cols()))};
}

TEST(ResultsVersion, IsRaisedWhenResultsChange) {
  const ShapeFamily tube = testing::SmallTube();
  const std::vector<Case> cases = Cases(tube);
  std::ostringstream now, changed;
  now << std::setprecision(10);
  for (size_t i = 0; i < cases.size(); ++i) {
    const Numbers numbers = Solve(tube, cases[i]);
    now << (i > 0 ? ", " : "") << '{' << numbers[0] << ", " << numbers[1] << '}';
    for (size_t k = 0; k < numbers.size(); ++k) {
      const double recorded = i < kRecorded.size() ? kRecorded[i][k] : 0;
      if (std::abs(numbers[k] / recorded - 1) < kTolerance) continue;
      changed << "  " << cases[i].name << ": " << recorded << " is now " << numbers[k] << '\n';
    }
  }
  const bool same = changed.str().empty();
  EXPECT_TRUE(same && kRecordedVersion == kResultsVersion)
      << (same ? "Results are those of version " : "Results differ from those of version ")
      << kRecordedVersion << ", and kResultsVersion is " << kResultsVersion << ".\n"
      << changed.str()
      << "If the change is intended, records of earlier results must not be used any more. Set "
         "kResultsVersion (exploration/pair_solver.h) and kRecordedVersion (this test) to "
      << std::max(kRecordedVersion + (same ? 0 : 1), kResultsVersion)
      << ", and the numbers of this test to\n"
      << "const std::vector<Numbers> kRecorded = {" << now.str() << "};\n";
}

}  // namespace
}  // namespace shapespace
