#ifndef SHAPESPACE_SOLVERS_REPAIR_H_
#define SHAPESPACE_SOLVERS_REPAIR_H_

#include <memory>
#include <string>
#include <vector>

#include <shapespace/analysis/shape_error.h>
#include <shapespace/base/progress.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/path/path.h>
#include <shapespace/solvers/deformation.h>

namespace shapespace {

/// How to repair.
struct RepairOptions {
  /// As for handles, of which the distorted shape is a soft one: a larger balance restores more of
  /// the reference and keeps less of the pose. One shape by default: the repaired one alone.
  DeformationOptions deformation = Defaults();

  /// The vertices whose places in the distorted shape are to be kept as far as that can be, counted
  /// from 0; empty: all. Name those of the sound parts where others are beyond repair.
  std::vector<int> vertices;

  static DeformationOptions Defaults() {
    DeformationOptions options;
    options.shapes = 1;
    options.balance = 0.5;
    return options;
  }
};

/// What happened, and what was restored.
struct RepairSummary {
  DeformationSummary deformation;  ///< from the reference, as a deformation of it
  ShapeError before, after;        ///< of the distorted and of the repaired shape
  /// How far the vertices of the repaired shape are from where the distorted one has them: root
  /// mean square weighted by area, in the user's unit.
  double moved = 0;

  bool Converged() const { return deformation.Converged(); }
  std::string BriefReport() const;  ///< one line
  std::string FullReport() const;   ///< a page
  std::string ToJson() const;
};

struct RepairResult {
  Path path;  ///< from the reference, moved onto the distorted shape, to the repaired one
  RepairSummary summary;
};

/// Restores a reference's geometry in a distorted pose of the same mesh (Kilian et al. 2007, Figure
/// 9): finds the shape near the pose that is as little stretched, bent and changed in volume
/// against the reference as the metric allows.
/// \throw as Deform.
RepairResult Repair(const std::shared_ptr<const Connectivity>& connectivity, const Shape& reference,
                    const Shape& distorted, const RepairOptions& options = {},
                    Progress* progress = nullptr);

}  // namespace shapespace

#endif  // SHAPESPACE_SOLVERS_REPAIR_H_
