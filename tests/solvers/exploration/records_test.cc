#include <atomic>
#include <chrono>
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>

#include <shapespace/exploration/detail/records.h>
#include <shapespace/exploration/explore.h>
#include <shapespace/path/internal/array_file.h>

#include "mesh/files.h"
#include "solvers/exploration/spaces.h"

namespace shapespace {
namespace {

namespace fs = std::filesystem;

using testing::Content;
using testing::FilesTest;
using testing::SmallTube;
using testing::TubePoses;

class RecordsTest : public FilesTest {
 protected:
  RecordsTest() { options_.records = Path("records"); }

  ExploreResult Run() const { return Explore(tube_.connectivity, poses_, {}, options_); }
  std::vector<fs::path> Records() const {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(options_.records)) files.push_back(entry);
    return files;
  }

  const ShapeFamily tube_ = SmallTube();
  std::vector<Shape> poses_ = TubePoses(tube_);
  ExploreOptions options_;
};

TEST_F(RecordsTest, WhatIsThereIsTakenAndLeadsToTheSame) {
  const ExploreResult first = Run();
  EXPECT_EQ(first.summary.found, 0);
  EXPECT_EQ(static_cast<int>(Records().size()), first.summary.solved);
  const ExploreResult second = Run();
  EXPECT_EQ(second.summary.found, first.summary.solved);
  EXPECT_EQ(second.summary.solved, 0);
  EXPECT_EQ(second.space.nodes, first.space.nodes);
  EXPECT_EQ(second.space.distances, first.space.distances);
  // Every other one.
  const std::vector<fs::path> records = Records();
  for (size_t i = 0; i < records.size(); i += 2) fs::remove(records[i]);
  const ExploreResult third = Run();
  EXPECT_EQ(third.summary.found, static_cast<int>(records.size() / 2));
  EXPECT_EQ(third.space.nodes, first.space.nodes);
}

TEST_F(RecordsTest, OtherInputsAndOptionsFindNone) {
  options_.depth = 1;
  Run();
  const auto expect_none = [&](const char* what) {
    const ExploreSummary summary = Run().summary;
    EXPECT_EQ(summary.found, 0) << what;
    EXPECT_GT(summary.solved, 0) << what;
  };
  const ExploreOptions options = options_;
  options_.geodesic.tolerance *= 0.5;
  expect_none("tolerance");
  options_ = options;
  options_.geodesic.shapes = 3;
  expect_none("shapes");
  options_ = options;
  options_.geodesic.metric.bending *= 1 + 1e-12;
  expect_none("bending");
  options_ = options;
  options_.geodesic.avoid_contact = true;
  expect_none("contact");
  options_ = options;
  poses_[2](1, 17) += 1e-12;
  expect_none("a vertex");
}

TEST_F(RecordsTest, ADepthOrThresholdMoreGoesOnFromThem) {
  options_.depth = 1;
  const ExploreSummary first = Run().summary;
  options_.depth = 2;
  EXPECT_EQ(Run().summary.found, first.solved);
}

TEST_F(RecordsTest, WhatIsDamagedIsSolvedAgain) {
  const ExploreResult first = Run();
  const std::vector<fs::path> records = Records();
  ASSERT_GT(records.size(), 5u);
  std::string bytes = Content(records[0]);
  bytes[bytes.size() / 2] ^= 1;
  File("records/" + records[0].filename().string(), bytes);
  fs::resize_file(records[1], 100);
  fs::resize_file(records[2], 0);
  fs::copy_file(records[3], records[4], fs::copy_options::overwrite_existing);
  const ExploreResult second = Run();
  EXPECT_EQ(second.summary.solved, 4);
  EXPECT_GE(second.summary.damaged, 3);
  EXPECT_EQ(second.space.nodes, first.space.nodes);
  EXPECT_EQ(second.space.distances, first.space.distances);
}

TEST_F(RecordsTest, DamageOfAnyByteIsNoticed) {
  poses_.resize(2);
  const auto distance = [&] { return DistanceMatrix(tube_.connectivity, poses_, options_)(0, 1); };
  const double first = distance();
  ASSERT_EQ(Records().size(), 1u);
  const std::string name = "records/" + Records()[0].filename().string();
  const std::string bytes = Content(Path(name));
  for (size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << i % 8));
    File(name, damaged);
    EXPECT_EQ(distance(), first) << "byte " << i;
    // It was solved again, and stored.
    ASSERT_EQ(Content(Path(name)), bytes) << "byte " << i;
  }
}

