#include <shapespace/deformation/handle_file.h>

#include <set>

#include <nlohmann/json.hpp>

#include <shapespace/base/error.h>
#include <shapespace/bodies/quadruped.h>

#include "mesh/bodies.h"
#include "mesh/files.h"

namespace shapespace {
namespace {

using testing::Content;
using Vertices = std::vector<int>;

/// Handles of the unit cube; vertex x + 2 y + 4 z lies at (x, y, z).
class HandleFileTest : public testing::FilesTest {
 protected:
  std::vector<DeformationHandle> Read(const std::string& text) const {
    return ReadHandles(File("h.json", text), cube_.vertices, *testing::Connected(cube_), {});
  }

  /// The only handle of a file, an object with these keys.
  DeformationHandle ReadOne(const std::string& keys) const {
    return Read(R"({"handles": [{)" + keys + "}]}").at(0);
  }

  /// The file is rejected with a message that begins with its name and `begin`, and contains
  /// `part`.
  void ExpectError(const std::string& text, const std::string& begin,
                   const std::string& part = "") const {
    testing::ExpectError<FileError>([&] { Read(text); }, {Path("h.json") + ": " + begin, part});
  }

  const Soup cube_ = testing::Cube();
};

constexpr char kTop[] = R"("select": {"vertices": [[5, 8]]})";

TEST_F(HandleFileTest, WithoutWeightAHandleIsHardAndMayStay) {
  const DeformationHandle handle = ReadOne(std::string(R"("name": "top", "fixed": true, )") + kTop);
  EXPECT_EQ(handle.name, "top");
  EXPECT_EQ(handle.vertices, (Vertices{4, 5, 6, 7}));
  EXPECT_FALSE(handle.positions);
  EXPECT_TRUE(handle.hard);
  EXPECT_EQ(handle.motion.angle, 0);
  EXPECT_TRUE(handle.motion.translation.isZero(0));
  EXPECT_TRUE(ReadOne(std::string(R"("fixed": true, "hard": true, )") + kTop).hard);
}

TEST_F(HandleFileTest, WeightsMakeHandlesSoft) {
  for (const char* more : {"", R"("hard": false, )"}) {
    const DeformationHandle handle =
        ReadOne(std::string(R"("fixed": true, "weight": 2.5, )") + more + kTop);
    EXPECT_FALSE(handle.hard);
    EXPECT_EQ(handle.weight, 2.5);
  }
}

TEST_F(HandleFileTest, MotionsTurnAboutTheMeanOfTheVerticesAndThenMove) {
  DeformationHandle handle = ReadOne(std::string(R"("translation": [1, 2, 3], )") + kTop);
  EXPECT_EQ(handle.motion.angle, 0);
  EXPECT_TRUE(handle.motion.translation == Eigen::Vector3d(1, 2, 3));
  handle = ReadOne(
      std::string(
          R"("translation": [0, 0, 1], "rotation": {"axis": [0, 0, 9], "degrees": 450}, )") +
      kTop);
  EXPECT_NEAR(handle.motion.angle, 2.5 * M_PI, 1e-15);
  EXPECT_TRUE(handle.motion.point.isApprox(Eigen::Vector3d(0.5, 0.5, 1), 1e-15));
  EXPECT_TRUE(handle.motion.At(1, {1, 0.5, 1}).isApprox(Eigen::Vector3d(0.5, 1, 2), 1e-14));
  handle = ReadOne(
      std::string(R"("rotation": {"axis": [0, 0, 1], "degrees": 90, "point": [1, 0, 0]}, )") +
      kTop);
  EXPECT_TRUE(handle.motion.At(1, {2, 0, 1}).isApprox(Eigen::Vector3d(1, 1, 1), 1e-14));
}

TEST_F(HandleFileTest, APositionIsThatOfTheMean) {
  const DeformationHandle top = ReadOne(std::string(R"("position": [2, 2, 2], )") + kTop);
  EXPECT_FALSE(top.positions);
  EXPECT_TRUE(top.motion.translation.isApprox(Eigen::Vector3d(1.5, 1.5, 1), 1e-15));
  const DeformationHandle corner = ReadOne(R"("position": [1, 2, 3], "select": {"vertices": [8]})");
  ASSERT_TRUE(corner.positions);
  EXPECT_TRUE(*corner.positions == Shape(Eigen::Vector3d(1, 2, 3)));
}

TEST_F(HandleFileTest, NumbersAreTakenUpToTheirLimits) {
  const std::string vertex = R"("select": {"vertices": [2]}, )";
  const auto angle = [&](const std::string& degrees) {
    return ReadOne(vertex + R"("rotation": {"axis": [0, 3, -4], "degrees": )" + degrees + "}")
        .motion;
  };
  EXPECT_NEAR(angle("36000").angle, 200 * M_PI, 1e-9);
  EXPECT_NEAR(angle("-36000").angle, -200 * M_PI, 1e-9);
  EXPECT_NEAR(angle("-45").angle, -M_PI / 4, 1e-15);
  EXPECT_TRUE(angle("1").axis.isApprox(Eigen::Vector3d(0, 0.6, -0.8), 1e-15));
  EXPECT_TRUE(angle("1").translation.isZero(0));
  EXPECT_EQ(ReadOne(vertex + R"("fixed": true, "weight": 1e60)").weight, 1e60);
  EXPECT_EQ(ReadOne(vertex + R"("translation": [0, -1e60, 0])").motion.translation(1), -1e60);
  const std::string limit = ": must be from -1e+60 to 1e+60";
  const std::string turn = vertex + R"("rotation": {"degrees": 1, "axis": )";
  const struct {
    std::string keys, message;
  } cases[] = {
      {vertex + R"("rotation": {"axis": [0, 0, 1], "degrees": 36001})",
       "rotation.degrees: must be from -36000.0 to 36000.0"},
      {vertex + R"("rotation": {"axis": [0, 0, 1], "degrees": -36001})",
       "rotation.degrees: must be from -36000.0 to 36000.0"},
      {turn + "[0, 0, 1e61]}", "rotation.axis" + limit},
      {turn + R"([0, 0, 1], "point": [-1e61, 0, 0]})", "rotation.point" + limit},
      {vertex + R"("position": [0, 1e61, 0])", "position" + limit},
      {vertex + R"("translation": [0, 0, -1e61])", "translation" + limit},
      {R"("select": {"vertices": [2, 3]}, "positions": [[0, 0, 0], [0, 1e61, 0]])",
       "positions (position 2)" + limit},
      {vertex + R"("fixed": true, "weight": 1e61)", "weight: must be positive and at most 1e+60"},
      {vertex + R"("fixed": true, "rotation": {"axis": [0, 0, 1], "degrees": 1})",
       "rotation: excludes fixed; leave one of them out"},
      {vertex + R"("rotation": {"axis": [0, 0, 1], "degrees": 1}, "positions": [[0, 0, 0]])",
       "positions: excludes rotation; leave one of them out"},
  };
  for (const auto& [keys, message] : cases) {
    SCOPED_TRACE(keys);
    ExpectError(R"({"handles": [{)" + keys + "}]}", "handle 1: " + message);
  }
  ExpectError(R"({"handles": [{"name": "a", )" + vertex + R"("fixed": true}, {"name": 7}]})",
              "handle 2: name: must be a text in quotation marks");
  ExpectError(R"({"$schema": "s", "handles": [{"name": "a", )" + vertex + R"("fixed": false}]})",
              "handle 1 ('a'): fixed: must be true; leave it out if the handle moves");
}

TEST_F(HandleFileTest, PositionsStandInTheOrderOfTheVertices) {
  const DeformationHandle handle = ReadOne(
      R"("positions": [[1, 2, 3], [4, 5, 6], [7, 8, 9]], "select": {"vertices": [1, [3, 4]]})");
  EXPECT_EQ(handle.vertices, (Vertices{0, 2, 3}));
  ASSERT_TRUE(handle.positions);
  EXPECT_TRUE(handle.positions->col(2) == Eigen::Vector3d(7, 8, 9));
}

TEST_F(HandleFileTest, ErrorsNameTheHandleTheFieldAndTheRemedy) {
  ExpectError("{\"handles\": [\n{\"fixed\": true,}\n]}", "line 2: this is not valid JSON: ");
  ExpectError("{\"handles\": [{\"fixed\": true,\n\"fixed\": true}]}",
              "line 2: the key 'fixed' occurs twice in one object; remove one");
  ExpectError("[]", "must be an object, { }, with keys of handles, $schema");
  ExpectError("{}", "handles: is missing");
  ExpectError(R"({"handles": []})", "handles: the list is empty");
  ExpectError(R"({"handels": []})", "unknown key 'handels'; the keys here are handles, $schema");
  ExpectError(R"({"handles": [{"fixed": true, "select": {"vertices": [1]}},
                              {"name": "hand", "fixed": true}]})",
              "handle 2 ('hand'): select: is missing");
  ExpectError(R"({"handles": [3]})", "handle 1: must be an object");
  testing::ExpectError<FileError>(
      [&] { ReadHandles(Path("none.json"), {}, *testing::Connected(cube_), {}); },
      {Path("none.json") + ": cannot be opened"});

  const std::string vertex = R"("select": {"vertices": [1]}, )";
  const struct {
    std::string keys, message;
  } cases[] = {
      {R"("fixed": true, "select": {"vertices": [9]})",
       "select: vertices: 9 is not a vertex of this mesh, which has 8"},
      {R"("fixed": true, "select": {"ball": {"centre": [0, 0, 0], "radius": -1}})",
       "select: ball.radius: must be zero or more"},
      {R"("fixed": true, "select": {"group": "head"})", "select: group: no polygon has"},
      {vertex + R"("weigth": 1)", "unknown key 'weigth'; the keys here are name, select, fixed, "},
      {vertex + R"("name": 1)", "name: must be a text in quotation marks"},
      {vertex + R"("name": "a")",
       "has no target; give one of fixed, translation, rotation, position, positions"},
      {vertex + R"("fixed": false)", "fixed: must be true; leave it out if the handle moves"},
      {vertex + R"("fixed": 1)", "fixed: must be true or false"},
      {vertex + R"("fixed": true, "position": [0, 0, 0])",
       "position: excludes fixed; leave one of them out"},
      {vertex + R"("translation": [0, 0, 0], "position": [0, 0, 0])",
       "position: excludes translation"},
      {vertex + R"("position": [0, 0, 0], "positions": [[0, 0, 0]])",
       "positions: excludes position"},
      {vertex + R"("translation": [0, 0])", "translation: must be three numbers, [x, y, z]"},
      {vertex + R"("translation": [0, 0, 1e61])", "translation: must be from -1e+60 to 1e+60"},
      {vertex + R"("rotation": 90)", "rotation: must be an object"},
      {vertex + R"("rotation": {"axis": [0, 0, 1]})", "rotation.degrees: is missing"},
      {vertex + R"("rotation": {"degrees": 10})", "rotation.axis: is missing"},
      {vertex + R"("rotation": {"axis": [0, 0, 0], "degrees": 10})",
       "rotation.axis: must not be zero"},
      {vertex + R"("rotation": {"axis": [0, 0, 1], "degrees": 1e6})",
       "rotation.degrees: must be from -36000.0 to 36000.0"},
      {vertex + R"("rotation": {"axis": [0, 0, 1], "degrees": 1, "centre": [0, 0, 0]})",
       "rotation: unknown key 'centre'; the keys here are axis, degrees, point"},
      {vertex + R"("positions": [])", "positions: the list is empty"},
      {vertex + R"("positions": [[0, 0, 0], [0, 0, 0]])",
       "positions: 2 are given for 1 selected vertices; give one for each"},
      {vertex + R"("positions": [[0, 0, true]])",
       "positions (position 1): must be three numbers, [x, y, z]"},
      {R"("select": {"vertices": [4, 3]}, "positions": [[0, 0, 0], [1, 1, 1]])",
       "positions: are assigned in the order of the vertices' numbers; select the vertices in this "
       "order"},
      {R"("select": {"vertices": [[1, 3], [2, 4]]}, "positions": [[0, 0, 0], [1, 1, 1], [2, 2, 2], [3, 3, 3]])",
       "positions: are assigned in the order of the vertices' numbers"},
      {R"("select": {"any": [{"vertices": [4]}, {"vertices": [3]}]}, "positions": [[0, 0, 0], [1, 1, 1]])",
       "positions: are assigned in the order of the vertices' numbers"},
      {vertex + R"("fixed": true, "weight": 0)", "weight: must be positive"},
      {vertex + R"("fixed": true, "weight": -1)", "weight: must be positive"},
      {vertex + R"("fixed": true, "weight": "much")", "weight: must be a number"},
      {vertex + R"("fixed": true, "weight": 1, "hard": true)",
       "hard: true excludes weight, which makes a handle soft; leave one out"},
      {vertex + R"("fixed": true, "hard": false)", "hard: false needs a weight; give one"},
      {vertex + R"("fixed": true, "hard": 1)", "hard: must be true or false"},
  };
  for (const auto& [keys, message] : cases) {
    SCOPED_TRACE(keys);
    ExpectError(R"({"handles": [{)" + keys + "}]}", "handle 1", message);
  }
}

