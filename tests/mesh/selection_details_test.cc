#include <cmath>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/mesh/selection.h>

#include "mesh/bodies.h"
#include "support/message_of.h"

// Selections: their messages and the limits of what belongs to them.

namespace shapespace {
namespace {

using testing::MessageOf;
using testing::Names;
using testing::Refuses;
using Vertices = std::vector<int>;

/// The body is a box from (-1, 2, 3) to (4, 6, 8.5); its vertices are numbered as the unit cube's.
class SelectionDetailsTest : public ::testing::Test {
 protected:
  SelectionDetailsTest() : connectivity_(testing::Connected(testing::Cube())) {
    shape_ = (Eigen::Vector3d(5, 4, 5.5).asDiagonal() * testing::Cube().vertices).colwise() +
             Eigen::Vector3d(-1, 2, 3);
  }

  Vertices In(const Selection& selection) const {
    return SelectVertices(selection, shape_, *connectivity_, appearance_);
  }
  Vertices In(const std::string& text) const { return In(ReadSelection(text)); }
  std::string Message(const std::string& text) const {
    return MessageOf<InvalidOptions>([&] { In(text); });
  }

  const std::shared_ptr<const Connectivity> connectivity_;
  Shape shape_;
  Appearance appearance_;
};

TEST_F(SelectionDetailsTest, ASelectionOfNothingIsQuotedUpTo200Characters) {
  const std::string where = "; the shape lies between [-1, 2, 3] and [4, 6, 8.5]";
  const std::string several =
      ". Vertices must fit all keys; for any of them write {\"any\": [...]}";
  EXPECT_EQ(Message(R"({"ball": {"centre": [5, 6, 7], "radius": 0.5}})"),
            R"(no vertex is in {"ball":{"centre":[5.0,6.0,7.0],"radius":0.5}})" + where);
  EXPECT_EQ(Message(R"({"box": {"low": [0, 3, 4], "high": [1, 7, 9]}})"),
            R"(no vertex is in {"box":{"low":[0.0,3.0,4.0],"high":[1.0,7.0,9.0]}})" + where);
  size_t sizes = 0;
  for (const char* radius : {"0.5", "0.25"}) {
    std::string text = R"(],"ball":{"centre":[5.0,6.0,7.0],"radius":)" + std::string(radius) + "}}";
    std::string ones = "1";
    const std::string begin = R"({"vertices":[)";
    while (begin.size() + ones.size() + text.size() < 200) ones += ",1";
    text = begin + ones + text;
    sizes += text.size();
    EXPECT_EQ(Message(text), "no vertex is in " + text.substr(0, 200) +
                                 (text.size() > 200 ? " ..." : "") + where + several);
  }
  EXPECT_EQ(sizes, 200u + 201u);
}

TEST_F(SelectionDetailsTest, TheNamesThatAMeshHasAreListedUpTo400Characters) {
  // Each name takes 20 characters with its quotation marks and the comma, the first one 18.
  for (const int last : {18, 19}) {
    appearance_ = {};
    std::string all;
    for (int i = 0; i < 20; ++i) {
      const std::string name = std::string(i == 19 ? last : 16, static_cast<char>('a' + i));
      (i < 12 ? appearance_.groups : appearance_.objects).names.push_back(name);
      all += (i > 0 ? ", '" : "'") + name + "'";
    }
    ASSERT_EQ(all.size(), last == 18 ? 400u : 401u);
    EXPECT_EQ(Message(R"({"group": "legs and tail"})"),
              "group: no polygon has the group or object 'legs and tail'; this mesh has " +
                  all.substr(0, 400) + (last == 18 ? "" : " ..."));
  }
  appearance_ = {};
  EXPECT_TRUE(Names(Message(R"({"any": [{"vertices": [1]}, {"group": "leg"}]})"),
                    {"2", ".group", "'leg'", "OBJ"}));
}

TEST_F(SelectionDetailsTest, VerticesOfAllPolygonsOfANameAreSelected) {
  appearance_.groups = {{"a", "b"}, {-1, 0, -1, 1, -1, 0}};
  appearance_.objects = {{"c b", "d"}, {1, -1, 0, 1, -1, -1}};
  EXPECT_EQ(In(R"({"group": "a"})"), (Vertices{1, 3, 4, 5, 6, 7}));
  EXPECT_EQ(In(R"({"group": "b"})"), (Vertices{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(In(R"({"group": "c"})"), (Vertices{0, 1, 4, 5}));
  EXPECT_EQ(In(R"({"group": "d"})"), (Vertices{0, 1, 2, 3, 6, 7}));
}

TEST_F(SelectionDetailsTest, FiftySelectionsInsideEachOtherAreRead) {
  const auto nested = [](int depth) {
    std::string text = R"({"vertices": [3]})";
    for (int i = 0; i < depth; ++i) text = R"({"any": [)" + text + "]}";
    return text;
  };
  EXPECT_EQ(In(nested(50)), Vertices{2});
  std::string field = "any (selection 1)";
  for (int i = 1; i < 51; ++i) field += ".any (selection 1)";
  EXPECT_TRUE(Names(Message(nested(51)), {field, "50"}));
}

TEST_F(SelectionDetailsTest, EveryNumberOfEveryFieldIsChecked) {
  const double nan = std::nan(""), large = 1e61;
  const auto message = [](const Selection& selection) {
    return MessageOf<InvalidOptions>([&] { selection.Validate(); });
  };
  const std::string limits = "-1e+60 to 1e+60";
  for (const double bad : {nan, large, -large, HUGE_VAL, -HUGE_VAL}) {
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Vector3d v(-kLargestCoordinate, 0, 0.5);
      Selection ball, box, halfspace;
      ball.ball = Selection::Ball{v, 0};
      box.box = Selection::Box{v, v};
      halfspace.halfspace = Selection::HalfSpace{v, v};
      for (const Selection* good : {&ball, &box, &halfspace}) EXPECT_NO_THROW(good->Validate());
      ball.ball->centre(axis) = bad;
      EXPECT_TRUE(Names(message(ball), {"ball.centre", limits}));
      halfspace.halfspace->point(axis) = bad;
      EXPECT_TRUE(Names(message(halfspace), {"halfspace.point", limits}));
      halfspace.halfspace = Selection::HalfSpace{v, v};
      halfspace.halfspace->normal(axis) = bad;
      EXPECT_TRUE(Names(message(halfspace), {"halfspace.normal", limits}));
      box.box->high(axis) = bad;
      EXPECT_TRUE(Names(message(box), {"box.high", limits}));
      box.box->low(axis) = bad;
      EXPECT_TRUE(Names(message(box), {"box.low", limits}));
    }
    Selection ball;
    ball.ball = Selection::Ball{Eigen::Vector3d(1, 2, 3), bad};
    EXPECT_TRUE(Names(message(ball), {"ball.radius", limits}));
  }
  for (int axis = 0; axis < 3; ++axis) {
    Selection box;
    box.box = Selection::Box{Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(1, 2, 3)};
    box.box->high(axis) -= 0.5;
    EXPECT_TRUE(Names(message(box), {"box:", std::string(1, "xyz"[axis])}));
  }
}

TEST_F(SelectionDetailsTest, RangesMadeInCodeAreCountedFrom1InMessages) {
  Selection inner, outer;
  inner.vertices = {{0, 3}, {5, 4}};
  outer.any.resize(2);
  outer.any[0].vertices = {{7, 7}};
  outer.any[1].any = {outer.any[0], inner};
  const auto message = [&] { return MessageOf<InvalidOptions>([&] { outer.Validate(); }); };
  const std::string field = "any (selection 2).any (selection 2)";
  EXPECT_TRUE(Names(message(), {field, ".vertices:", "6", "5"}));
  outer.any[1].any[1].vertices[1] = {-3, 4};
  EXPECT_TRUE(Names(message(), {field, ".vertices:", "-2", "number 1"}));
  outer.any[1].any[1].vertices.clear();
  EXPECT_TRUE(Names(message(), {field, "empty"}));
  outer.any[1].any[1].vertices = {{2, 4}, {2147483647, 2147483647}};
  EXPECT_TRUE(
      Refuses<InvalidOptions>([&] { In(outer); }, {field, ".vertices:", "2147483648", "8"}));
  EXPECT_TRUE(Names(Message(R"({"vertices": [8, [2, 9]]})"), {"vertices:", "9", "8"}));
  EXPECT_TRUE(
      Names(Message(R"({"vertices": [2147483648]})"), {"vertices:", "2147483648", "number 1"}));
}

TEST_F(SelectionDetailsTest, BoundariesAreWidenedByABillionthOfTheDiagonal) {
  const double diagonal = Eigen::Vector3d(5, 4, 5.5).norm();
  const Eigen::Vector3d low(-1, 2, 3), high(4, 6, 8.5);
  for (const double scale : {1.0, 1000.0, 1e-5}) {
    const Shape shape = scale * shape_;
    const auto in = [&](const Selection& selection) {
      return SelectVertices(selection, shape, *connectivity_, {});
    };
    for (const double share : {0.8e-9, 1.2e-9}) {
      const double slip = share * diagonal * scale;
      const bool within = share < 1e-9;
      Selection ball, box, halfspace;
      ball.ball = Selection::Ball{scale * low, 4 * scale - slip};
      EXPECT_EQ(in(ball), within ? (Vertices{0, 2}) : (Vertices{0}));
      box.box = Selection::Box{scale * (low - Eigen::Vector3d(1, 1, 1)), scale * high};
      box.box->high(1) = 6 * scale - slip;
      EXPECT_EQ(in(box).size(), within ? 8u : 4u);
      box.box->high(1) = 7 * scale;
      box.box->low(2) = 3 * scale + slip;
      EXPECT_EQ(in(box), within ? (Vertices{0, 1, 2, 3, 4, 5, 6, 7}) : (Vertices{4, 5, 6, 7}));
      halfspace.halfspace = Selection::HalfSpace{scale * low + Eigen::Vector3d(slip, 0, 0),
                                                 Eigen::Vector3d(1e5, 0, 0)};
      EXPECT_EQ(in(halfspace).size(), within ? 8u : 4u);
      halfspace.halfspace->normal = {1e-5, 0, 0};
      EXPECT_EQ(in(halfspace).size(), within ? 8u : 4u);
    }
  }
}

TEST_F(SelectionDetailsTest, AllKeysHaveTheirTextInOrder) {
  Selection all;
  all.any.resize(2);
  all.any[0].group = "b\xff\"";
  all.any[1].vertices = {{2, 2}, {3, 8}};
  all.group = "a";
  all.halfspace = Selection::HalfSpace{{1, 2, 3}, {4, 5, 6}};
  all.box = Selection::Box{{7, 8, 9}, {10, 11, 12}};
  all.ball = Selection::Ball{{13, 14, 15}, 16};
  all.vertices = {{0, 1}, {4, 4}};
  EXPECT_EQ(ToText(all),
            R"({"vertices":[[1,2],5],"ball":{"centre":[13.0,14.0,15.0],"radius":16.0},)"
            R"("box":{"low":[7.0,8.0,9.0],"high":[10.0,11.0,12.0]},)"
            R"("halfspace":{"point":[1.0,2.0,3.0],"normal":[4.0,5.0,6.0]},"group":"a",)"
            "\"any\":[{\"group\":\"b\xEF\xBF\xBD\\\"\"},{\"vertices\":[3,[4,9]]}]}");
  EXPECT_EQ(ToText(ReadSelection(ToText(all))), ToText(all));
}

TEST_F(SelectionDetailsTest, ShapesOfOtherMeshesAreRefusedWithBothNumbers) {
  EXPECT_TRUE(Refuses<MeshError>(
      [&] {
        SelectVertices(ReadSelection(R"({"vertices": [1]})"), shape_.leftCols(7), *connectivity_,
                       {});
      },
      {"7", "8"}));
}

}  // namespace
}  // namespace shapespace
