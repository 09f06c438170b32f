#ifndef SHAPESPACE_TOOLS_SUPPORT_OBSTACLE_FLAG_H_
#define SHAPESPACE_TOOLS_SUPPORT_OBSTACLE_FLAG_H_

#include <optional>

#include <gflags/gflags.h>

#include <shapespace/contact/obstacle.h>

DECLARE_string(obstacle);

namespace shapespace::tools {

/// The mesh that --obstacle names; none if it is not given.
/// \throw UsageError if it is given without --avoid_contact.
std::optional<Obstacle> ObstacleFromFlag(bool avoid_contact);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_OBSTACLE_FLAG_H_
