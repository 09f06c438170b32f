#include <shapespace/output/usd.h>

#include <cmath>
#include <regex>
#include <sstream>

#include <shapespace/base/error.h>
#include <shapespace/output/path_output.h>
#include <shapespace/output/vertex_colours.h>

#include "mesh/bodies.h"
#include "mesh/files.h"
#include "support/message_of.h"
#include "support/path_of.h"

namespace shapespace {
namespace {

using testing::ExpectError;
using testing::MessageOf;
using testing::Names;

/// The attributes of a .usda, each of which begins on a line of its own.
class Usda {
 public:
  explicit Usda(const std::string& file) : text_(testing::Content(file)) {}

  const std::string& Text() const { return text_; }

  /// All numbers of the value, whose tuples are on one line.
  std::vector<double> Numbers(const std::string& attribute) const {
    const std::string begin = " " + attribute + " = ";
    const size_t at = text_.find(begin);
    EXPECT_NE(at, std::string::npos) << attribute;
    return NumbersOf(text_.substr(at + begin.size(), text_.find('\n', at + 1) - at - begin.size()));
  }

  /// Time codes and the numbers there.
  std::vector<std::pair<double, std::vector<double>>> Samples(const std::string& attribute) const {
    const std::string begin = " " + attribute + ".timeSamples = {\n";
    const size_t at = text_.find(begin);
    EXPECT_NE(at, std::string::npos) << attribute;
    std::istringstream lines(text_.substr(at + begin.size()));
    std::vector<std::pair<double, std::vector<double>>> samples;
    for (std::string line; std::getline(lines, line) && line.find('}') == line.npos;) {
      const size_t colon = line.find(':');
      samples.emplace_back(std::stod(line), NumbersOf(line.substr(colon + 1)));
    }
    return samples;
  }

 private:
  static std::vector<double> NumbersOf(const std::string& value) {
    static const std::regex number("-?[0-9][-+.e0-9]*");
    std::vector<double> numbers;
    for (std::sregex_iterator match(value.begin(), value.end(), number), end; match != end;
         ++match) {
      numbers.push_back(std::stod(match->str()));
    }
    return numbers;
  }

  const std::string text_;
};

Eigen::MatrixXd Columns(const std::vector<double>& numbers, Eigen::Index rows) {
  return Eigen::Map<const Eigen::MatrixXd>(numbers.data(), rows,
                                           static_cast<Eigen::Index>(numbers.size()) / rows);
}

class UsdTest : public testing::FilesTest {
 protected:
  UsdTest() {
    Shape bent = cube_.vertices;
    bent.col(7) << 1.3, 1.2, 2;
    const Shape larger = 2 * cube_.vertices;
    path_ = testing::PathOf(testing::Connected(cube_), {cube_.vertices.array() + 1e6,
                                                        bent.array() + 1e6, larger.array() + 1e6});
    path_.parameters = {1, 1.5, 3};
  }

  const Soup cube_ = testing::Cube();
  shapespace::Path path_;
};

TEST_F(UsdTest, EveryShapeIsASampleAtItsTime) {
  UsdOptions options;
  options.fps = 30;
  options.up = 'z';
  options.unit = 0.001;
  EXPECT_TRUE(WriteUsd(Path("a.usda"), path_, options).empty());
  const Usda file(Path("a.usda"));
  EXPECT_EQ(file.Text().rfind("#usda 1.0\n", 0), 0u);
  EXPECT_EQ(file.Numbers("timeCodesPerSecond"), std::vector<double>{30});
  EXPECT_EQ(file.Numbers("metersPerUnit"), std::vector<double>{0.001});
  EXPECT_EQ(file.Numbers("endTimeCode"), std::vector<double>{2});
  EXPECT_NE(file.Text().find("upAxis = \"Z\""), std::string::npos);
  EXPECT_NE(file.Text().find("subdivisionScheme = \"none\""), std::string::npos);
  EXPECT_EQ(file.Numbers("int[] faceVertexCounts"), std::vector<double>(6, 4));
  EXPECT_EQ(file.Numbers("int[] faceVertexIndices"),
            std::vector<double>(cube_.corners.begin(), cube_.corners.end()));
  const Eigen::Vector3d centre = Columns(file.Numbers("double3 xformOp:translate"), 3).topRows<3>();
  const auto points = file.Samples("point3f[] points"), extents = file.Samples("float3[] extent");
  ASSERT_EQ(points.size(), 3u);
  ASSERT_EQ(extents.size(), 3u);
  const double times[] = {0, 0.5, 2};
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(points[i].first, times[i]);
    EXPECT_EQ(extents[i].first, times[i]);
    const Eigen::MatrixXd read = Columns(points[i].second, 3);
    // A millionth of the size, which single precision does not have a million from the origin.
    EXPECT_LT((read.colwise() + centre - path_.Placed(i)).cwiseAbs().maxCoeff(), 1e-6);
    const Eigen::MatrixXd corners = Columns(extents[i].second, 3);
    EXPECT_EQ(corners.col(0), read.rowwise().minCoeff());
    EXPECT_EQ(corners.col(1), read.rowwise().maxCoeff());
  }
}

TEST_F(UsdTest, TheAppearanceIsKept) {
  Appearance& appearance = path_.appearance;
  appearance.vertex_colours.setConstant(4, 8, 0.5);
  appearance.texture_coordinates = Eigen::Matrix2Xd::Random(2, 5);
  for (int k = 0; k < 24; ++k) appearance.corner_texture.push_back(k % 6 - 1);
  appearance.materials = {{"red"}, std::vector<int>(6, 0)};
  const std::vector<std::string> warnings = WriteUsd(Path("a.usda"), path_);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].rfind("materials are dropped", 0), 0u);
  const Usda file(Path("a.usda"));
  // sRGB 0.5 is 0.2140 in linear light (IEC 61966-2-1).
  for (const double channel : file.Numbers("color3f[] primvars:displayColor")) {
    EXPECT_NEAR(channel, 0.2140, 1e-4);
  }
  EXPECT_EQ(file.Numbers("float[] primvars:displayOpacity"), std::vector<double>(8, 0.5));
  const Eigen::MatrixXd coordinates = Columns(file.Numbers("texCoord2f[] primvars:st"), 2);
  const std::vector<double> indices = file.Numbers("int[] primvars:st:indices");
  ASSERT_EQ(indices.size(), 24u);
  for (int k = 0; k < 24; ++k) {
    const int own = appearance.corner_texture[k];
    const Eigen::Vector2d expected =
        own < 0 ? Eigen::Vector2d::Zero().eval() : appearance.texture_coordinates.col(own).eval();
    EXPECT_LT((coordinates.col(static_cast<int>(indices[k])) - expected).norm(), 1e-6) << k;
  }
}

