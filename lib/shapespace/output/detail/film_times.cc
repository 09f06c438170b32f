#include <shapespace/output/detail/film_times.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include <shapespace/output/detail/playback.h>

namespace shapespace::internal {
namespace {

constexpr double kPicturesPerSecond = 25;
constexpr int kMostPictures = 600;

// Shares of the path that differ by less than this are shown by one picture, so that the way back
// repeats the pictures of the way there.
constexpr double kShareSteps = 1e6;

double ShareAt(const std::vector<std::pair<double, double>>& moments, double time) {
  const auto after = std::lower_bound(
      moments.begin(), moments.end(), time,
      [](const std::pair<double, double>& moment, double t) { return moment.first < t; });
  if (after == moments.begin()) return after->second;
  const auto before = after - 1;
  const double part = (time - before->first) / (after->first - before->first);
  return before->second + part * (after->second - before->second);
}

}  // namespace

FilmTimes ChooseFilmTimes(const Path& path, const GltfOptions& given) {
  const double first = path.parameters.front(), length = path.parameters.back() - first;
  if (path.NumShapes() == 1) return {{first}, {0}, given.duration};
  GltfOptions options = given;
  options.playback = DecidePlayback(given.playback, path.NumShapes(), path.Placed(0),
                                    path.Placed(path.NumShapes() - 1));
  std::vector<double> shares;
  for (const double parameter : path.parameters) shares.push_back((parameter - first) / length);
  const auto moments = PlaybackMoments(shares, path.NumShapes(), options);
  const double duration = moments.back().first;
  const int pictures =
      std::clamp(static_cast<int>(std::lround(kPicturesPerSecond * duration)), 1, kMostPictures);
  FilmTimes times;
  times.seconds = duration / pictures;
  std::vector<std::int64_t> steps;
  std::map<std::int64_t, int> numbers;
  for (int i = 0; i < pictures; ++i) {
    steps.push_back(std::llround(kShareSteps * ShareAt(moments, i * times.seconds)));
    numbers[steps.back()];
  }
  for (auto& [step, number] : numbers) {
    number = static_cast<int>(times.parameters.size());
    times.parameters.push_back(std::min(
        path.parameters.back(), first + length * (static_cast<double>(step) / kShareSteps)));
  }
  for (const std::int64_t step : steps) times.order.push_back(numbers.at(step));
  return times;
}

int NearestParameter(const std::vector<double>& parameters, double parameter) {
  const auto after = std::lower_bound(parameters.begin(), parameters.end(), parameter);
  if (after == parameters.begin()) return 0;
  const int number = static_cast<int>(after - parameters.begin());
  if (after == parameters.end()) return number - 1;
  return parameter - *(after - 1) < *after - parameter ? number - 1 : number;
}

}  // namespace shapespace::internal
