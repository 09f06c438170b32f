#ifndef SHAPESPACE_GEODESIC_DETAIL_CONTACT_PIECE_H_
#define SHAPESPACE_GEODESIC_DETAIL_CONTACT_PIECE_H_

#include <vector>

#include <shapespace/contact/internal/contact_model.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/geodesic/internal/resolution.h>
#include <shapespace/hierarchy/hierarchy.h>

namespace shapespace::internal {

/// The path between two poses without contact, coarse to fine.
class ContactPiece {
 public:
  /// For a piece of the path that has number `index` in the summary, to which rows and warnings are
  /// added. `resolutions` has one entry for each level of `hierarchy`. `obstacle` is null if there
  /// is none; if there is one, it is in the frame of the guide.
  ContactPiece(int index, const Hierarchy& hierarchy, std::vector<Resolution>* resolutions,
               const GeodesicOptions& options, const Obstacle* obstacle, Workload* workload,
               GeodesicSummary* summary);

  /// `guide` is a path on the finest level that may have contact. If it has none and as many
  /// segments as `options.shapes` asks for, the result is the same, bit for bit. Otherwise it is
  /// the path of so many shapes that goes round; if none is found, the guide with so many shapes,
  /// with a warning.
  std::vector<Shape> Run(const std::vector<Shape>& guide);

 private:
  // Replaces `result` by the path that goes round if there is one; returns its segments with
  // contact.
  std::vector<int> AvoidOnAllLevels(const ContactModel& model, const std::vector<Shape>& guide,
                                    std::vector<Shape>* result);
  std::vector<Shape> Restrict(const std::vector<Shape>& shapes, int level) const;
  ContactModel Model(int level, const std::vector<Shape>& guide,
                     ContactModel::Intersections intersections) const;
  // The path round the contacts on a level, with a row in the summary; empty if there is none.
  std::vector<Shape> Avoid(int level, double energy, const std::vector<Shape>& guide);
  // A path of `level` on the next finer one, with the detail of `guide`, as many shapes of the mesh
  // itself.
  std::vector<Shape> Lift(const std::vector<Shape>& path, int level,
                          const std::vector<Shape>& guide) const;

  const int index_;
  const Hierarchy& hierarchy_;
  std::vector<Resolution>& resolutions_;
  const GeodesicOptions& options_;
  const Obstacle* const obstacle_;
  Workload& workload_;
  GeodesicSummary& summary_;
  int parts_ = 0;  // ContactFreePath::parts of the last level
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_GEODESIC_DETAIL_CONTACT_PIECE_H_
