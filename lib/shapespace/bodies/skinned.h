#ifndef SHAPESPACE_BODIES_SKINNED_H_
#define SHAPESPACE_BODIES_SKINNED_H_

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

/// A body with bones, in named poses.
struct SkinnedBody {
  std::string name;
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<std::string> pose_names;  ///< the first is the rest pose

  /// May be called from several threads at once.
  /// \throw InvalidOptions if no pose has that name (the message lists those that are known).
  std::function<Shape(const std::string& name)> pose;

  /// The shape with every joint rotated by `part`, in [0, 1], of the difference between two poses.
  /// \throw InvalidOptions as above, or if the part is out of its range.
  std::function<Shape(const std::string& from, const std::string& to, double part)> between;

  /// A pose with random joint angles, each uniformly distributed in a range that is plausible for
  /// the joint. The same for the same seed on every machine. Limbs may pass through each other.
  std::function<Shape(unsigned seed)> random_pose;
};

/// A body that `MakeSkinnedBody` can make.
struct SkinnedBodyInfo {
  std::string name;
  std::vector<std::string> poses;
  std::vector<std::string> proportions;  ///< the first is the default
  int default_triangles = 0;
};

std::vector<SkinnedBodyInfo> ListSkinnedBodies();

/// The body `name` with about `triangles` triangles (0: its default number) in the named
/// proportions (empty: the default). All proportions of a body have the same connectivity for the
/// same number.
/// \throw InvalidOptions if a name is not known (the message lists those that are) or the number is
///        out of range.
SkinnedBody MakeSkinnedBody(const std::string& name, int triangles = 0,
                            const std::string& proportions = "");

}  // namespace shapespace

#endif  // SHAPESPACE_BODIES_SKINNED_H_
