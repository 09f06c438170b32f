#include <shapespace/output/path_output.h>

#include <filesystem>

#include <shapespace/analysis/quality.h>
#include <shapespace/analysis/rigid_parts.h>
#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/files/point_cache.h>
#include <shapespace/files/read.h>
#include <shapespace/files/write.h>
#include <shapespace/output/film.h>
#include <shapespace/output/frames.h>
#include <shapespace/output/vertex_colours.h>
#include <shapespace/output/vtk.h>
#include <shapespace/path/path_file.h>

#include "mesh/files.h"
#include "support/message_of.h"
#include "support/path_of.h"

namespace shapespace {
namespace {

class PathOutputTest : public testing::FilesTest {
 protected:
  const ShapeFamily bar_ = MakeBar(4, 1, 1, 3, 1, 1);
  const shapespace::Path path_ =
      testing::PathOf(bar_.connectivity, {bar_.pose(0), bar_.pose(20), bar_.pose(50)});
};

TEST_F(PathOutputTest, NamesThatStandForNothingAreRefused) {
  for (const auto& [name, words] : {std::make_pair("walk.mp4", "ffmpeg"),
                                    {"walk.jpg", "must end in .path"},
                                    {"walk", "must end in .path"},
                                    {"walk.obj", "needs one number"},
                                    {"walk%d%d.vtp", "needs one number"},
                                    {"walk%d%d.png", "needs one number"},
                                    {"walk%03d.gif", "one .gif contains the whole path"}}) {
    const std::string message =
        testing::MessageOf<FileError>([&, name = name] { PathOutput::Of(name); });
    EXPECT_NE(message.find(words), std::string::npos) << name << ": " << message;
  }
  EXPECT_EQ(PathOutput::Of("100%.png").kind, PathOutput::Kind::kFilmStrip);
}

// What can be read back is the path's shapes.
TEST_F(PathOutputTest, FilesHaveTheShapesOfThePath) {
  WritePathOutput(PathOutput::Of(Path("bar.path")), path_);
  EXPECT_EQ(ReadPath(Path("bar.path")).shapes, path_.shapes);
  WritePathOutput(PathOutput::Of(Path("bar%d.PLY")), path_);
  for (int i = 0; i < path_.NumShapes(); ++i) {
    const Poses frame = ReadPoses({Path("bar" + std::to_string(i) + ".PLY")});
    EXPECT_EQ(frame.shapes[0], path_.Placed(i));
  }
  WritePathOutput(PathOutput::Of(Path("bar.off"), true), path_);
  EXPECT_EQ(ReadPoses({Path("bar.off")}).shapes[0], path_.Placed(path_.NumShapes() - 1));
}

// Colours are measured from the reference, so that a path that begins in the middle of another one
// can have the colours of the whole.
TEST_F(PathOutputTest, DeviationsAreFromTheReference) {
  shapespace::Path later = path_;
  later.shapes.erase(later.shapes.begin());
  later.motions.erase(later.motions.begin());
  later.parameters = {0, 1};
  later.poses = {0, 1};
  PathOutputOptions options;
  options.colours = PathColours::kDeviation;
  const auto scale_end = [&](const shapespace::Path& path) {
    return WritePathOutput(PathOutput::Of(Path("bar%d.obj")), path, options).colour_end;
  };
  const double whole = scale_end(path_), own = scale_end(later);
  options.reference = path_.shapes[0];
  EXPECT_EQ(scale_end(later), whole);
  EXPECT_LT(own, whole);
}

TEST_F(PathOutputTest, TheKindIsThatOfTheExtension) {
  using Kind = PathOutput::Kind;
  const std::pair<const char*, Kind> cases[] = {
      {"a.path", Kind::kPath},      {"a.PNG", Kind::kFilmStrip},  {"a.glb", Kind::kGltf},
      {"a.pc2", Kind::kPointCache}, {"a.mdd", Kind::kPointCache}, {"a%d.vtp", Kind::kVtk},
      {"a.html", Kind::kPage},      {"a.usda", Kind::kUsd},       {"a%d.obj", Kind::kFrames},
      {"a%03d.ply", Kind::kFrames}, {"a%d.off", Kind::kFrames},   {"a%d.stl", Kind::kFrames}};
  for (const auto& [name, kind] : cases) {
    for (const bool last : {false, true}) {
      EXPECT_EQ(PathOutput::Of(name, last).kind, kind) << name;
      EXPECT_EQ(PathOutput::Of(name, last).file, name);
    }
  }
  for (const char* name : {"a.obj", "a.stl"}) {
    EXPECT_EQ(PathOutput::Of(name, true).kind, Kind::kLastShape) << name;
  }
  const auto message = [](const std::string& name) {
    return testing::MessageOf<FileError>([&] { PathOutput::Of(name, true); });
  };
  EXPECT_TRUE(testing::Names(message("a%d.usda"), {"a%d.usda:", ".vtp", ".usda"}));
  EXPECT_TRUE(
      testing::Names(message("a.txt"), {"a.txt:", ".path", ".png", ".glb", ".usda", ".html", ".pc2",
                                        ".mdd", ".obj", ".ply", ".off", ".stl", ".vtp"}));
  EXPECT_TRUE(testing::Names(message("a.vtp"), {"a.vtp:", "03d.obj"}));
}

TEST_F(PathOutputTest, FilmStripsTellRolesNumbersAndTimes) {
  shapespace::Path path = path_;
  path.shapes.resize(5, path.shapes[0]);
  path.motions.resize(5);
  path.parameters = {0, 0.25, 1, 1.3335, 2};
  path.poses = {0, 2};
  path.extrapolated = 2;
  const FilmStripOptions options = FilmStripOf(path);
  EXPECT_EQ(options.roles,
            (std::vector<ShapeRole>{ShapeRole::kPose, ShapeRole::kInserted, ShapeRole::kPose,
                                    ShapeRole::kExtrapolated, ShapeRole::kExtrapolated}));
  EXPECT_EQ(options.labels, (std::vector<std::string>{"0: t = 0", "1: t = 0.25", "2: t = 1",
                                                      "3: t = 1.33", "4: t = 2"}));
}

TEST_F(PathOutputTest, FilmStripsAreThoseOfTheirOptions) {
  PathOutputOptions options;
  options.film_strip.frame_width = 64;
  options.film_strip.samples = 1;
  const auto written = [&] {
    WritePathOutput(PathOutput::Of(Path("a.png")), path_, options);
    return testing::Content(Path("a.png"));
  };
  FilmStripOptions expected = FilmStripOf(path_);
  expected.frame_width = 64;
  expected.samples = 1;
  const auto drawn = [&] {
    return EncodePng(RenderFilmStrip(*bar_.connectivity, path_.Placed(), expected));
  };
  EXPECT_EQ(written(), drawn());
  options.film_strip.roles =
      expected.roles = {ShapeRole::kInserted, ShapeRole::kPose, ShapeRole::kPose};
  EXPECT_EQ(written(), drawn());
  options.film_strip.labels = expected.labels = {"a", "b", "c"};
  EXPECT_EQ(written(), drawn());
  options.colours = PathColours::kDeviation;
  options.reference = path_.shapes[2];
  for (int i = 0; i < 3; ++i) {
    expected.values.push_back(EdgeDeviation(*path_.metric, path_.shapes[2], path_.shapes[i]));
  }
  expected.legend = "edge length, deviation from the first pose";
  EXPECT_EQ(written(), drawn());
  options.reference.resize(3, 0);
  for (int i = 0; i < 3; ++i) expected.values[i] = EdgeDeviation(path_, i);
  EXPECT_EQ(written(), drawn());
  options.colours = PathColours::kParts;
  options.parts = Eigen::VectorXi::LinSpaced(path_.shapes[0].cols(), -1, 3);
  expected.values.clear();
  expected.groups = options.parts;
  expected.legend = "near-rigid parts, by size";
  EXPECT_EQ(written(), drawn());
  options.parts.resize(0);
  expected.groups = FindRigidParts(path_).of_vertex;
  EXPECT_EQ(written(), drawn());
}

// All shapes are seen in one frame, and the first and the last have the colour of poses.
TEST_F(PathOutputTest, PicturesOfShapesAreThoseOfAFilmWithTheirRoles) {
  PathOutputOptions options;
  options.film_width = 90;
  WritePathOutput(PathOutput::Of(Path("bar%02d.png")), path_, options);
  FilmStripOptions drawn;
  drawn.frame_width = 90;
  drawn.roles = {ShapeRole::kPose, ShapeRole::kInserted, ShapeRole::kPose};
  const std::vector<RgbImage> pictures = RenderFilm(*bar_.connectivity, path_.Placed(), drawn);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(testing::Content(Path("bar0" + std::to_string(i) + ".png")), EncodePng(pictures[i]));
  }
  EXPECT_FALSE(std::filesystem::exists(Path("bar03.png")));
}

TEST_F(PathOutputTest, AFilmShowsThePathBetweenItsShapesToo) {
  PathOutputOptions options;
  options.film_width = 60;
  options.gltf.duration = 0.2;  // five pictures
  options.gltf.playback = GltfPlayback::kLoop;
  WritePathOutput(PathOutput::Of(Path("bar.gif")), path_, options);
  WritePathOutput(PathOutput::Of(Path("bar.apng")), path_, options);
  FilmStripOptions drawn;
  drawn.frame_width = 60;
  // At .2 and .4 of the path; the shape in the middle is the nearest from .25 to .75.
  drawn.roles = {ShapeRole::kPose, ShapeRole::kPose, ShapeRole::kInserted, ShapeRole::kInserted,
                 ShapeRole::kPose};
  Film film;
  film.pictures =
      RenderFilm(*bar_.connectivity, Resample(path_, {0, .2, .4, .6, .8}).Placed(), drawn);
  film.order = {0, 1, 2, 3, 4};
  film.seconds.assign(5, .04);
  EXPECT_EQ(testing::Content(Path("bar.gif")), EncodeGif(film));
  EXPECT_EQ(testing::Content(Path("bar.apng")), EncodeApng(film));
  options.gltf.duration = 0;
  EXPECT_NE(testing::MessageOf<InvalidOptions>([&] {
              WritePathOutput(PathOutput::Of(Path("none.gif")), path_, options);
            }).find("duration"),
            std::string::npos);
  options.gltf.duration = 0.2;
  shapespace::Path nothing;
  nothing.metric = path_.metric;
  EXPECT_THROW(WritePathOutput(PathOutput::Of(Path("none.gif")), nothing, options), MeshError);
  EXPECT_FALSE(std::filesystem::exists(Path("none.gif")));
  options.gltf.playback = GltfPlayback::kOnce;
  WritePathOutput(PathOutput::Of(Path("once.gif")), path_, options);
  EXPECT_EQ(testing::Content(Path("once.gif")).find("NETSCAPE"), std::string::npos);
}

TEST_F(PathOutputTest, MeshesAndAnimationsHaveTheColoursThatAreAskedFor) {
  PathOutputOptions options;
  options.colours = PathColours::kDeviation;
  options.reference = path_.shapes[1];
  const ValueColours deviation = ColourByDeviation(path_, path_.shapes[1]);
  EXPECT_EQ(WritePathOutput(PathOutput::Of(Path("a.glb")), path_, options).colour_end, [&] {
    GltfOptions own;
    own.colour_by_deviation = true;
    own.reference = path_.shapes[1];
    return WriteGltf(Path("b.glb"), path_, own).colour_end;
  }());
  EXPECT_EQ(testing::Content(Path("a.glb")), testing::Content(Path("b.glb")));
  const PathOutputSummary last =
      WritePathOutput(PathOutput::Of(Path("last.ply"), true), path_, options);
  EXPECT_EQ(last.colour_end, deviation.scale_end);
  EXPECT_EQ(ReadSoup(Path("last.ply")).appearance.vertex_colours, deviation.of_shapes[2]);
  options.colours = PathColours::kParts;
  options.parts = Eigen::VectorXi::LinSpaced(path_.shapes[0].cols(), -1, 3);
  WritePathOutput(PathOutput::Of(Path("f%d.ply")), path_, options);
  for (int i = 0; i < 3; ++i) {
    const Soup frame = ReadSoup(Path("f" + std::to_string(i) + ".ply"));
    EXPECT_EQ(frame.appearance.vertex_colours, ColourByGroup(options.parts)) << i;
  }
  WritePathOutput(PathOutput::Of(Path("a.glb")), path_, options);
  GltfOptions own;
  own.groups = options.parts;
  WriteGltf(Path("b.glb"), path_, own);
  EXPECT_EQ(testing::Content(Path("a.glb")), testing::Content(Path("b.glb")));
  options.point_cache_fps = 50;
  WritePathOutput(PathOutput::Of(Path("a.mdd")), path_, options);
  WritePointCache(Path("b.mdd"), path_.Placed(), 50);
  EXPECT_EQ(testing::Content(Path("a.mdd")), testing::Content(Path("b.mdd")));
  options.reference = path_.shapes[2];
  WritePathOutput(PathOutput::Of(Path("a%d.vtp")), path_, options);
  WriteVtkSeries(Path("b%d.vtp"), path_, path_.shapes[2]);
  EXPECT_EQ(testing::Content(Path("a1.vtp")), testing::Content(Path("b1.vtp")));
  options.page_template = "<p><!-- scenes --></p>";
  WritePathOutput(PathOutput::Of(Path("some.walk.html")), path_, options);
  EXPECT_NE(testing::Content(Path("some.walk.html")).find("data-name=\"some.walk\""),
            std::string::npos);
}

TEST_F(PathOutputTest, WhatAFileDoesNotHoldIsTold) {
  shapespace::Path path = path_;
  const int polygons = bar_.connectivity->NumPolygons();
  path.appearance.materials = {{"red"}, std::vector<int>(polygons, 0)};
  path.appearance.groups = {{"left"}, std::vector<int>(polygons, 0)};
  PathOutputOptions options;
  const auto warnings = [&](const std::string& name) {
    return WritePathOutput(PathOutput::Of(Path(name), true), path, options).warnings;
  };
  const auto expected = [&](const std::string& name, const Eigen::MatrixXd& colours) {
    Soup soup = FrameSoup(*bar_.connectivity, path.appearance);
    if (colours.size() > 0) soup = Coloured(soup, colours);
    return NotKept(Path(name), soup);
  };
  EXPECT_TRUE(warnings("a%d.obj").empty());
  EXPECT_EQ(warnings("a%d.ply"), expected("a%d.ply", {}));
  EXPECT_EQ(warnings("last.stl"), expected("last.stl", {}));
  ASSERT_EQ(warnings("last.stl").size(), 1u);
  options.colours = PathColours::kDeviation;
  EXPECT_EQ(warnings("b.stl"), expected("b.stl", Eigen::MatrixXd::Ones(3, path.shapes[0].cols())));
  EXPECT_NE(warnings("b.stl"), expected("b.stl", {}));
  options.colours = PathColours::kPlain;
  EXPECT_EQ(warnings("a.usda"),
            std::vector<std::string>{"materials, groups are dropped; frames in OBJ keep them"});
  // A library that is missing.
  path.appearance.material_libraries = {"none.mtl"};
  EXPECT_EQ(warnings("a.glb").size(), 2u);
}

}  // namespace
}  // namespace shapespace
