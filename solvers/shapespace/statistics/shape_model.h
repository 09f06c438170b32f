#ifndef SHAPESPACE_STATISTICS_SHAPE_MODEL_H_
#define SHAPESPACE_STATISTICS_SHAPE_MODEL_H_

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/base/not_computed.h>
#include <shapespace/mesh/appearance.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>
#include <shapespace/statistics/average.h>

namespace shapespace {

/// What of the poses' size belongs to their shape.
enum class PoseSize {
  kKeep,    ///< a larger pose is another shape
  kRemove,  ///< poses are scaled to the same area (graphs: to the same length of edges)
};

/// The mean of poses and their principal modes: the content of a `.modes` file. Shapes are in the
/// metric's unit, centred. A shape has a coordinate for each mode, in standard deviations.
struct PoseModes {
  std::shared_ptr<const Metric> metric;  ///< frozen on all poses; has the connectivity
  std::vector<Shape> poses;              ///< rotated onto the mean
  std::vector<RigidMotion> motions;      ///< of the poses: from unit * pose to the user's frame
  std::vector<std::string> names;        ///< of the poses
  Eigen::VectorXd weights;               ///< of the poses, positive, with sum 1
  PoseSize size = PoseSize::kKeep;
  Shape mean;
  RigidMotion place;  ///< from unit * mean to the user's frame, in the middle of the poses

  /// Of a mode, in descending order: the variance of the vertices' displacements (area-weighted, in
  /// squares of the metric's unit) along it.
  Eigen::VectorXd variances;
  double total_variance = 0;  ///< of all modes, also of those that were left out
  /// A column per mode: the displacement of the mean, to first order, is the sum of the poses'
  /// logarithms times these numbers, and so are the changes of features.
  Eigen::MatrixXd coefficients;  // a row for each pose
  std::vector<Tangent> modes;    ///< the displacements by one standard deviation

  std::string provenance;  ///< the program and the inputs from which it was made
  Appearance appearance;   ///< of the connectivity's polygons: for outputs

  /// A pose in the user's unit and frame; of the size that all have if size is removed.
  Shape PlacedPose(int i) const;
  int NumPoses() const { return static_cast<int>(poses.size()); }
  int NumModes() const { return static_cast<int>(modes.size()); }
  /// The coordinates of the poses, a row for each: of mean 0 and variance 1.
  Eigen::MatrixXd Coordinates() const;
  /// The share of the total variance that the first `modes` modes have.
  double Share(int modes) const;

  /// \throw MeshError if numbers of poses, vertices or anything else do not fit together, or a
  ///        number is not finite or out of its range.
  void Validate() const;
};

/// The same model with its first modes only.
/// \throw InvalidOptions if there are not so many.
PoseModes FirstModes(PoseModes modes, int count);

struct ShapeModelOptions {
  /// Of the mean: the metric, weights of the poses, and whether it is certified.
  AverageOptions average = Uncertified();
  int modes = 0;  ///< at most as many as the poses' variation has dimensions; 0: all of these
  PoseSize size = PoseSize::kKeep;

  static AverageOptions Uncertified() {
    AverageOptions options;
    options.certify = false;
    return options;
  }

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

struct ShapeModelSummary {
  AverageSummary average;
  int modes = 0;
  int rank = 0;                   ///< number of modes that the poses have
  std::vector<double> variances;  ///< of all these, as shares of their sum
  std::vector<std::string> warnings;
  double total_seconds = 0;

  bool Converged() const { return average.Converged(); }
  std::string BriefReport() const;  ///< one line
  std::string FullReport() const;   ///< a page
  std::string ToJson() const;
};

struct ShapeModelResult {
  PoseModes modes;
  ShapeModelSummary summary;
};

/// The mean of poses (`Average`) and the principal modes of their variation: principal component
/// analysis of the displacements G^-1 J^T (Phi(P_i) - mean), the gradients at the mean that reach
/// the poses' features to first order, in the area-weighted L2 product (docs/mathematics.md,
/// section 17). Poses of weight 0 are left out. If all poses are rigid copies of one shape there is
/// no mode, with a warning.
/// \throw as `Average`; InvalidOptions also if there are fewer modes than wanted, or not one name
///        for each pose (none at all: they are counted).
ShapeModelResult MakeShapeModel(const std::shared_ptr<const Connectivity>& connectivity,
                                const std::vector<Shape>& poses,
                                const std::vector<std::string>& names,
                                const ShapeModelOptions& options = {},
                                Progress* progress = nullptr);

/// The shape that belongs to coordinates.
struct ModelShape {
  Shape shape;  ///< in the user's unit and frame
  Termination termination = Termination::kCancelled;
  int iterations = 0;
  bool Converged() const { return termination == Termination::kConverged; }
};

/// The coordinates of a shape.
struct ModelCoordinates {
  Eigen::VectorXd coordinates;
  /// The shape at the coordinates, placed on the given one; and the root of the mean squared
  /// distance of their vertices, area-weighted, in the user's unit.
  Shape shape;
  double distance = kNotComputed;
  int rounds = 0;  ///< of the fit that lowered the distance; 0 without fit
};

/// Shapes at coordinates and coordinates of shapes. Coordinates are as many as there are modes, or
/// fewer: the others are then zero.
class ShapeModel {
 public:
  /// Factors the metric at the mean.
  /// \throw MeshError (`PoseModes::Validate`), SolverError if the metric is not definite.
  explicit ShapeModel(PoseModes modes);
  ~ShapeModel();
  ShapeModel(ShapeModel&&) noexcept;

  const PoseModes& Modes() const;

  /// The shape whose features are nearest to the mean's plus the modes' times the
  /// coordinates; dihedral angles are added as angles. At 0 it is the mean.
  /// \throw InvalidOptions if there are more coordinates than modes, or one is not finite.
  ModelShape At(const Eigen::VectorXd& coordinates, Progress* progress = nullptr) const;

  /// A shape that is near to `At` and takes milliseconds: the triangles are turned and stretched
  /// by the same combination of the logarithms of the poses' triangles, and joined again by least
  /// squares. \throw as `At`.
  Shape Preview(const Eigen::VectorXd& coordinates) const;

  /// The coordinates of a shape (user's unit), in the first `modes` modes (0: all): the products of
  /// its displacement, to first order, with the modes. With `fit`, they are then changed such that
  /// the shape at the coordinates is nearest to the given one, vertex by vertex.
  /// \throw MeshError if the shape has another number of vertices or is not finite; InvalidOptions
  ///        if there are not so many modes.
  ModelCoordinates Coordinates(const Shape& shape, bool fit = false, int modes = 0,
                               Progress* progress = nullptr) const;

  /// Coordinates of a random shape: independent standard normal numbers, the same for a seed on any
  /// machine.
  Eigen::VectorXd Sample(unsigned seed) const;

 private:
  class Solver;
  Shape Placed(const Shape& shape) const;
  std::unique_ptr<const Solver> solver_;
};

}  // namespace shapespace

#endif  // SHAPESPACE_STATISTICS_SHAPE_MODEL_H_
