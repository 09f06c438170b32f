#ifndef SHAPESPACE_STATISTICS_ASSESS_H_
#define SHAPESPACE_STATISTICS_ASSESS_H_

#include <memory>
#include <string>
#include <vector>

#include <shapespace/base/not_computed.h>
#include <shapespace/statistics/shape_model.h>

namespace shapespace {

struct AssessmentOptions {
  ShapeModelOptions model;  ///< of the models that leave one pose out; `modes` is the most that are
                            ///< assessed (0: all)
  bool fit = false;         ///< coordinates of the pose that was left out (ShapeModel::Coordinates)
  int samples = 30;         ///< random shapes, for specificity
  unsigned seed = 1;        ///< of these

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// How well a shape model of so many modes describes shapes: the three measures of the field
/// (Davies, "Learning Shape: Optimal Models for Analysing Natural Variability", 2002). Distances
/// are area-weighted means over the vertices, after rigid alignment, as shares of the mean diagonal
/// of the poses' bounding boxes.
struct ModelQuality {
  int modes = 0;
  double compactness = kNotComputed;     ///< share of the variance
  double generalisation = kNotComputed;  ///< distance of a pose from the nearest shape of the model
                                         ///< that is made without it, on the mean over the poses
  double generalisation_edges = kNotComputed;  ///< the same for the rms of logarithmic edge lengths
  double specificity = kNotComputed;  ///< distance of a random shape from the nearest pose, on the
                                      ///< mean
  /// The rms by which logarithms of the edge lengths of random shapes leave the range that they
  /// have in the poses.
  double beyond = kNotComputed;
};

struct Assessment {
  std::vector<ModelQuality> rows;  ///< for 1, 2, ... modes
  int poses = 0;
  int unconverged = 0;  ///< shapes whose search ended early
  double total_seconds = 0;
  std::string FullReport() const;  ///< a table
  std::string ToJson() const;
};

/// Makes the model of all poses, and as many models as poses, each without one of them.
/// \throw as `MakeShapeModel`; InvalidOptions if there are less than three poses.
Assessment AssessShapeModel(const std::shared_ptr<const Connectivity>& connectivity,
                            const std::vector<Shape>& poses, const AssessmentOptions& options = {},
                            Progress* progress = nullptr);

}  // namespace shapespace

#endif  // SHAPESPACE_STATISTICS_ASSESS_H_
