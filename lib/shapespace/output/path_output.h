#ifndef SHAPESPACE_OUTPUT_PATH_OUTPUT_H_
#define SHAPESPACE_OUTPUT_PATH_OUTPUT_H_

#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/shape.h>
#include <shapespace/output/gltf.h>
#include <shapespace/output/picture.h>
#include <shapespace/output/usd.h>
#include <shapespace/path/path.h>

namespace shapespace {

/// A file for a path, or a pattern of names for one file per shape.
struct PathOutput {
  enum class Kind {
    kPath,        ///< .path: the complete result
    kFilmStrip,   ///< .png
    kPictures,    ///< a pattern of .png, one for each shape, as for frames
    kFilm,        ///< .gif or .apng, a moving picture
    kGltf,        ///< .glb, an animation
    kPointCache,  ///< .pc2 or .mdd
    kFrames,      ///< a pattern of meshes (`FrameName`): .obj, .ply, .off or .stl
    kLastShape,   ///< one such mesh
    kVtk,         ///< a pattern of .vtp, for ParaView
    kUsd,         ///< .usda, an animation
    kPage,        ///< .html, for browsers
  };

  std::string file;
  Kind kind;

  /// The kind is that of the name's extension. A name of a mesh without '%' stands for the last
  /// shape if `last_shape_alone`, and is refused otherwise.
  /// \throw FileError for another extension, or if '%d' is missing or where it does not belong.
  static PathOutput Of(const std::string& file, bool last_shape_alone = false);
};

/// What vertices are coloured by, in film strips, glTF, USD and frames.
enum class PathColours {
  kPlain,      ///< the path's own appearance; in film strips, the roles of shapes
  kDeviation,  ///< of edge lengths (`EdgeDeviation`)
  kParts,      ///< regions that move nearly rigidly
};

struct PathOutputOptions {
  PathColours colours = PathColours::kPlain;
  Shape reference;        ///< for deviations, in the metric's unit; empty: the path's first shape
  Eigen::VectorXi parts;  ///< of each vertex, for `kParts`; empty: `FindRigidParts` of the path

  /// Of film strips. Roles and labels that are empty are those of the path: given, inserted or
  /// extrapolated, and number and parameter.
  FilmStripOptions film_strip;

  /// `frame_width` of films and of pictures of single shapes, 16 .. 2048, which are drawn with the
  /// options of film strips otherwise, and have no labels unless they are given.
  int film_width = 480;

  /// Films are played by the same `duration`, `fps`, `playback` and `ease`.
  GltfOptions gltf;
  double point_cache_fps = 24;
  UsdOptions usd;             ///< but colours, which are those of `colours`
  std::string page_template;  ///< of pages, as in output/page.h; `up` and `view` are those of
                              ///< `film_strip`
};

struct PathOutputSummary {
  GltfSummary gltf;                   ///< of a .glb
  double colour_end = 0;              ///< the deviation that has the last colour: frames, glTF, USD
  std::vector<std::string> warnings;  ///< sentences: what of the appearance the file does not hold
};

/// Options of the film strip of a path: roles and labels of its shapes.
FilmStripOptions FilmStripOf(const Path& path);

/// Writes the path. Each file is written completely or not at all. All pictures of a film, and all
/// of single shapes, show the same part of the world from one camera. A film has 25 pictures a
/// second, of the path at these times (`Resample`), or fewer where they would be more than 600.
/// \throw InvalidOptions, FileError, MeshError as the functions that write each kind.
PathOutputSummary WritePathOutput(const PathOutput& output, const Path& path,
                                  const PathOutputOptions& options = {});

}  // namespace shapespace

#endif  // SHAPESPACE_OUTPUT_PATH_OUTPUT_H_
