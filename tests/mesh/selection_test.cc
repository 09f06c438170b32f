#include <shapespace/mesh/selection.h>

#include <cmath>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>

#include "mesh/bodies.h"
#include "support/message_of.h"
#include "support/paths.h"

namespace shapespace {
namespace {

using testing::MessageOf;
using Vertices = std::vector<int>;

/// The unit cube; vertex x + 2 y + 4 z lies at (x, y, z). Its bottom has two groups, its top one,
/// and the side x = 1 is an object.
class SelectionTest : public ::testing::Test {
 protected:
  SelectionTest() : cube_(testing::Cube()), connectivity_(testing::Connected(cube_)) {
    appearance_.groups = {{"body bottom", "left ear"}, {0, 1, -1, -1, -1, -1}};
    appearance_.objects = {{"wall"}, {-1, -1, -1, -1, -1, 0}};
  }

  Vertices In(const std::string& text) const {
    return SelectVertices(ReadSelection(text), cube_.vertices, *connectivity_, appearance_);
  }

  void ExpectError(const std::string& text, const std::string& part) const {
    const std::string message = MessageOf<InvalidOptions>([&] { In(text); });
    EXPECT_NE(message.find(part), std::string::npos) << "no '" << part << "' in: " << message;
  }

  const Soup cube_;
  const std::shared_ptr<const Connectivity> connectivity_;
  Appearance appearance_;
};

TEST_F(SelectionTest, VerticesAreCountedFrom1AndGivenFrom0EachOnceAndRising) {
  EXPECT_EQ(In(R"({"vertices": [8, [2, 4], 1, 3]})"), (Vertices{0, 1, 2, 3, 7}));
  EXPECT_EQ(In(R"({"vertices": [[5, 5]]})"), (Vertices{4}));
}

TEST_F(SelectionTest, BoundariesBelongToBallsBoxesAndHalfSpaces) {
  EXPECT_EQ(In(R"({"ball": {"centre": [0, 0, 0], "radius": 1}})"), (Vertices{0, 1, 2, 4}));
  EXPECT_EQ(In(R"({"ball": {"center": [1, 1, 1], "radius": 0}})"), (Vertices{7}));
  EXPECT_EQ(In(R"({"box": {"low": [0, 0, 0.5], "high": [0.5, 1, 1]}})"), (Vertices{4, 6}));
  EXPECT_EQ(In(R"({"halfspace": {"point": [9, 1, 9], "normal": [0, 3, 0]}})"),
            (Vertices{2, 3, 6, 7}));
  EXPECT_EQ(In(R"({"halfspace": {"point": [9, 0, 9], "normal": [0, -1e-200, 0]}})"),
            (Vertices{0, 1, 4, 5}));
}

TEST_F(SelectionTest, RoundingPushesNothingOverABoundary) {
  const Shape rounded = cube_.vertices + testing::Noise(8, 1e-12, 1);
  for (const char* text : {R"({"halfspace": {"point": [0, 1, 0], "normal": [0, 1, 0]}})",
                           R"({"halfspace": {"point": [0, 0, 0], "normal": [0, -1, 0]}})",
                           R"({"ball": {"centre": [0, 0, 0], "radius": 1}})",
                           R"({"box": {"low": [0, 0, 0], "high": [1, 0, 1]}})"}) {
    EXPECT_EQ(SelectVertices(ReadSelection(text), rounded, *connectivity_, appearance_), In(text))
        << text;
  }
}

TEST_F(SelectionTest, GroupsAndObjectsAreFoundByAllTheirNamesOrByOne) {
  EXPECT_EQ(In(R"({"group": "bottom"})"), (Vertices{0, 1, 2, 3}));
  EXPECT_EQ(In(R"({"group": "body bottom"})"), (Vertices{0, 1, 2, 3}));
  EXPECT_EQ(In(R"({"group": "ear"})"), (Vertices{4, 5, 6, 7}));
  EXPECT_EQ(In(R"({"group": "wall"})"), (Vertices{1, 3, 5, 7}));
  ExpectError(R"({"group": "bott"})",
              "group: no polygon has the group or object 'bott'; this mesh has 'body bottom', "
              "'left ear', 'wall'");
  EXPECT_NE(MessageOf<InvalidOptions>([&] {
              SelectVertices(ReadSelection(R"({"group": "ear"})"), cube_.vertices, *connectivity_,
                             {});
            }).find("this mesh has none at all"),
            std::string::npos);
}

TEST_F(SelectionTest, KeysOfOneSelectionIntersectAndThoseInAnyUnite) {
  EXPECT_EQ(In(R"({"group": "wall", "box": {"low": [0, 0, 0], "high": [1, 1, 0]}})"),
            (Vertices{1, 3}));
  EXPECT_EQ(In(R"({"any": [{"group": "bottom"}, {"vertices": [8]}, {"vertices": [1]}]})"),
            (Vertices{0, 1, 2, 3, 7}));
  EXPECT_EQ(In(R"({"any": [{"group": "bottom"}, {"vertices": [8]}], "group": "wall"})"),
            (Vertices{1, 3, 7}));
  EXPECT_EQ(In(R"({"any": [{"any": [{"vertices": [3]}]}, {"vertices": [2]}]})"), (Vertices{1, 2}));
}

TEST_F(SelectionTest, ASelectionOfNothingNamesItselfAndWhereTheShapeIs) {
  ExpectError(R"({"ball": {"centre": [5, 5, 5], "radius": 2}})",
              R"(no vertex is in {"ball":{"centre":[5.0,5.0,5.0],"radius":2.0}}; the shape lies )"
              "between [0, 0, 0] and [1, 1, 1]");
  ExpectError(R"({"vertices": [1], "group": "wall"})", R"(for any of them write {"any": [...]})");
  ExpectError(R"({"any": [{"vertices": [1]}, {"ball": {"centre": [5, 5, 5], "radius": 2}}]})",
              "any (selection 2): no vertex is in");
}

TEST_F(SelectionTest, ErrorsNameTheField) {
  const struct {
    const char *text, *message;
  } cases[] = {
      {"", "line 1: this is not valid JSON: "},
      {"{\"vertices\":\n[1,]}", "line 2: this is not valid JSON: "},
      {"{\"ball\": {\"radius\":\n1e999\n}}", "line 2: this is not valid JSON: number overflow"},
      {R"({"group": nan})", "line 1: this is not valid JSON: "},
      {"{\"group\": \"a\",\n\"group\": \"b\"}", "line 2: the key 'group' occurs twice"},
      {"[1, 2]", "must be an object, { }, with keys of vertices, ball, box, halfspace, group, any"},
      {"{}", "is empty"},
      {R"({"any": [{}]})", "any (selection 1): is empty"},
      {R"({"any": []})", "any: the list is empty"},
      {R"({"any": {"vertices": [1]}})", "any: must be a list, [ ]; this is of type object"},
      {R"({"sphere": 1})",
       "unknown key 'sphere'; the keys here are vertices, ball, box, halfspace, group, any"},
      {R"({"ball": {"centre": [0, 0, 0]}})", "ball.radius: is missing"},
      {R"({"ball": {"centre": [0, 0, 0], "center": [0, 0, 0], "radius": 1}})", "ball.center: "},
      {R"({"ball": {"radius": 1}})", "ball.centre: is missing"},
      {R"({"ball": 3})", "ball: must be an object, { }, with keys of centre, center, radius"},
      {R"({"ball": {"centre": [0, 0], "radius": 1}})", "ball.centre: must be three numbers"},
      {R"({"ball": {"centre": [0, 0, "0"], "radius": 1}})", "ball.centre: must be three numbers"},
      {R"({"ball": {"centre": [0, 1e61, 0], "radius": 1}})",
       "ball.centre: must be from -1e+60 to 1e+60"},
      {R"({"ball": {"centre": [0, 0, 0], "radius": "1"}})",
       "ball.radius: must be a number; this is of type string"},
      {R"({"ball": {"centre": [0, 0, 0], "radius": -1}})", "ball.radius: must be zero or more"},
      {R"({"box": {"low": [0, 2, 0], "high": [1, 1, 1]}})",
       "box: its low y is above its high one; swap them"},
      {R"({"box": {"low": [0, 0, 0]}})", "box.high: is missing"},
      {R"({"halfspace": {"point": [0, 0, 0], "normal": [0, 0, 0]}})",
       "halfspace.normal: must not be zero"},
      {R"({"halfspace": {"normal": [0, 0, 1]}})", "halfspace.point: is missing"},
      {R"({"group": 3})", "group: must be a text in quotation marks; this is of type number"},
      {R"({"vertices": 3})", "vertices: must be a list, [ ]; this is of type number"},
      {R"({"vertices": []})", "vertices: the list is empty"},
      {R"({"vertices": [0]})",
       "vertices: 0 is not a vertex number; the first vertex has the number"},
      {R"({"vertices": [-4]})", "vertices: -4 is not a vertex number"},
      {R"({"vertices": [5000000000]})", "vertices: 5000000000 is not a vertex number"},
      {R"({"vertices": [1.5]})", "vertices: must hold vertex numbers and ranges of them"},
      {R"({"vertices": ["1"]})", "vertices: must hold vertex numbers and ranges of them"},
      {R"({"vertices": [[1, 2, 3]]})", "vertices: a range is two vertex numbers"},
      {R"({"vertices": [[3, 2]]})", "vertices: the range [3, 2] ends before it begins"},
      {R"({"vertices": [9]})", "vertices: 9 is not a vertex of this mesh, which has 8"},
      {R"({"vertices": [[1, 2147483647]]})", "vertices: 2147483647 is not a vertex of this mesh"},
      {R"({"any": [{"vertices": [1]}, {"ball": {"centre": [0, 0, 0], "radius": -1}}]})",
       "any (selection 2).ball.radius: must be zero or more"},
  };
  for (const auto& [text, message] : cases) {
    SCOPED_TRACE(text);
    ExpectError(text, message);
  }
}

TEST_F(SelectionTest, DeepNestingIsRefused) {
  std::string text = R"({"vertices": [1]})";
  for (int i = 0; i < 10000; ++i) text = R"({"any": [)" + text + "]}";
  ExpectError(text, "selections inside each other");
}

TEST_F(SelectionTest, TextsReadBackAsTheSelectionTheyWereMadeOf) {
  for (
      const char* text :
      {R"({"vertices":[1,2,[10,20]]})", R"({"ball":{"centre":[0.1,-2.0,1e-30],"radius":2.0}})",
       R"({"box":{"low":[0.0,0.0,0.0],"high":[1.0,2.0,3.0]},"group":"a b"})",
       R"({"any":[{"halfspace":{"point":[0.0,0.0,0.0],"normal":[0.0,1.0,0.0]}},{"group":"c"}]})"}) {
    EXPECT_EQ(ToText(ReadSelection(text)), text);
  }
}

TEST_F(SelectionTest, ASelectionMadeInCodeIsCheckedToo) {
  Selection selection;
  EXPECT_THROW(selection.Validate(), InvalidOptions);
  selection.vertices = {{-1, 2}};
  EXPECT_THROW(selection.Validate(), InvalidOptions);
  selection.vertices = {{0, 2}};
  EXPECT_NO_THROW(selection.Validate());
  selection.ball = Selection::Ball{Eigen::Vector3d(0, std::nan(""), 0), 1};
  EXPECT_THROW(selection.Validate(), InvalidOptions);
  selection.ball = Selection::Ball{Eigen::Vector3d::Zero(), HUGE_VAL};
  EXPECT_THROW(selection.Validate(), InvalidOptions);
}

TEST_F(SelectionTest, ArgumentsMustBeOfOneMesh) {
  const Selection selection = ReadSelection(R"({"vertices": [1]})");
  EXPECT_THROW(SelectVertices(selection, cube_.vertices.leftCols(7), *connectivity_, appearance_),
               MeshError);
  appearance_.groups.of_polygon.pop_back();
  EXPECT_THROW(SelectVertices(selection, cube_.vertices, *connectivity_, appearance_), MeshError);
}

}  // namespace
}  // namespace shapespace
