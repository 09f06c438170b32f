#include "support/obstacle_flag.h"

#include "support/flag_group.h"
#include "support/poses.h"
#include "support/tool.h"

DEFINE_string(obstacle, "",
              "with --avoid_contact: the file of a mesh that does not move and that the body must "
              "not touch either; the poses are where they are to be beside it");
FLAG_GROUP(obstacle, "Path", "");

namespace shapespace::tools {

std::optional<Obstacle> ObstacleFromFlag(bool avoid_contact) {
  if (FLAGS_obstacle.empty()) return {};
  if (!avoid_contact) throw UsageError("--obstacle goes with --avoid_contact");
  const Poses poses = ReadMeshesFromFlags({FLAGS_obstacle}, /*tie=*/false);
  return Obstacle{poses.connectivity, poses.shapes[0]};
}

}  // namespace shapespace::tools
