#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <nlohmann/json.hpp>

#include "tools/run.h"

namespace shapespace {
namespace {

using testing::Content;
using testing::ToolsTest;

using Keys = std::set<std::string>;

/// The words in backticks that could be keys.
Keys KeysIn(const std::string& text) {
  static const std::regex key("`([a-z][a-z0-9_]*)`");
  Keys keys;
  for (std::sregex_iterator match(text.begin(), text.end(), key), end; match != end; ++match) {
    keys.insert((*match)[1]);
  }
  return keys;
}

/// The keys of an object, or of the objects in an array, recursively.
void Collect(const nlohmann::json& json, Keys* keys) {
  for (const auto& [key, value] : json.items()) {
    if (json.is_object()) keys->insert(key);
    if (value.is_structured()) Collect(value, keys);
  }
}

Keys KeysOf(const nlohmann::json& object) {
  Keys keys;
  for (const auto& [key, value] : object.items()) keys.insert(key);
  return keys;
}

/// The tables of docs/file-formats.md that describe reports.
class ReportKeysTest : public ToolsTest {
 protected:
  /// The rows of the table after `heading`: the keys of the first column, and the text of the
  /// second.
  static std::vector<std::pair<Keys, std::string>> Rows(const std::string& heading) {
    const std::string text = Content(SHAPESPACE_DOCS_DIR "/file-formats.md");
    const size_t begin = text.find(heading);
    EXPECT_NE(begin, text.npos) << heading;
    std::istringstream lines(text.substr(begin + heading.size()));
    std::vector<std::pair<Keys, std::string>> rows;
    for (std::string line; std::getline(lines, line);) {
      if (line.rfind("| `", 0) == 0) {
        const size_t bar = line.find('|', 1);
        rows.emplace_back(KeysIn(line.substr(0, bar)), line.substr(bar));
      } else if (!rows.empty()) {
        break;
      }
    }
    return rows;
  }

  /// Checks that `json` and the table have the same keys. `sometimes` are keys that this report
  /// does not have; the content of `parts` depends on the metric.
  static void Compare(const std::string& heading, nlohmann::json json, const Keys& sometimes = {}) {
    SCOPED_TRACE(heading);
    const std::vector<std::pair<Keys, std::string>> words = Rows("Every report has `termination`");
    const Keys ending = {json.value("termination", "")};
    EXPECT_TRUE(std::any_of(words.begin(), words.end(), [&](const auto& row) {
      return row.first == ending;
    })) << *ending.begin();
    json["parts"] = 0;
    Keys documented = sometimes;
    documented.insert("parts");
    for (const auto& [keys, content] : Rows(heading)) {
      Keys inner;
      bool structured = false;
      for (const std::string& key : keys) {
        documented.insert(key);
        EXPECT_TRUE(json.contains(key) || sometimes.count(key) > 0) << key << " is not written";
        // An empty list has no keys to compare.
        if (!json.contains(key) || !json[key].is_structured() || json[key].empty()) continue;
        Collect(json[key], &inner);
        structured = true;
      }
      const Keys told = KeysIn(content);
      for (const std::string& key : inner) {
        const bool is_range = key == "rms" || key == "p99" || key == "max";
        EXPECT_TRUE(told.count(key) > 0 || is_range) << key << " in " << *keys.begin();
      }
      for (const std::string& key : told) {
        EXPECT_TRUE(!structured || inner.count(key) > 0 || json.contains(key))
            << key << " is not in " << *keys.begin();
      }
    }
    for (const auto& [key, value] : json.items()) {
      EXPECT_EQ(documented.count(key), 1u) << key << " is not documented";
    }
  }

