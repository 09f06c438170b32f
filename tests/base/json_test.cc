#include <shapespace/base/internal/json.h>

#include <functional>
#include <string>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>

#include "support/message_of.h"

namespace shapespace {
namespace {

using internal::Json;
using internal::ParseJson;

std::string Problem(const std::function<void()>& call) {
  return testing::MessageOf<InvalidOptions>(call);
}

TEST(ParseJsonTest, NamesTheLineAndTheKeyThatOccursTwice) {
  const auto problem = [](const std::string& text) { return Problem([&] { ParseJson(text); }); };
  const std::string twice = "the key 'a' occurs twice in one object; remove one";
  EXPECT_EQ(problem("{\n\"a\": 1,\n\"a\": 2}"), "line 3: " + twice);
  EXPECT_EQ(problem("{\"a\": {\"b\": 1},\n\"c\": [{\"b\": 2}],\n\n\"a\": 2}"), "line 4: " + twice);
  EXPECT_EQ(problem("{\"b\": {\"a\": 1,\n\"a\": 2}}"), "line 2: " + twice);
  EXPECT_EQ(ParseJson("{\"a\": {\"a\": 1}, \"b\": {\"a\": 2}}")["b"]["a"], 2);
}

TEST(ParseJsonTest, NamesTheLineOfWhatIsNoJson) {
  const auto problem = [](const std::string& text) { return Problem([&] { ParseJson(text); }); };
  const auto begins = [&](const std::string& text, const std::string& message) {
    EXPECT_EQ(problem(text).rfind(message + ": this is not valid JSON: ", 0), 0u) << problem(text);
    EXPECT_EQ(problem(text).find("parse error"), std::string::npos) << problem(text);
  };
  begins("", "line 1");
  begins("x", "line 1");
  begins("{\n\"a\": 1\n\"b\": 2}", "line 3");
  begins("{\n  \"a\": 1,\n  oops\n}", "line 3");
  begins("[1, 2,\n3", "line 2");
  begins("[1,\n1e999]", "line 2");
  EXPECT_EQ(problem("[\x01]").find('\x01'), std::string::npos);
}

TEST(JsonFieldsTest, SayWhatTheyMustBeAndWhatTheyAre) {
  const Json object = {{"b", 1}, {"z", 2}};
  EXPECT_TRUE(testing::Names(Problem([&] {
                               internal::CheckKeys(object, "ball", {"a", "b"});
                             }),
                             {"ball:", "'z'"}));
  internal::CheckKeys(object, "ball", {"a", "z", "b"});
  EXPECT_TRUE(testing::Names(Problem([] {
                               internal::CheckKeys(Json(3), "", {"a", "b"});
                             }),
                             {"number"}));
  EXPECT_EQ(internal::Required(object, "ball", "z"), 2);
  EXPECT_TRUE(
      testing::Names(Problem([&] { internal::Required(object, "ball", "a"); }), {"ball.a:"}));
  EXPECT_TRUE(testing::Names(Problem([&] { internal::Required(object, "", "a"); }), {"a:"}));
  EXPECT_TRUE(testing::Names(Problem([] { internal::NumberFrom("1", "at"); }), {"at:", "string"}));
  EXPECT_TRUE(testing::Names(Problem([] { internal::BoolFrom(1, "at"); }), {"at:", "number"}));
  EXPECT_TRUE(testing::Names(Problem([] { internal::TextFrom(true, "at"); }), {"at:", "boolean"}));
  EXPECT_TRUE(
      testing::Names(Problem([&] { internal::ListFrom(object, "at"); }), {"at:", "object"}));
  EXPECT_TRUE(testing::Names(Problem([] { internal::ListFrom(Json::array(), "at"); }), {"at:"}));
  EXPECT_EQ(internal::VectorFrom({1, 2.5, -3}, "at"), Eigen::Vector3d(1, 2.5, -3));
  const Json wrong[] = {{1, 2}, {1, 2, 3, 4}, {1, 2, "3"}, {"1", 2, 3}, 1};
  for (const Json& vector : wrong) {
    EXPECT_TRUE(testing::Names(Problem([&] { internal::VectorFrom(vector, "at"); }), {"at:"}));
  }
}

}  // namespace
}  // namespace shapespace