TEST_F(UsdTest, ColoursOfDeviationsChangeWithTime) {
  PathOutputOptions options;
  options.colours = PathColours::kDeviation;
  const PathOutputSummary summary = WritePathOutput(PathOutput::Of(Path("a.usda")), path_, options);
  EXPECT_EQ(summary.colour_end, ColourByDeviation(path_).scale_end);
  const auto colours = Usda(Path("a.usda")).Samples("color3f[] primvars:displayColor");
  ASSERT_EQ(colours.size(), 3u);
  const Eigen::MatrixXd first = Columns(colours[0].second, 3), bent = Columns(colours[1].second, 3);
  ASSERT_EQ(first.cols(), 8);
  // In the first shape all vertices have the colour of no deviation; in the second, vertex 0 has
  // it, which is far from the moved one.
  EXPECT_EQ(first.colwise() - first.col(0), Eigen::MatrixXd::Zero(3, 8));
  EXPECT_EQ(bent.col(0), first.col(0));
  EXPECT_NE(bent.col(7), first.col(0));
}

TEST_F(UsdTest, APathOfOneShapeHasOneSample) {
  path_.shapes.resize(1);
  path_.motions.resize(1);
  path_.parameters = {5};
  path_.poses = {0};
  WriteUsd(Path("a.usda"), path_);
  const auto points = Usda(Path("a.usda")).Samples("point3f[] points");
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].first, 0);
}

TEST_F(UsdTest, WhatCannotBeWrittenIsRefused) {
  ExpectError<FileError>([&] { WriteUsd(Path("a.usd"), path_); }, {"a.usd", ".usda"});
  UsdOptions options;
  options.fps = 0;
  ExpectError<InvalidOptions>([&] { WriteUsd(Path("a.usda"), path_, options); }, {"fps"});
  options = {};
  options.up = 'x';
  ExpectError<InvalidOptions>([&] { WriteUsd(Path("a.usda"), path_, options); }, {"up"});
  options = {};
  options.colours = {Eigen::MatrixXd::Constant(3, 8, 0.5), Eigen::MatrixXd::Constant(3, 8, 0.5)};
  ExpectError<InvalidOptions>([&] { WriteUsd(Path("a.usda"), path_, options); }, {"colours"});
  options.colours = {Eigen::MatrixXd::Constant(3, 8, 1.5)};
  ExpectError<InvalidOptions>([&] { WriteUsd(Path("a.usda"), path_, options); }, {"colours"});

  Soup graph;
  graph.vertices = cube_.vertices;
  graph.segments = {{0, 1}, {1, 3}, {3, 7}, {7, 4}, {4, 0}};
  const shapespace::Path of_graph =
      testing::PathOf(testing::Connected(graph), {graph.vertices, 2 * graph.vertices});
  ExpectError<MeshError>([&] { WriteUsd(Path("a.usda"), of_graph); }, {"no polygons", ".vtp"});
  EXPECT_FALSE(std::filesystem::exists(Path("a.usda")));
}

