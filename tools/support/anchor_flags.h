#ifndef SHAPESPACE_TOOLS_SUPPORT_ANCHOR_FLAGS_H_
#define SHAPESPACE_TOOLS_SUPPORT_ANCHOR_FLAGS_H_

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <shapespace/deformation/standing.h>
#include <shapespace/mesh/selection.h>
#include <shapespace/path/path.h>

namespace shapespace::tools {

/// The rigid motion of a path's shapes according to --anchor and --ground.
class AnchorFlags {
 public:
  /// \throw UsageError if a flag's value is invalid.
  static AnchorFlags FromFlags();

  /// Selects the vertices of --anchor in the first shape, before the solve of a path with so many
  /// poses.
  /// \throw UsageError if there are none, or parts are to stand at other poses.
  void Select(const Shape& shape, const Connectivity& connectivity, const Appearance& appearance,
              size_t num_poses);

  /// Moves the shapes of `path`, which are those of `whole`, possibly at other times, and adds this
  /// to its provenance. Parts that stand are told of on the terminal. Requires `Select`.
  void Apply(const Path& whole, Path* path) const;
  void Apply(Path* path) const { Apply(*path, path); }

 private:
  std::optional<Selection> anchor_;  // of one part, which is held by rigid motion
  std::vector<int> vertices_;
  std::vector<StandingPart> parts_;
  std::optional<std::pair<int, double>> ground_;  // axis and height
};

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_ANCHOR_FLAGS_H_
