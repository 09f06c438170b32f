#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/SVD>

#include <shapespace/base/error.h>
#include <shapespace/statistics/detail/permutations.h>
#include <shapespace/statistics/internal/summary_fields.h>
#include <shapespace/statistics/regression.h>
#include <shapespace/summary/internal/json_of.h>
#include <shapespace/summary/internal/report.h>

namespace shapespace {
namespace {

constexpr double kMostOfTheVariance = 0.95;

// Directions in which poses vary by less than this share of what they vary most are rounding.
constexpr double kLeastVariation = 1e-6;

// A chance value counts as large as the true one if it is so but for rounding. Groups whose means
// explain all but this share of the variation have none within.
constexpr double kTie = 1e-9, kNothingWithin = 1e-12;

// The rows in coordinates in which they are uncorrelated and vary alike, in all directions in which
// they vary at all. T^2 is the same in these.
Eigen::MatrixXd Whitened(const Eigen::MatrixXd& rows) {
  const Eigen::MatrixXd centred = rows.rowwise() - rows.colwise().mean();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(centred, Eigen::ComputeThinU);
  const Eigen::VectorXd& values = svd.singularValues();
  const auto rank = (values.array() > kLeastVariation * values(0)).count();
  return svd.matrixU().leftCols(rank);
}

// Two groups: the first `first` of all rows are the one, the others the other. Each row has a
// weight, which it keeps whatever pose it is given.
class TwoGroups {
 public:
  TwoGroups(Eigen::Index first, Eigen::VectorXd weights)
      : first_(first), weights_(std::move(weights)) {}

  Eigen::VectorXd BetweenMeans(const Eigen::MatrixXd& rows) const {
    const Eigen::Index second = weights_.size() - first_;
    return rows.bottomRows(second).transpose() * weights_.tail(second) / Second() -
           rows.topRows(first_).transpose() * weights_.head(first_) / First();
  }

  // The share of the variation that the means explain, in the direction in which it is greatest, of
  // rows that are whitened: u^T S^-1 u, where S, the scatter about the mean of all, is u u^T and
  // the scatter within groups. S is not singular, which that within groups is if they are perfectly
  // apart.
  double Explained(const Eigen::MatrixXd& rows) const {
    const Eigen::MatrixXd centred = rows.rowwise() - (weights_.transpose() * rows) / weights_.sum();
    const Eigen::MatrixXd scatter = centred.transpose() * weights_.asDiagonal() * centred;
    const Eigen::VectorXd between = BetweenMeans(rows);
    return First() * Second() / weights_.sum() * between.dot(scatter.ldlt().solve(between));
  }

 private:
  double First() const { return weights_.head(first_).sum(); }
  double Second() const { return weights_.sum() - First(); }

  const Eigen::Index first_;
  const Eigen::VectorXd weights_;
};

// Hotelling's T^2 of so many poses.
double TSquared(double explained, int poses) {
  if (explained > 1 - kNothingWithin) return std::numeric_limits<double>::infinity();
  return (poses - 2) * explained / (1 - explained);
}

// Of all ways to choose the first group, the one that is given is at least one, and two with its
// opposite if both groups have the same number. Chance values, of which there is a limited number,
// may find it more rarely.
double LeastProbability(int first, int second) {
  double ways = 1;
  for (int k = 1; k <= first; ++k) ways *= static_cast<double>(second + k) / k;
  return (first == second ? 2 : 1) / ways;
}

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
  std::vector<int> members = first;
  members.insert(members.end(), second.begin(), second.end());
  const Eigen::MatrixXd coordinates = modes.Coordinates()(members, Eigen::seqN(0, result.modes));
  const Eigen::MatrixXd whitened = Whitened(coordinates);
  // In the unit of displacements.
  const Eigen::MatrixXd displacements =
      coordinates * modes.variances.head(result.modes).cwiseSqrt().asDiagonal();
  const TwoGroups groups(result.first_count, modes.weights(members));
  const double explained = groups.Explained(whitened);
  result.t_squared = TSquared(explained, poses);
  result.distance = groups.BetweenMeans(displacements).norm();
  const PermutationOptions& permutation = options.permutation;
  internal::Permutations permutations(poses, permutation.seed);
  int as_far = 1, as_distant = 1;
  for (int i = 0; i < permutation.permutations; ++i) {
    const std::vector<int>& order = permutations.Next();
    const double chance = groups.Explained(whitened(order, Eigen::all));
    const double distance = groups.BetweenMeans(displacements(order, Eigen::all)).norm();
    if (chance >= explained * (1 - kTie)) ++as_far;
    if (distance >= result.distance * (1 - kTie)) ++as_distant;
  }
  const double least = LeastProbability(result.first_count, result.second_count);
  result.t_squared_p =
      std::max(least, static_cast<double>(as_far) / (permutation.permutations + 1));
  result.distance_p =
      std::max(least, static_cast<double>(as_distant) / (permutation.permutations + 1));
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
