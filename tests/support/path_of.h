#ifndef SHAPESPACE_TESTS_SUPPORT_PATH_OF_H_
#define SHAPESPACE_TESTS_SUPPORT_PATH_OF_H_

#include <memory>
#include <vector>

#include <shapespace/path/align.h>
#include <shapespace/path/path.h>

namespace shapespace::testing {

/// A path of `shapes` (user's unit, evenly spaced in time), aligned as by solvers; the first and
/// the last are its poses.
inline Path PathOf(const std::shared_ptr<const Connectivity>& connectivity,
                   const std::vector<Shape>& shapes) {
  Path path;
  path.metric = FreezeMetric({}, connectivity, shapes);
  AlignedPoses aligned = AlignPoses(*path.metric, shapes);
  path.shapes = std::move(aligned.shapes);
  path.motions = std::move(aligned.motions);
  for (size_t i = 0; i < shapes.size(); ++i) {
    path.parameters.push_back(static_cast<double>(i) / (shapes.size() - 1));
  }
  path.poses = {0, static_cast<int>(shapes.size()) - 1};
  return path;
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_PATH_OF_H_
