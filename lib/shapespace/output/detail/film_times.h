#ifndef SHAPESPACE_OUTPUT_DETAIL_FILM_TIMES_H_
#define SHAPESPACE_OUTPUT_DETAIL_FILM_TIMES_H_

#include <vector>

#include <shapespace/output/gltf.h>
#include <shapespace/path/path.h>

namespace shapespace::internal {

/// The times at which a film shows a path.
struct FilmTimes {
  std::vector<double> parameters;  ///< of the path's shapes that are shown, ascending
  std::vector<int> order;          ///< in which they are shown: numbers of `parameters`
  double seconds = 0;              ///< for which each is shown
};

/// Plays the path as a .glb does. There are 25 pictures a second, or fewer if they would be more
/// than 600 in all. A path of one shape is one picture. `path` is valid.
FilmTimes ChooseFilmTimes(const Path& path, const GltfOptions& options);

/// The number of the parameter that is nearest; `parameters` ascend.
int NearestParameter(const std::vector<double>& parameters, double parameter);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_DETAIL_FILM_TIMES_H_