TEST_F(HandleFileTest, TheExampleOfTheDocumentationIsRead) {
  const std::string text = Content(SHAPESPACE_DOCS_DIR "/file-formats.md");
  const size_t begin = text.find("```json\n", text.find("## Handles")) + 8;
  const std::string example = text.substr(begin, text.find("```", begin) - begin);
  const SkinnedBody body = MakeQuadruped(0);
  const std::vector<DeformationHandle> handles =
      ReadHandles(File("example.json", example), body.pose("stand"), *body.connectivity, {});
  ASSERT_EQ(handles.size(), 4u);
  EXPECT_EQ(handles[0].name, "hind feet");
  EXPECT_NEAR(handles[1].motion.angle, M_PI / 3, 1e-15);
  EXPECT_FALSE(handles[2].hard);
  EXPECT_EQ(handles[3].positions->cols(), 2);
  std::set<int> vertices;
  size_t count = 0;
  for (const DeformationHandle& handle : handles) {
    vertices.insert(handle.vertices.begin(), handle.vertices.end());
    count += handle.vertices.size();
  }
  EXPECT_EQ(vertices.size(), count) << "two handles of the example have a vertex in common";
}

/// The keys that an object of the schema may have, compared with `keys`.
std::set<std::string> KeysOf(const nlohmann::json& object) {
  std::set<std::string> keys;
  for (const auto& [key, value] : object.at("properties").items()) keys.insert(key);
  return keys;
}

