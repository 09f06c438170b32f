#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/files/pose_order.h>

namespace shapespace {
namespace {

using ListOfNames = std::vector<std::string>;

TEST(PoseOrderTest, NumbersThatDoNotAscendAreTold) {
  const std::string warning = OrderWarning({"pose1.obj", "pose10.obj", "pose2.obj", "pose3.obj"});
  EXPECT_NE(warning.find("pose10.obj"), std::string::npos);
  EXPECT_NE(warning.find("pose2.obj"), std::string::npos);
  for (const ListOfNames& names :
       {ListOfNames{"a10", "a2"},
        {"1.obj", "3.obj", "2.obj"},
        {"rest.obj", "a/walk 1.obj", "a/walk 12.obj", "a/walk 3.obj"},
        {"a1_2.ply", "a1_10.ply", "a1_9.ply"},
        {"a1_9", "a2_9", "a10_1", "a3_1"},
        {"s99999999999999999999999", "s100000000000000000000000", "s2"}}) {
    EXPECT_FALSE(OrderWarning(names).empty()) << names.back();
  }
}

TEST(PoseOrderTest, NumbersThatAscendAndOtherNamesAreNot) {
  for (const ListOfNames& names : {ListOfNames{},
                                   {"a"},
                                   {"a1", "a2", "a10", "a100"},
                                   {"a01", "a02", "a10"},
                                   {"a2", "a1"},                // back
                                   {"a11", "a10", "a9", "a8"},  // no shell would
                                   {"a1", "a3", "a2", "a1"},    // a round
                                   {"a1", "a3", "a2", "a001"},  // the same number
                                   {"a10", "b2", "c1"},
                                   {"stand", "walk", "run"},
                                   {"a1_9", "a2_1", "a10_1"},
                                   {"0", "00", "1"}}) {
    EXPECT_EQ(OrderWarning(names), "") << (names.empty() ? "" : names.back());
  }
}

}  // namespace
}  // namespace shapespace
