#include <shapespace/path/path.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <string>

#include <shapespace/base/error.h>
#include <shapespace/base/parallel.h>
#include <shapespace/path/align.h>

namespace shapespace {
namespace {

/// Whether numbers ascend; false if one is not finite.
bool Rise(const std::vector<double>& numbers) {
  for (size_t i = 0; i < numbers.size(); ++i) {
    if (!std::isfinite(numbers[i]) || (i > 0 && !(numbers[i] > numbers[i - 1]))) return false;
  }
  return true;
}

/// \throw InvalidOptions naming the first time that is out of range or order.
void CheckTimes(const std::vector<double>& times, double first, double last) {
  for (size_t k = 0; k < times.size(); ++k) {
    const bool inside = times[k] >= first && times[k] <= last;
    if (inside && (k == 0 || times[k] > times[k - 1])) continue;
    std::ostringstream message;
    message << times[k]
            << (inside ? " does not rise above the one before" : " is not on the path, which runs")
            << (inside ? "" : " from ");
    if (!inside) message << first << " to " << last;
    throw InvalidOptions("times", message.str());
  }
}

// Adds shape k of `result` to its poses if it is shape i of `path` and that is a pose.
void KeepPose(const Path& path, int i, int k, Path* result) {
  const auto pose = std::lower_bound(path.poses.begin(), path.poses.end(), i);
  if (pose == path.poses.end() || *pose != i) return;
  result->poses.push_back(k);
  if (path.pose_names.empty()) return;
  result->pose_names.push_back(path.pose_names[pose - path.poses.begin()]);
}

}  // namespace

void Path::Validate() const {
  const Connectivity& connectivity = *metric->connectivity;
  const int count = NumShapes(), vertices = connectivity.NumVertices();
  const auto text = [](int number) { return std::to_string(number); };
  if (count == 0) throw MeshError("the path has no shape");
  if (parameters.size() != shapes.size() || motions.size() != shapes.size()) {
    throw MeshError("the path needs a parameter and a motion for each of its " + text(count) +
                    " shapes");
  }
  if (!Rise(parameters)) throw MeshError("the path's parameters do not rise");
  for (int i = 0; i < count; ++i) {
    const std::string shape = "shape " + text(i);
    if (shapes[i].cols() != vertices) {
      throw MeshError(shape + " has " + text(static_cast<int>(shapes[i].cols())) +
                      " vertices, its connectivity " + text(vertices));
    }
    if (!motions[i].rotation.allFinite() || !motions[i].translation.allFinite()) {
      throw MeshError(shape + ": its motion is not finite");
    }
    for (int v = 0; v < vertices; ++v) {
      if (!shapes[i].col(v).allFinite()) {
        throw MeshError(shape + ": vertex " + text(v) + " is not finite");
      }
    }
    if (!Placed(i).allFinite()) {
      throw MeshError(shape + " is not finite where its motion places it; make the path again");
    }
  }
  if (extrapolated < 0 || extrapolated >= count) {
    throw MeshError("the path's number of extrapolated shapes, " + text(extrapolated) +
                    ", is not in 0 .. " + text(count - 1));
  }
  for (size_t k = 0; k < poses.size(); ++k) {
    if (poses[k] < 0 || poses[k] >= count - extrapolated) {
      throw MeshError("the path's pose " + text(poses[k]) + " is not one of its " +
                      text(count - extrapolated) + " shapes that are not extrapolated");
    }
    if (k > 0 && poses[k] <= poses[k - 1]) throw MeshError("the path's poses do not rise");
  }
  if (!pose_names.empty() && pose_names.size() != poses.size()) {
    throw MeshError("the path has " + text(static_cast<int>(pose_names.size())) +
                    " names for its " + text(static_cast<int>(poses.size())) + " poses");
  }
  appearance.Validate(vertices, connectivity.NumPolygons(),
                      static_cast<int>(connectivity.Corners().size()));
}

Shape Path::Placed(int i) const {
  Shape placed = motions[i](metric->unit * shapes[i]);
  metric->connectivity->CopyToTwins(&placed);
  return placed;
}

std::vector<Shape> Path::Placed() const {
  std::vector<Shape> result(NumShapes());
  ParallelFor(NumShapes(), [&](int i) { result[i] = Placed(i); });
  return result;
}

Path MakePath(const std::shared_ptr<const Metric>& metric, const std::vector<Shape>& placed,
              std::vector<double> parameters) {
  const int last = static_cast<int>(placed.size()) - 1;
  for (const Shape& shape : placed) {
    if (shape.cols() != metric->connectivity->NumVertices()) {
      throw MeshError("a shape has another number of vertices than the metric");
    }
  }
  Path path;
  path.metric = metric;
  AlignedPoses aligned = AlignPoses(*metric, placed);
  path.shapes = std::move(aligned.shapes);
  path.motions = std::move(aligned.motions);
  path.parameters = std::move(parameters);
  if (path.parameters.empty()) {
    for (int i = 0; i <= last; ++i) path.parameters.push_back(last > 0 ? double(i) / last : 0);
  }
  path.poses = {0};
  if (last > 0) path.poses.push_back(last);
  path.Validate();
  return path;
}

std::vector<Shape> Resample(const std::vector<Shape>& shapes, const std::vector<double>& parameters,
                            const std::vector<double>& times) {
  if (shapes.empty() || parameters.size() != shapes.size() || !Rise(parameters)) {
    throw InvalidOptions("parameters", "must rise, one for each shape, of which there must be one");
  }
  CheckTimes(times, parameters.front(), parameters.back());
  const int count = static_cast<int>(shapes.size());
  const int window = std::min(4, count);
  std::vector<Shape> result(times.size());
  ParallelFor(static_cast<int>(times.size()), [&](int k) {
    const double t = times[k];
    const int after = static_cast<int>(std::lower_bound(parameters.begin(), parameters.end(), t) -
                                       parameters.begin());
    if (after < count && parameters[after] == t) {
      result[k] = shapes[after];
      return;
    }
    const int begin = std::clamp(after - window / 2, 0, count - window);
    result[k].setZero(3, shapes[0].cols());
    for (int i = begin; i < begin + window; ++i) {
      double weight = 1;  // Lagrange polynomial of shape i
      for (int j = begin; j < begin + window; ++j) {
        if (j != i) weight *= (t - parameters[j]) / (parameters[i] - parameters[j]);
      }
      result[k] += weight * shapes[i];
    }
  });
  return result;
}

Path Resample(const Path& path, const std::vector<double>& times) {
  if (times.empty()) throw InvalidOptions("times", "at least one is needed");
  CheckTimes(times, path.parameters.front(), path.parameters.back());
  Path result;
  result.metric = path.metric;
  result.parameters = times;
  result.converged = path.converged;
  result.smooth = path.smooth;
  result.provenance = path.provenance + "; resampled";
  result.appearance = path.appearance;
  // Pieces end at poses, where the path is not smooth, and at its ends.
  std::vector<int> corners;
  if (!path.smooth) corners = path.poses;
  corners.insert(corners.begin(), 0);
  corners.push_back(path.NumShapes() - 1);
  auto next = times.begin();
  for (size_t piece = 0; piece + 1 < corners.size(); ++piece) {
    const int begin = corners[piece], end = corners[piece + 1] + 1;
    const auto last = std::upper_bound(next, times.end(), path.parameters[end - 1]);
    const std::vector<double> local(next, last);
    next = last;
    const std::vector<Shape> shapes(path.shapes.begin() + begin, path.shapes.begin() + end);
    const std::vector<double> parameters(path.parameters.begin() + begin,
                                         path.parameters.begin() + end);
    for (Shape& shape : Resample(shapes, parameters, local)) {
      result.shapes.push_back(std::move(shape));
    }
  }
  for (size_t k = 0; k < times.size(); ++k) {
    const auto after = std::lower_bound(path.parameters.begin(), path.parameters.end(), times[k]);
    const int i = static_cast<int>(after - path.parameters.begin());
    if (*after == times[k]) {
      result.motions.push_back(path.motions[i]);
      KeepPose(path, i, static_cast<int>(k), &result);
    } else {
      const double t = (times[k] - *(after - 1)) / (*after - *(after - 1));
      result.motions.push_back(InterpolateMotion(path.motions[i - 1], path.motions[i], t));
    }
  }
  const double end = path.parameters[path.NumShapes() - 1 - path.extrapolated];
  result.extrapolated =
      static_cast<int>(times.end() - std::upper_bound(times.begin(), times.end(), end));
  return result;
}

Path SelectShapes(const Path& path, const std::vector<int>& indices) {
  if (indices.empty()) throw InvalidOptions("indices", "at least one is needed");
  const bool ascending = indices.back() >= indices.front();
  Path result;
  result.metric = path.metric;
  const int inner = path.NumShapes() - path.extrapolated;
  for (size_t k = 0; k < indices.size(); ++k) {
    const int i = indices[k];
    if (i < 0 || i >= path.NumShapes()) {
      throw InvalidOptions("indices", std::to_string(i) + " is not one of the path's " +
                                          std::to_string(path.NumShapes()) + " shapes");
    }
    if (k > 0 && (ascending ? i <= indices[k - 1] : i >= indices[k - 1])) {
      throw InvalidOptions("indices", "must ascend or descend");
    }
    result.shapes.push_back(path.shapes[i]);
    result.motions.push_back(path.motions[i]);
    result.parameters.push_back(std::abs(path.parameters[i] - path.parameters[indices.front()]));
    KeepPose(path, i, static_cast<int>(k), &result);
    // At least the first shape counts as given.
    if (ascending && k > 0 && i >= inner) ++result.extrapolated;
  }
  result.converged = path.converged;
  result.smooth = path.smooth;
  result.provenance = path.provenance;
  result.appearance = path.appearance;
  return result;
}

Path FirstShapes(const Path& path, int count) {
  if (count < 1 || count > path.NumShapes()) {
    throw InvalidOptions(
        "count", "must be 1 to " + std::to_string(path.NumShapes()) + ", the number of shapes");
  }
  std::vector<int> indices(count);
  std::iota(indices.begin(), indices.end(), 0);
  return SelectShapes(path, indices);
}

}  // namespace shapespace