TEST_F(HandleFileTest, TheSchemaHasTheKeysOfTheReaderAndNoOthers) {
  const nlohmann::json schema =
      nlohmann::json::parse(Content(SHAPESPACE_DOCS_DIR "/handles.schema.json"));
  const nlohmann::json& parts = schema.at("$defs");
  const struct {
    nlohmann::json object;
    std::string before, after;  // text around an object of this kind with an unknown key
  } cases[] = {
      {schema, "", ""},
      {parts.at("handle"), R"({"handles": [)", "]}"},
      {parts.at("rotation"), R"({"handles": [{"select": {"vertices": [1]}, "rotation": )", "}]}"},
      {parts.at("selection"), R"({"handles": [{"select": )", "}]}"},
      {parts.at("ball"), R"({"handles": [{"select": {"ball": )", "}}]}"},
      {parts.at("box"), R"({"handles": [{"select": {"box": )", "}}]}"},
      {parts.at("halfspace"), R"({"handles": [{"select": {"halfspace": )", "}}]}"},
  };
  size_t objects = 0;
  for (const auto& [name, part] : parts.items()) objects += part.contains("properties");
  EXPECT_EQ(objects + 1, std::size(cases))
      << "the schema has a kind of object that is not compared";
  for (const auto& [object, before, after] : cases) {
    SCOPED_TRACE(before);
    EXPECT_EQ(object.at("additionalProperties"), false);
    std::string message;
    try {
      Read(before + R"({"nonsense": 0})" + after);
    } catch (const FileError& error) {
      message = error.what();
    }
    // "... unknown key 'nonsense'; the keys here are a, b, c".
    const std::string intro = "unknown key 'nonsense'; the keys here are ";
    const size_t begin = message.find(intro);
    ASSERT_NE(begin, message.npos) << message;
    std::set<std::string> known;
    std::istringstream list(message.substr(begin + intro.size()));
    for (std::string key; std::getline(list >> std::ws, key, ',');) known.insert(key);
    EXPECT_EQ(KeysOf(object), known);
  }
}

}  // namespace
}  // namespace shapespace
