#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>

#include <shapespace/base/error.h>
#include <shapespace/numerics/internal/json_of.h>
#include <shapespace/numerics/internal/report.h>
#include <shapespace/statistics/internal/permutations.h>
#include <shapespace/statistics/internal/summary_fields.h>
#include <shapespace/statistics/regression.h>

namespace shapespace {
namespace {

constexpr double kMostOfTheVariance = 0.95;

// How two groups differ; the first `first` rows are the one, the others the other.
struct Difference {
  double t_squared = 0, squared_distance = 0;

  Difference(const Eigen::MatrixXd& rows, Eigen::Index first, const Eigen::VectorXd& variances) {
    const Eigen::Index second = rows.rows() - first;
    const Eigen::RowVectorXd mean_a = rows.topRows(first).colwise().mean();
    const Eigen::RowVectorXd mean_b = rows.bottomRows(second).colwise().mean();
    const Eigen::MatrixXd a = rows.topRows(first).rowwise() - mean_a;
    const Eigen::MatrixXd b = rows.bottomRows(second).rowwise() - mean_b;
    const Eigen::MatrixXd pooled =
        (a.transpose() * a + b.transpose() * b) / static_cast<double>(rows.rows() - 2);
    const Eigen::VectorXd between = (mean_b - mean_a).transpose();
    t_squared = static_cast<double>(first * second) / static_cast<double>(rows.rows()) *
                between.dot(pooled.ldlt().solve(between));
    squared_distance = between.cwiseAbs2().dot(variances);
  }
};

GroupDifference Compare(const PoseModes& modes, const std::vector<int>& first,
                        const std::vector<int>& second, const GroupOptions& options) {
  const auto poses = static_cast<int>(first.size() + second.size());
  GroupDifference result;
  result.first_count = static_cast<int>(first.size());
  result.second_count = static_cast<int>(second.size());
  result.modes = options.modes;
  if (result.modes == 0) {
    const int most = std::min(modes.NumModes(), std::max(1, poses / 2 - 1));
    result.modes = 1;
    while (result.modes < most && modes.Share(result.modes) < kMostOfTheVariance) ++result.modes;
  }
  if (result.modes > modes.NumModes() || result.modes > poses - 2) {
    throw InvalidOptions("modes", "must be at most " +
                                      std::to_string(std::min(modes.NumModes(), poses - 2)) +
                                      " for these groups");
  }
  const Eigen::MatrixXd coordinates = modes.Coordinates().leftCols(result.modes);
  const Eigen::VectorXd variances = modes.variances.head(result.modes);
  Eigen::MatrixXd rows(poses, result.modes);
  int row = 0;
  for (const int pose : first) rows.row(row++) = coordinates.row(pose);
  for (const int pose : second) rows.row(row++) = coordinates.row(pose);
  const Difference truth(rows, result.first_count, variances);
  result.t_squared = truth.t_squared;
  result.distance = std::sqrt(truth.squared_distance);
  // A chance value counts as large as the true one if it is so but for rounding.
  const double t_squared = truth.t_squared * (1 - 1e-9);
  const double squared_distance = truth.squared_distance * (1 - 1e-9);
  const PermutationOptions& permutation = options.permutation;
  internal::Permutations permutations(poses, permutation.seed);
  int as_far = 1, as_distant = 1;
  Eigen::MatrixXd permuted = rows;
  for (int i = 0; i < permutation.permutations; ++i) {
    const std::vector<int>& order = permutations.Next();
    for (int k = 0; k < poses; ++k) permuted.row(k) = rows.row(order[k]);
    const Difference chance(permuted, result.first_count, variances);
    if (chance.t_squared >= t_squared) ++as_far;
    if (chance.squared_distance >= squared_distance) ++as_distant;
  }
  result.t_squared_p = static_cast<double>(as_far) / (permutation.permutations + 1);
  result.distance_p = static_cast<double>(as_distant) / (permutation.permutations + 1);
  return result;
}

}  // namespace

void GroupOptions::Validate() const {
  permutation.Validate();
  if (modes < 0) throw InvalidOptions("modes", "must be 0 or more");
}

std::vector<GroupDifference> CompareGroups(const PoseModes& modes,
                                           const std::vector<std::string>& labels,
                                           const GroupOptions& options) {
  options.Validate();
  modes.Validate();
  if (static_cast<int>(labels.size()) != modes.NumPoses()) {
    throw InvalidOptions("labels",
                         "must be " + std::to_string(modes.NumPoses()) + ", one for each pose");
  }
  if (modes.NumModes() == 0) throw InvalidOptions("modes", "there are none in which groups differ");
  std::map<std::string, std::vector<int>> groups;
  for (int i = 0; i < modes.NumPoses(); ++i) groups[labels[i]].push_back(i);
  if (groups.size() < 2) throw InvalidOptions("labels", "name one group; two are compared");
  for (const auto& [label, members] : groups) {
    if (members.size() < 2) {
      throw InvalidOptions("labels",
                           "name a group of one pose, " + label + "; groups have two or more");
    }
  }
  std::vector<GroupDifference> differences;
  for (auto first = groups.begin(); first != groups.end(); ++first) {
    for (auto second = std::next(first); second != groups.end(); ++second) {
      differences.push_back(Compare(modes, first->second, second->second, options));
      differences.back().first = first->first;
      differences.back().second = second->first;
    }
  }
  return differences;
}

std::string ReportOf(const std::vector<GroupDifference>& differences) {
  std::string text;
  for (const GroupDifference& d : differences) {
    text += d.first + internal::Format(" (%d poses) and ", d.first_count) + d.second +
            internal::Format(
                " (%d poses), in %d modes: T^2 = %.4g, p = %.4f; distance of the means %.4g, "
                "p = %.4f\n",
                d.second_count, d.modes, d.t_squared, d.t_squared_p, d.distance, d.distance_p);
  }
  return text;
}

std::string JsonTextOf(const std::vector<GroupDifference>& differences) {
  return internal::TextOf(internal::JsonOf(differences));
}

}  // namespace shapespace
