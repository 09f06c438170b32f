#include <shapespace/output/path_output.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/files/read.h>
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
  for (const auto& [name, words] : {std::make_pair("walk.mp4", "must end in .path"),
                                    {"walk", "must end in .path"},
                                    {"walk.obj", "needs one number"},
                                    {"walk%d%d.vtp", "needs one number"},
                                    {"walk%03d.png", "one .png contains the whole path"}}) {
    const std::string message = testing::MessageOf<FileError>([&] { PathOutput::Of(name); });
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

}  // namespace
}  // namespace shapespace