// One run is done and removes the records while another one still makes some.
TEST_F(RecordsTest, MayBeRemovedWhileOthersAreKept) {
  const internal::Records records(options_.records);
  std::atomic<bool> stop = false;
  std::thread remover([&] {
    while (!stop) {
      records.Remove();
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  });
  std::string error;
  for (int i = 0; i < 1000 && error.empty(); ++i) {
    try {
      records.Keep(std::to_string(i % 7), "bytes");
    } catch (const std::exception& thrown) {
      error = thrown.what();
    }
  }
  stop = true;
  remover.join();
  EXPECT_EQ(error, "");
  records.Keep("last", "bytes");
  EXPECT_EQ(records.Find("last"), "bytes");
}

// Distances are measured on a coarser mesh, midpoints on the mesh itself.
TEST_F(RecordsTest, DamageIsCountedOnBothMeshes) {
  options_.resolution = 150;
  options_.geodesic.coarsest = 100;
  options_.threshold = 1e-3;
  options_.depth = 1;
  const ExploreSummary first = Run().summary;
  ASSERT_LT(first.distance_vertices, first.vertices);
  const int distances = 6;  // between four poses
  ASSERT_GT(first.solved, distances);
  for (const fs::path& record : Records()) fs::resize_file(record, 100);
  const ExploreSummary second = Run().summary;
  EXPECT_EQ(second.solved, first.solved);
  EXPECT_EQ(second.damaged, first.solved);
}

// Their names and checksums fit, but no geodesic of these poses has such a result.
TEST_F(RecordsTest, OfOtherShapesOrNegativeLengthsAreSolvedAgain) {
  const ExploreResult first = Run();
  const auto forge = [&](const fs::path& file, double length, int vertices) {
    internal::ArrayWriter arrays;
    arrays.Add("lengths", Eigen::Vector2d(length, 2));
    arrays.Add("shape", Shape(Shape::Zero(3, vertices)));
    const std::string bytes =
        internal::PackArrayFile({"SHAPPAIR", 1, ".geodesic"},
                                {{"digest", file.stem().string()}, {"converged", true}}, arrays);
    File("records/" + file.filename().string(), bytes);
  };
  for (const int vertices : {1, tube_.connectivity->NumVertices() + 1}) {
    for (const fs::path& file : Records()) forge(file, 1, vertices);
    const ExploreResult second = Run();
    EXPECT_EQ(second.summary.damaged, first.summary.solved);
    EXPECT_EQ(second.space.nodes, first.space.nodes);
    EXPECT_EQ(second.space.distances, first.space.distances);
  }
  // Distances have no shape, midpoints one of the mesh's vertices: only the lengths are wrong.
  for (const fs::path& file : Records()) {
    const bool midpoint = fs::file_size(file) > 1000;
    forge(file, -1, midpoint ? tube_.connectivity->NumVertices() : 0);
  }
  EXPECT_EQ(Run().summary.damaged, first.summary.solved);
}

TEST_F(RecordsTest, AreRemovedButNothingElse) {
  options_.depth = 0;
  Run();
  const std::string half = Records()[0].string() + ".part123";
  fs::copy_file(Records()[0], half);
  File("records/notes.txt", "mine");
  RemoveRecords(options_.records);
  ASSERT_EQ(Records().size(), 1u);
  EXPECT_EQ(Records()[0].filename(), "notes.txt");
  fs::remove(Path("records/notes.txt"));
  RemoveRecords(options_.records);
  EXPECT_FALSE(fs::exists(options_.records));
  RemoveRecords(options_.records);
}

}  // namespace
}  // namespace shapespace
