#include <shapespace/base/error.h>

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/metric/metric.h>

namespace shapespace {
namespace {

TEST(InvalidOptionsTest, SaysWhichFieldsAreWrongAndWhy) {
  MetricOptions nothing;
  nothing.isometric = nothing.strain = nothing.lambda = nothing.rigid = 0;
  try {
    nothing.Validate();
    FAIL() << "a metric without any cost is valid";
  } catch (const InvalidOptions& error) {
    EXPECT_EQ(error.fields(), (std::vector<std::string>{"isometric", "strain", "rigid", "lambda"}));
    EXPECT_EQ(error.what(), "isometric, strain, rigid, lambda: " + error.problem());
  }
  EXPECT_STREQ(InvalidOptions("", "wrong").what(), "wrong");
}

}  // namespace
}  // namespace shapespace
