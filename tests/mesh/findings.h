#ifndef SHAPESPACE_TESTS_MESH_FINDINGS_H_
#define SHAPESPACE_TESTS_MESH_FINDINGS_H_

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/message_of.h"

namespace shapespace::testing {

/// Expects one finding, "kind: message", for each of the lists: its kind, and what it names.
inline void ExpectFindings(const std::vector<std::string>& texts,
                           const std::vector<std::vector<std::string>>& expected) {
  ASSERT_EQ(texts.size(), expected.size()) << ::testing::PrintToString(texts);
  for (size_t i = 0; i < texts.size(); ++i) {
    EXPECT_EQ(texts[i].find(expected[i][0] + ": "), 0u) << texts[i];
    EXPECT_TRUE(Names(texts[i], expected[i]));
  }
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_MESH_FINDINGS_H_
