#ifndef SHAPESPACE_OUTPUT_INTERNAL_OPTION_FIELDS_H_
#define SHAPESPACE_OUTPUT_INTERNAL_OPTION_FIELDS_H_

#include <shapespace/base/internal/fields.h>
#include <shapespace/output/gltf.h>
#include <shapespace/output/path_output.h>
#include <shapespace/output/picture.h>

// The fields of options, and the words of enumerations (base/internal/fields.h).

namespace shapespace::internal {

inline Words<GltfPlayback> WordsOf(Of<GltfPlayback>) {
  return {{"auto", GltfPlayback::kAutomatic},
          {"there_and_back", GltfPlayback::kThereAndBack},
          {"loop", GltfPlayback::kLoop},
          {"once", GltfPlayback::kOnce}};
}

inline Words<PathColours> WordsOf(Of<PathColours>) {
  return {{"plain", PathColours::kPlain},
          {"deviation", PathColours::kDeviation},
          {"parts", PathColours::kParts}};
}

template <typename Visit>
void ForOptions(Of<FilmStripOptions>, const Visit& visit) {
  visit("frame_width", &FilmStripOptions::frame_width,
        "Longer side of the largest shape's cell, in pixels.");
  visit("max_frames", &FilmStripOptions::max_frames, "Longer paths are subsampled, evenly.");
  visit("columns", &FilmStripOptions::columns,
        "Shapes in a row; 0: as many as fit into six times the width.");
  visit("samples", &FilmStripOptions::samples, "Per pixel and axis.");
  visit("view", &FilmStripOptions::view, "Where the eye is, seen from the body; zero: chosen.");
  visit("up", &FilmStripOptions::up, "What points up in the picture; zero: +y or +z.");
  visit(
      "ground_line", &FilmStripOptions::ground_line,
      "Height along `up` of a ground line, over which shapes are drawn where they are; none: each "
      "is centred in its cell.");
  visit("values", &FilmStripOptions::values,
        "Values of every shape's vertices (.01 is one per cent), shown as colour.");
  visit("legend", &FilmStripOptions::legend, "What the values or groups are.");
  visit("groups", &FilmStripOptions::groups,
        "Group of each vertex, shown as a colour each; negative: none.");
  visit("marks", &FilmStripOptions::marks, "Mark of each vertex: 1 dark, 2 red, else none.");
  visit("numbers", &FilmStripOptions::numbers,
        "Number of each vertex, written beside it where it is seen; 0: none.");
  visit("labels", &FilmStripOptions::labels, "Written under each shape.");
  visit("title", &FilmStripOptions::title, "A line above all.");
}

template <typename Visit>
void ForOptions(Of<GltfOptions>, const Visit& visit) {
  visit("duration", &GltfOptions::duration, "Seconds, holds included.");
  visit("fps", &GltfOptions::fps, "Shapes of the path a second, instead of the duration; 0: off.");
  visit("playback", &GltfOptions::playback,
        "There and back, around, or once; auto: around if the motion ends where it begins, else "
        "there and back.");
  visit("ease", &GltfOptions::ease, "Slow at both ends.");
  visit("unit", &GltfOptions::unit, "Metres in one of the shapes' units; .001: millimetres.");
  visit("groups", &GltfOptions::groups, "Group of each vertex: a colour each; negative: none.");
  visit("allow_outside_files", &GltfOptions::allow_outside_files,
        "Take material libraries and textures from outside of the folder of the file that names "
        "them too: for files that are trusted.");
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_INTERNAL_OPTION_FIELDS_H_
