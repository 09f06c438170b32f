#ifndef SHAPESPACE_STATISTICS_REGRESSION_H_
#define SHAPESPACE_STATISTICS_REGRESSION_H_

#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/base/not_computed.h>
#include <shapespace/statistics/shape_model.h>

namespace shapespace {

/// How p-values are found: by exchanging the poses at random.
struct PermutationOptions {
  int permutations = 9999;
  unsigned seed = 1;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// Coordinates of shapes as a linear function of scalars, such as age and weight.
struct Regression {
  std::vector<std::string> scalars;
  Eigen::VectorXd intercept;  ///< the coordinates where all scalars are 0
  Eigen::MatrixXd slopes;  ///< per unit of a scalar: a row for each mode, a column for each scalar
  Eigen::VectorXd least, most, mean;  ///< of the scalars over the poses
  double r_squared = kNotComputed;    ///< the share of the shapes' variance (in all modes of the
                                      ///< model) that the scalars explain
  double p_value =
      kNotComputed;  ///< of all scalars together: of finding as large a share by chance
  /// For each scalar, of what it explains in addition to the others, which are so controlled for.
  std::vector<double> p_values;

  /// \throw InvalidOptions if there are not as many numbers as scalars.
  Eigen::VectorXd CoordinatesAt(const Eigen::VectorXd& values) const;
  std::string FullReport() const;
  std::string ToJson() const;
};

/// Fits all coordinates by weighted linear least squares. `values` has a row for each pose and a
/// column for each scalar. For the p-value of one scalar, the residuals of the fit of all others
/// are permuted (Freedman and Lane, J. Business & Economic Statistics 1, 1983). The poses' weights
/// say how much each counts: they stay with the scalars, and every fit to permuted residuals is
/// weighted too.
/// \throw InvalidOptions if the model has no modes, numbers differ or are not finite, a scalar is
///        the same for all poses or follows from the others, or there are fewer than two more poses
///        than scalars.
Regression Regress(const PoseModes& modes, const std::vector<std::string>& scalars,
                   const Eigen::MatrixXd& values, const PermutationOptions& options = {});

/// Whether two groups of poses differ on the mean.
struct GroupDifference {
  std::string first, second;  ///< labels of the groups
  int first_count = 0, second_count = 0;
  int modes = 0;  ///< in which they are compared, the first ones
  /// Hotelling's T^2 in the coordinates; infinite if nothing varies within the groups in a
  /// direction in which their means differ.
  double t_squared = kNotComputed;
  double t_squared_p = kNotComputed;  ///< of finding as large a value by chance
  double distance = kNotComputed;     ///< of the means, in the root of the variances' unit
  double distance_p = kNotComputed;
};

struct GroupOptions {
  int modes = 0;  ///< 0: those with 95 % of the variance, but at most half as many as poses
  PermutationOptions permutation;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// Compares all pairs of groups; `labels` has one per pose. Means and covariances are weighted;
/// for p-values, coordinates are permuted, while the weights stay with the labels. No p-value is
/// less than one divided by the number of ways to choose the first group; two if both are of one
/// number.
/// \throw InvalidOptions if there are not as many labels as poses, fewer than two groups, a group
///        of one pose, or more modes than the model has or than two groups together have poses
///        less two.
std::vector<GroupDifference> CompareGroups(const PoseModes& modes,
                                           const std::vector<std::string>& labels,
                                           const GroupOptions& options = {});

std::string ReportOf(const std::vector<GroupDifference>& differences);
std::string JsonTextOf(const std::vector<GroupDifference>& differences);

}  // namespace shapespace

#endif  // SHAPESPACE_STATISTICS_REGRESSION_H_
