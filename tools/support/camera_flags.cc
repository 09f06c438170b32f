#include "support/camera_flags.h"

#include <gflags/gflags.h>

#include "support/command_line.h"
#include "support/flag_group.h"
#include "support/lists.h"
#include "support/tool.h"

DEFINE_string(
    up, "",
    "what points up: x, y, z, -x, -y, -z, or a direction such as 0,.6,.8; without, "
    "pictures and pages choose y or z, and glb and usda, which know y and z alone, take y");
DEFINE_string(
    view, "",
    "pictures and pages: the direction from the body to the eye, such as 1,.5,-2; without, "
    "one in which much is seen");
FLAG_GROUP(camera, "Output", "");

namespace shapespace::tools {
namespace {

// Zero if the flag is not given.
Eigen::Vector3d DirectionFromFlag(const std::string& flag, const std::string& text) {
  if (text.empty()) return Eigen::Vector3d::Zero();
  const bool is_negative = text[0] == '-';
  const std::string axes = "xyz";
  const size_t axis = axes.find(text.substr(is_negative ? 1 : 0));
  if (text.size() == 1u + is_negative && axis != axes.npos) {
    return (is_negative ? -1 : 1) * Eigen::Vector3d::Unit(static_cast<Eigen::Index>(axis));
  }
  if (text.find(',') == text.npos) {
    throw UsageError("--" + flag + " " + text +
                     ": must be x, y, z, -x, -y, -z, or three numbers separated by commas");
  }
  const std::vector<double> numbers = NumbersFromFlag(flag, text);
  if (numbers.size() != 3) throw UsageError("--" + flag + " " + text + ": must be three numbers");
  const Eigen::Vector3d direction(numbers[0], numbers[1], numbers[2]);
  if (direction.isZero(0)) throw UsageError("--" + flag + " " + text + ": is no direction");
  return direction.stableNormalized();
}

}  // namespace

PageView ViewFromFlags() {
  PageView view = {DirectionFromFlag("up", FLAGS_up), DirectionFromFlag("view", FLAGS_view)};
  NamingFlags({{"eye", "view"}}, [&] { view.Validate(); });
  return view;
}

char UpOfAnimation(const std::string& file) {
  const Eigen::Vector3d up = ViewFromFlags().up;
  if (up == Eigen::Vector3d::UnitZ()) return 'z';
  if (!up.isZero(0) && up != Eigen::Vector3d::UnitY()) {
    throw UsageError(AsTyped("up") + ": " + file +
                     " can have y or z up; turn the poses, or give "
                     "--up for pictures and pages alone");
  }
  return 'y';
}

}  // namespace shapespace::tools
