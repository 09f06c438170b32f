#ifndef SHAPESPACE_DEFORMATION_REPAIR_H_
#define SHAPESPACE_DEFORMATION_REPAIR_H_

#include <memory>
#include <string>
#include <vector>

#include <shapespace/analysis/shape_error.h>
#include <shapespace/base/not_computed.h>
#include <shapespace/base/progress.h>
#include <shapespace/deformation/deformation.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/path/path.h>

namespace shapespace {

/// Options of a repair.
struct RepairOptions {
  /// As for handles; the distorted shape acts as a soft handle. A larger balance restores more of
  /// the reference and keeps less of the pose. The default is one shape, the repaired one.
  DeformationOptions deformation = Defaults();

  /// Vertices (counted from 0) whose positions in the distorted shape are to be kept approximately;
  /// if empty, all. List the undistorted parts if the rest is distorted too strongly.
  std::vector<int> vertices;

  static DeformationOptions Defaults() {
    DeformationOptions options;
    options.shapes = 1;
    options.balance = 0.5;
    return options;
  }
};

/// Outcome of a repair.
struct RepairSummary {
  DeformationSummary deformation;  ///< of the reference
  ShapeError before, after;        ///< of the distorted and the repaired shape
  /// Distance of the vertices of the repaired shape from those of the distorted one: area-weighted
  /// root mean square, in the user's unit.
  double moved = kNotComputed;

  bool Converged() const { return deformation.Converged(); }
  std::string BriefReport() const;  ///< one line
  std::string FullReport() const;   ///< a page
  std::string ToJson() const;
};

struct RepairResult {
  Path path;  ///< from the reference, aligned with the distorted shape, to the repaired shape
  RepairSummary summary;
};

/// Restores a reference's geometry in a distorted pose of the same mesh (Kilian et al. 2007, Figure
/// 9): finds the shape near the pose that has the least stretching, bending and change of volume
/// relative to the reference.
/// \throw as Deform.
RepairResult Repair(const std::shared_ptr<const Connectivity>& connectivity, const Shape& reference,
                    const Shape& distorted, const RepairOptions& options = {},
                    Progress* progress = nullptr);

}  // namespace shapespace

#endif  // SHAPESPACE_DEFORMATION_REPAIR_H_