  nlohmann::json Report(const std::string& tool, std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--report", "r.json"});
    Succeed(tool, arguments);
    return nlohmann::json::parse(Content(Path("r.json")));
  }
};

TEST_F(ReportKeysTest, TheDocumentationHasThemAllAndNoOthers) {
  MakeTubes();
  const nlohmann::json geodesic =
      Report("shape-interpolate", {"tube0.obj", "tube1.obj", "--output", "w.path"});
  Compare("Of `shape-interpolate`:", geodesic);
  Compare("Of `shape-extrapolate`,",
          Report("shape-extrapolate",
                 {"w.path", "--steps", "2", "--correct", "1", "--output", "on.path"}));
  const nlohmann::json transfer =
      Report("shape-transfer", {"w.path", "--target", "tube0.obj", "--output", "t.path"});
  const nlohmann::json ladder =
      Report("shape-transfer",
             {"w.path", "--method", "ladder", "--target", "tube0.obj", "--output", "t.path"});
  Compare("Of `shape-transfer`:", ladder);
  for (const auto& [key, value] : ladder.items()) EXPECT_TRUE(transfer.contains(key)) << key;
  EXPECT_EQ(transfer.size(), ladder.size());
  EXPECT_EQ(KeysOf(transfer["steps"][0]), KeysOf(ladder["steps"][0]));
  const nlohmann::json poses =
      Report("shape-transfer", {"tube0.obj", "tube1.obj", "--method", "ladder", "--shapes", "1",
                                "--target", "tube0.obj", "--output", "t.path"});
  EXPECT_EQ(KeysOf(poses),
            (Keys{"termination", "converged", "cancelled", "geodesics", "transfers", "warnings"}));
  EXPECT_EQ(poses["geodesics"][0].size(), geodesic.size());
  EXPECT_EQ(poses["transfers"][0].size(), ladder.size());

  Compare("Of `shape-average`:",
          Report("shape-average", {"tube0.obj", "tube1.obj", "--output", "m.obj"}));
  nlohmann::json modes =
      Report("shape-statistics", {"tube0.obj", "tube1.obj", "--output", "m.modes"});
  modes["average"] = 0;  // the one above
  Compare("Of `shape-statistics`, when it makes modes:", modes);

  Compare("Of `shape-explore`:",
          Report("shape-explore", {"tube0.obj", "tube1.obj", "--output", "t.space"}));

  // One marker is at the other end of the tube.
  std::string markers = "150 2\n";
  for (int v = 3; v < 145; v += 11) markers += std::to_string(v) + ' ' + std::to_string(v) + '\n';
  File("markers.txt", markers);
  nlohmann::json fit = Report("shape-correspond", {"tube0.obj", "tube0.obj", "--markers",
                                                   "markers.txt", "--output", "m.txt"});
  // Only a body with limbs needs no markers.
  Succeed("shape-body", {"quadruped", "--triangles", "1500", "--output", "animal%d.obj"});
  fit["candidates"] =
      Report("shape-correspond", {"animal0.obj", "animal0.obj", "--output", "m.txt"})["candidates"];
  Compare("Of `shape-correspond`,", fit);

  File("handles.json", R"({"handles": [{"fixed": true, "select": {"vertices": [1]}}]})");
  const nlohmann::json deformation =
      Report("shape-deform", {"tube0.obj", "--handles", "handles.json", "--output", "d.path"});
  Compare("Of `shape-deform --handles`:", deformation);
  const nlohmann::json repair =
      Report("shape-deform", {"tube0.obj", "--repair", "tube1.obj", "--output", "d.path"});
  nlohmann::json own = repair;
  own["deformation"] = true;  // instead of a report as above
  Compare("Of `shape-deform --repair`:", own);
  EXPECT_EQ(KeysOf(repair["deformation"]), KeysOf(deformation));
}

TEST_F(ReportKeysTest, KeysOfInspectedFilesAreDocumented) {
  MakeTubes();
  Succeed("shape-interpolate", {"tube0.obj", "tube1.obj", "--shapes", "3", "--output", "w.path"});
  Succeed("shape-explore", {"tube0.obj", "tube1.obj", "--depth", "0", "--output", "t.space"});
  Succeed("shape-statistics", {"tube0.obj", "tube1.obj", "--output", "t.modes"});
  Keys keys;
  Collect(Report("shape-inspect", {"tube0.obj", "tube1.obj", "w.path", "t.space", "t.modes"}),
          &keys);
  const std::string text = Content(SHAPESPACE_DOCS_DIR "/file-formats.md");
  const size_t begin = text.find("Of `shape-inspect`, in place of"),
               end = text.find("Of `shape-transfer`:");
  ASSERT_LT(begin, end);
  Keys documented = KeysIn(text.substr(begin, end - begin));
  for (const auto& [row, content] : Rows("Of `shape-interpolate`:")) {
    if (row.count("quality") > 0) documented.merge(KeysIn(content));
  }
  for (const std::string& key : keys) EXPECT_EQ(documented.count(key), 1u) << key;
}

TEST_F(ReportKeysTest, KeysOfTransportAreDocumented) {
  MakeTubes();
  const nlohmann::json report =
      Report("shape-transport", {"tube0.obj", "tube0.obj", "tube1.obj", "--output", "t.obj"});
  Keys keys;
  Collect(report["transport"], &keys);
  Keys documented;
  for (const auto& [row, content] : Rows("Of `shape-transport`,")) documented = KeysIn(content);
  EXPECT_EQ(keys, documented);
}

}  // namespace
}  // namespace shapespace
