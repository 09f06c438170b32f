#ifndef SHAPESPACE_CORRESPONDENCE_DETAIL_MARKED_PART_H_
#define SHAPESPACE_CORRESPONDENCE_DETAIL_MARKED_PART_H_

#include <memory>
#include <vector>

#include <shapespace/correspondence/correspondence.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// The components of a body that have markers. The others, such as eyes, teeth and clothes, are not
/// fitted, but follow the nearest of these.
struct MarkedPart {
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<int> vertices;  ///< for each of the part's the one of the body, ascending
  int others = 0;             ///< components that follow

  MarkedPart(const std::shared_ptr<const Connectivity>& body,
             const std::vector<CorrespondenceMarker>& markers);

  bool IsAll() const { return others == 0; }
  int IndexOf(int vertex) const;  ///< in the part, of a vertex of the body that is in it

  /// The body when the part has become `moved`. Vertices of other components keep their offsets
  /// from the points of the part that are nearest at `rest`, turned as the part is there.
  Shape Follow(const Shape& rest, const Shape& moved) const;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CORRESPONDENCE_DETAIL_MARKED_PART_H_