TEST_F(UsdTest, ASmallFileIsThisText) {
  const auto mixed = Connectivity::Make(4, {0, 3, 6}, {0, 1, 2, 2, 1, 3}, {{0, 3}});
  Shape shape(3, 4);
  shape << 0, 2, 0, 2, 0, 0, 1, 1, 5, 5, 5, 5;
  shapespace::Path path = testing::PathOf(mixed, {shape, shape});
  const auto metric = std::make_shared<Metric>(*path.metric);
  metric->unit = 1;
  path.metric = metric;
  path.motions[0] = path.motions[1] = RigidMotion();
  path.shapes[0] = path.shapes[1] = shape;
  path.shapes[1](2, 3) = 6.5;
  path.appearance.vertex_colours = Eigen::MatrixXd::Constant(4, 4, 1);
  path.appearance.vertex_colours(0, 1) = 0;
  path.appearance.vertex_colours(3, 2) = 0.5;
  path.appearance.texture_coordinates = (Eigen::Matrix2Xd(2, 2) << 0, 0.5, 1, 0.25).finished();
  path.appearance.corner_texture = {0, 1, -1, -1, 1, 0};
  path.appearance.materials = {{"red"}, {0, 0}};
  path.appearance.groups = {{"left"}, {0, -1}};
  path.appearance.objects = {{"body"}, {0, 0}};
  UsdOptions options;
  options.fps = 12.5;
  options.unit = 0.01;
  EXPECT_EQ(WriteUsd(Path("a.usda"), path, options),
            std::vector<std::string>{
                "materials, groups, objects, segments are dropped; frames in OBJ keep them"});
  EXPECT_EQ(testing::Content(Path("a.usda")), R"(#usda 1.0
(
    defaultPrim = "body"
    startTimeCode = 0
    endTimeCode = 1
    timeCodesPerSecond = 12.5
    framesPerSecond = 12.5
    metersPerUnit = 0.01
    upAxis = "Y"
)

def Xform "body"
{
    double3 xformOp:translate = (1, 0.5, 5)
    uniform token[] xformOpOrder = ["xformOp:translate"]

    def Mesh "mesh"
    {
        uniform token subdivisionScheme = "none"
        uniform token orientation = "rightHanded"
        int[] faceVertexCounts = [3, 3]
        int[] faceVertexIndices = [0, 1, 2, 2, 1, 3]
        float3[] extent.timeSamples = {
            0: [(-1, -0.5, 0), (1, 0.5, 0)],
            1: [(-1, -0.5, 0), (1, 0.5, 1.5)],
        }
        point3f[] points.timeSamples = {
            0: [(-1, -0.5, 0), (1, -0.5, 0), (-1, 0.5, 0), (1, 0.5, 0)],
            1: [(-1, -0.5, 0), (1, -0.5, 0), (-1, 0.5, 0), (1, 0.5, 1.5)],
        }
        color3f[] primvars:displayColor = [(1, 1, 1), (0, 1, 1), (1, 1, 1), (1, 1, 1)] (
            interpolation = "vertex"
        )
        float[] primvars:displayOpacity = [1, 1, 0.5, 1] (
            interpolation = "vertex"
        )
        texCoord2f[] primvars:st = [(0, 1), (0.5, 0.25), (0, 0)] (
            interpolation = "faceVarying"
        )
        int[] primvars:st:indices = [0, 1, 2, 2, 1, 0]
    }
}
)");
  options.colours = {Eigen::MatrixXd::Constant(3, 4, 1)};
  EXPECT_EQ(
      WriteUsd(Path("b.usda"), path, options),
      std::vector<std::string>{"groups, objects, segments are dropped; frames in OBJ keep them"});
  const std::string text = testing::Content(Path("b.usda"));
  EXPECT_EQ(text.find("primvars:st"), std::string::npos);
  EXPECT_EQ(text.find("displayOpacity"), std::string::npos);
  EXPECT_EQ(text.find("displayColor.timeSamples"), std::string::npos);
}

TEST_F(UsdTest, MessagesNameTheOption) {
  const auto message = [&](const std::function<void(UsdOptions*)>& change) {
    UsdOptions options;
    change(&options);
    return MessageOf<InvalidOptions>([&] { WriteUsd(Path("a.usda"), path_, options); });
  };
  using O = UsdOptions;
  EXPECT_EQ(message([](O* o) { o->fps = 1001; }).rfind("fps: must be from 0.01 to 1000", 0), 0u);
  EXPECT_TRUE(Names(message([](O* o) { o->up = 'Z'; }), {"up:", "'y'", "'z'"}));
  EXPECT_EQ(message([](O* o) { o->unit = 0; }).rfind("unit: must be from 1e-12 to 1e+12", 0), 0u);
  const std::string numbers = "colours: must be 3 numbers from 0 to 1 for every vertex";
  EXPECT_EQ(message([](O* o) { o->colours = {Eigen::MatrixXd::Zero(4, 8)}; }), numbers);
  EXPECT_EQ(message([](O* o) { o->colours = {Eigen::MatrixXd::Zero(3, 7)}; }), numbers);
  EXPECT_EQ(message([](O* o) { o->colours = {Eigen::MatrixXd::Constant(3, 8, -0.1)}; }), numbers);
  EXPECT_EQ(message([](O* o) { o->colours.assign(3, Eigen::MatrixXd::Constant(3, 8, 2)); }),
            numbers);
  EXPECT_TRUE(Names(message([](O* o) { o->colours.assign(2, Eigen::MatrixXd::Zero(3, 8)); }),
                    {"colours:"}));
}

}  // namespace
}  // namespace shapespace
