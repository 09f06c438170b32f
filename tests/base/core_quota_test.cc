#include <shapespace/base/detail/core_quota.h>

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

namespace shapespace::internal {
namespace {

namespace fs = std::filesystem;

class CoreQuotaTest : public ::testing::Test {
 protected:
  // Tests may run at a time.
  CoreQuotaTest()
      : root_(fs::path(::testing::TempDir()) /
              (std::string("core_quota_test_") +
               ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::remove_all(root_);
    fs::create_directories(root_ / "slice" / "job");
  }
  ~CoreQuotaTest() override { fs::remove_all(root_); }

  void Limit(const std::string& group, const std::string& text) const {
    std::ofstream(root_ / group / "cpu.max") << text;
  }
  std::optional<double> Quota(const std::string& group_file = "1:cpu:/x\n0::/slice/job\n") const {
    std::ofstream(root_ / "cgroup") << group_file;
    return CoreQuota((root_ / "cgroup").string(), root_.string());
  }

  const fs::path root_;
};

TEST_F(CoreQuotaTest, IsTheStrictestOfAllGroups) {
  EXPECT_FALSE(Quota());
  Limit("slice/job", "max 100000\n");
  EXPECT_FALSE(Quota());
  Limit("slice", "250000 100000\n");
  EXPECT_EQ(Quota(), 2.5);
  Limit("slice/job", "400000 100000\n");
  EXPECT_EQ(Quota(), 2.5);
  Limit("slice/job", "50000 100000\n");
  EXPECT_EQ(Quota(), 0.5);
}

// In a container the group is the root itself.
TEST_F(CoreQuotaTest, OfAContainerIsAtTheRoot) {
  Limit("", "300000 100000\n");
  EXPECT_EQ(Quota("0::/\n"), 3);
  EXPECT_EQ(Quota("0::/../elsewhere\n"), 3);
}

// In version 1 every controller has a folder of its own, and a limit two files.
TEST_F(CoreQuotaTest, IsReadFromVersion1Too) {
  const auto limit = [&](const fs::path& group, const std::string& quota) {
    fs::create_directories(root_ / group);
    std::ofstream(root_ / group / "cpu.cfs_quota_us") << quota;
    std::ofstream(root_ / group / "cpu.cfs_period_us") << "100000\n";
  };
  const std::string groups = "9:cpuset:/other\n4:cpuacct,cpu:/docker/job\n0::/\n";
  limit("cpu", "-1\n");
  limit("cpu/docker/job", "-1\n");
  EXPECT_FALSE(Quota(groups));
  limit("cpu/docker/job", "150000\n");
  EXPECT_EQ(Quota(groups), 1.5);
  limit("cpu/docker", "50000\n");
  EXPECT_EQ(Quota(groups), 0.5);
  // Seen from within a container, whose group is mounted as the root.
  fs::remove_all(root_ / "cpu" / "docker");
  limit("cpu", "300000\n");
  EXPECT_EQ(Quota(groups), 3);
}

// The group of version 2 comes from its own line, wherever that is; lines that say nothing of the
// sort are skipped. A quota of version 2 goes before one of version 1.
TEST_F(CoreQuotaTest, TheGroupOfEachVersionComesFromItsLine) {
  Limit("slice", "70000 20000\n");
  fs::create_directories(root_ / "cpu" / "old");
  std::ofstream(root_ / "cpu" / "old" / "cpu.cfs_quota_us") << "30000\n";
  std::ofstream(root_ / "cpu" / "old" / "cpu.cfs_period_us") << "40000\n";
  EXPECT_EQ(Quota("\nnothing\n:\n3:cpu:/old\n0::/slice\n"), 3.5);
  EXPECT_EQ(Quota("0::/slice\n3:cpu:/old\n"), 3.5);
  EXPECT_EQ(Quota("0::/other\n3:cpu:/old\n"), 0.75);
  EXPECT_EQ(Quota("0::/other\n3:xcpu:/slice\n4:cpu,cpuacct:/old\n"), 0.75);
  EXPECT_FALSE(Quota("0::/other\n3:cpus:/old\n"));
  EXPECT_FALSE(Quota("0::/other\n3:cpu:old\n"));
  fs::remove(root_ / "cpu" / "old" / "cpu.cfs_period_us");
  EXPECT_FALSE(Quota("3:cpu:/old\n"));
}

TEST_F(CoreQuotaTest, IsNotKnownFromOtherFiles) {
  EXPECT_FALSE(CoreQuota("/nowhere/cgroup", "/nowhere"));
  for (const char* text : {"", "many 100000\n", "100000\n", "100000 0\n", "-1 100000\n"}) {
    Limit("slice/job", text);
    EXPECT_FALSE(Quota()) << text;
  }
}

}  // namespace
}  // namespace shapespace::internal
