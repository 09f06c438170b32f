#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/path/internal/array_file.h>
#include <shapespace/path/path_file.h>

#include "support/features.h"
#include "support/message_of.h"
#include "support/own_features.h"
#include "support/temporary_file.h"

namespace shapespace {
namespace {

using internal::ArrayReader;
using internal::ArrayWriter;
using internal::HeaderJson;
using testing::MessageOf;
using testing::Names;
using testing::Refuses;
using testing::TemporaryFile;

constexpr internal::ArrayFileKind kKind = {"SHAPTEST", 0x01020304, ".test"};

// A path in which no two numbers of one kind are equal.
Path GenericPath(const MetricOptions& options) {
  const ShapeFamily bar = MakeBar(4, 1, 1, 3, 1, 1);
  const int count = bar.connectivity->NumVertices();
  const auto connectivity =
      Connectivity::Make(count, bar.connectivity->PolygonBegin(), bar.connectivity->Corners(),
                         {{1, 6}, {9, 2}}, {{0, 7}});
  std::vector<Shape> shapes;
  for (int i = 0; i < 3; ++i) shapes.push_back(bar.pose(20 * i) + 0.01 * Shape::Random(3, count));
  Path path;
  path.metric = FreezeMetric(options, connectivity, shapes);
  path.shapes = shapes;
  path.motions.resize(3);
  for (int i = 0; i < 3; ++i) path.motions[i].translation = {i + 0.5, -i - 1.0, 3.0 * i};
  path.motions[1].rotation << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  path.parameters = {-0.5, 0.25, 2};
  path.poses = {1, 2};
  path.pose_names = {"sit", "l\xe9ve"};
  path.converged = true;
  path.smooth = true;
  path.provenance = "generic";
  return path;
}

TEST(PathFile, KeepsEveryFieldOfTheMetric) {
  testing::RegisterOwnFeatures();
  MetricOptions options;
  options.isometric = 0.11;
  options.strain = 0.23;
  options.rigid = 0.31;
  options.lambda = 0.43;
  options.bending = 0.59;
  options.volume = 0.67;
  options.features = {{"own strain", 0.71}, {"height", 0.83}};
  options.weights = Weighting::kUniform;
  const std::string file = TemporaryFile("fields.path");
  const Path path = GenericPath(options);
  WritePath(file, path);
  const Path read = ReadPath(file);
  const MetricOptions& own = read.metric->options;
  EXPECT_EQ(own.isometric, 0.11);
  EXPECT_EQ(own.strain, 0.23);
  EXPECT_EQ(own.rigid, 0.31);
  EXPECT_EQ(own.lambda, 0.43);
  EXPECT_EQ(own.bending, 0.59);
  EXPECT_EQ(own.volume, 0.67);
  ASSERT_EQ(own.features.size(), 2u);
  EXPECT_EQ(own.features[0].name, "own strain");
  EXPECT_EQ(own.features[1].name, "height");
  EXPECT_EQ(own.features[0].coefficient, 0.71);
  EXPECT_EQ(own.features[1].coefficient, 0.83);
  EXPECT_EQ(own.weights, Weighting::kUniform);
  EXPECT_EQ(own.discretization, Discretization::kMidpoint);
  EXPECT_EQ(read.metric->unit, path.metric->unit);
  EXPECT_NE(path.metric->unit, 1);
  EXPECT_EQ(read.metric->vertex_area, path.metric->vertex_area);
  EXPECT_EQ(read.metric->edge_area, path.metric->edge_area);
  EXPECT_EQ(read.metric->hinge_area, path.metric->hinge_area);
  EXPECT_EQ(read.metric->rigid.weights, path.metric->rigid.weights);
  ASSERT_EQ(read.metric->features.size(), path.metric->features.size());
  for (size_t i = 0; i < read.metric->features.size(); ++i) {
    const Feature &found = *read.metric->features[i], &given = *path.metric->features[i];
    EXPECT_EQ(found.Name(), given.Name());
    EXPECT_EQ(found.Weights(), given.Weights());
    EXPECT_EQ(found.Constants(), given.Constants());
    ASSERT_EQ(found.NumElements(), given.NumElements());
    for (int e = 0; e < found.NumElements(); ++e) {
      for (int k = 0; k < found.VerticesPerElement(); ++k) {
        EXPECT_EQ(found.Element(e)[k], given.Element(e)[k]);
      }
      ASSERT_EQ(found.NumbersPerElement(), given.NumbersPerElement());
      for (int k = 0; k < found.NumbersPerElement(); ++k) {
        EXPECT_EQ(found.Numbers(e)[k], given.Numbers(e)[k]);
      }
    }
  }
  const Connectivity &a = *read.metric->connectivity, &b = *path.metric->connectivity;
  EXPECT_EQ(a.PolygonBegin(), b.PolygonBegin());
  EXPECT_EQ(a.Triangles(), b.Triangles());
  EXPECT_EQ(a.Segments(), b.Segments());
  EXPECT_EQ(a.Edges(), b.Edges());
  EXPECT_TRUE(read.smooth);
  EXPECT_TRUE(read.converged);
  EXPECT_EQ(read.poses, (std::vector<int>{1, 2}));
  EXPECT_EQ(read.pose_names, path.pose_names);
  EXPECT_EQ(read.extrapolated, 0);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(read.motions[i].rotation, path.motions[i].rotation);
    EXPECT_EQ(read.motions[i].translation, path.motions[i].translation);
  }
}

TEST(PathFile, KeepsTheDiscretizationOfThePaper) {
  const std::string file = TemporaryFile("trapezoid.path");
  Path path = GenericPath(MetricOptions::Paper());
  path.smooth = false;
  WritePath(file, path);
  const Path read = ReadPath(file);
  EXPECT_EQ(read.metric->options.discretization, Discretization::kTrapezoid);
  EXPECT_EQ(read.metric->options.weights, path.metric->options.weights);
  EXPECT_FALSE(read.smooth);
}

// The two fields belong to different elements, and their numbers differ.
TEST(PathFile, KeepsBothStiffnesses) {
  MetricOptions options;
  const ShapeFamily bar = MakeBar(4, 1, 1, 3, 1, 1);
  const int vertices = bar.connectivity->NumVertices();
  options.stretching_stiffness = Eigen::VectorXd::LinSpaced(vertices, 1, 2);
  options.bending_stiffness = Eigen::VectorXd::LinSpaced(vertices, 5, 3);
  const std::string file = TemporaryFile("both.path");
  WritePath(file, GenericPath(options));
  const MetricOptions read = ReadPath(file).metric->options;
  EXPECT_EQ(read.stretching_stiffness, options.stretching_stiffness);
  EXPECT_EQ(read.bending_stiffness, options.bending_stiffness);
}

TEST(PathFile, MessagesNameTheFieldOfTheMetric) {
  MetricOptions options;
  options.rigid = 0.2;
  const std::string file = TemporaryFile("damaged_metric.path");
  const auto message = [&](const std::function<void(Metric*)>& damage) {
    Path path = GenericPath(options);
    auto metric = std::make_shared<Metric>(*path.metric);
    damage(metric.get());
    path.metric = metric;
    WritePath(file, path);
    return MessageOf<FileError>([&] { ReadPath(file); });
  };
  EXPECT_EQ(message([](Metric*) {}), "nothing was thrown");
  for (const double unit : {0.0, -1.0}) {
    EXPECT_TRUE(Names(message([&](Metric* m) { m->unit = unit; }), {file, "unit"}));
  }
  const auto negative = [&](const std::string& name) {
    return file + ": its array " + name + " holds a negative number";
  };
  EXPECT_EQ(message([](Metric* m) { m->vertex_area(3) = -1e-9; }), negative("vertex_area"));
  EXPECT_EQ(message([](Metric* m) { m->edge_area(3) = -1e-9; }), negative("edge_area"));
  EXPECT_EQ(message([](Metric* m) { m->hinge_area(3) = -1e-9; }), negative("hinge_area"));
  EXPECT_EQ(message([](Metric* m) { m->rigid.weights(3) = -1e-9; }), negative("rigid_weights"));
  EXPECT_TRUE(Names(message([](Metric* m) { m->rigid.weights.conservativeResize(5); }),
                    {file, "rigid_weights"}));
  EXPECT_TRUE(
      Names(message([](Metric* m) { m->hinge_area(0) = std::nan(""); }), {file, "hinge_area"}));
  EXPECT_TRUE(
      Names(message([](Metric* m) { m->edge_area.conservativeResize(5); }), {file, "edge_area"}));
  EXPECT_TRUE(Names(message([](Metric* m) { m->options.bending_stiffness.setOnes(5); }),
                    {file, "bending_stiffness"}));
}

TEST(ArrayFile, HoldsArraysOfBothTypesInTheirOrder) {
  const std::string file = TemporaryFile("arrays.test");
  const Eigen::MatrixXd numbers{{1, 2.5, -3}, {4, 5, 6e-300}};
  const Eigen::MatrixXi indices{{7}, {-8}, {9}};
  const Eigen::MatrixXd nothing(3, 0);
  ArrayWriter arrays;
  arrays.Add("indices", indices);
  arrays.AddReference("nothing", nothing);
  arrays.AddReference("numbers", numbers);
  const int more[] = {10, 11, 12, 13, 14, 15};
  arrays.Add("more", more, 3, 2);
  internal::WriteArrayFile(file, kKind, {{"title", "x"}, {"count", 3}}, arrays);
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  EXPECT_EQ(internal::PackArrayFile(kKind, {{"title", "x"}, {"count", 3}}, arrays), bytes);
  EXPECT_EQ(bytes.substr(0, 8), "SHAPTEST");
  size_t begin = 0;
  internal::UnpackHeader(kKind, bytes, &begin);
  EXPECT_EQ(begin % 8, 0u);
  EXPECT_EQ(bytes.size() - begin, 3u * 4 + 6 * 8 + 6 * 4);
  internal::ReadArrayFile(file, kKind, [&](const HeaderJson& header, const ArrayReader& read) {
    EXPECT_EQ(header.at("title"), "x");
    EXPECT_EQ(internal::CountFrom(header, "count"), 3);
    EXPECT_EQ(read.Get<Eigen::MatrixXd>("numbers", 2, 3), numbers);
    EXPECT_EQ(read.Get<Eigen::MatrixXi>("indices", Eigen::Dynamic, 1), indices);
    EXPECT_EQ(internal::IndicesFrom(read, "indices"), (std::vector<int>{7, -8, 9}));
    EXPECT_EQ(read.Get<Eigen::MatrixXd>("nothing", 3, Eigen::Dynamic).cols(), 0);
    EXPECT_EQ(read.Get<Eigen::MatrixXi>("more", 3, 2)(0, 1), 13);
    EXPECT_TRUE(read.Has("more"));
    EXPECT_FALSE(read.Has("less"));
    const std::string wrong = "its array numbers has the wrong type or size";
    EXPECT_EQ(MessageOf<FileError>([&] { read.Get<Eigen::MatrixXd>("numbers", 3, 3); }), wrong);
    EXPECT_EQ(MessageOf<FileError>([&] { read.Get<Eigen::MatrixXd>("numbers", 2, 2); }), wrong);
    EXPECT_EQ(MessageOf<FileError>([&] { read.Get<Eigen::MatrixXi>("numbers", 2, 3); }), wrong);
    EXPECT_TRUE(Refuses<FileError>([&] { read.Get<Eigen::MatrixXd>("less", 2, 3); }, {"less"}));
    return 0;
  });
}

TEST(ArrayFile, MessagesSayWhatIsWrong) {
  const internal::ArrayFileKind other = {"SHAPOTHR", kKind.version, ".other"};
  const internal::ArrayFileKind later = {"SHAPTEST", 7, ".test"};
  ArrayWriter arrays;
  arrays.Add("a", Eigen::VectorXd(Eigen::Vector3d(1, 2, 3)));
  const std::string bytes = internal::PackArrayFile(kKind, HeaderJson::object(), arrays);
  size_t begin = 0;
  const auto message = [&](const internal::ArrayFileKind& kind, const std::string& content) {
    return MessageOf<FileError>([&] { internal::UnpackHeader(kind, content, &begin); });
  };
  EXPECT_EQ(message(kKind, bytes), "nothing was thrown");
  EXPECT_TRUE(Names(message(other, bytes), {".other"}));
  EXPECT_TRUE(Names(message(kKind, bytes.substr(0, 23)), {".test"}));
  EXPECT_TRUE(Names(message(later, bytes), {"version 16909060", "7"}));
  const std::string damaged =
      "it is damaged or was cut off (its checksum does not fit); make it again";
  EXPECT_EQ(message(kKind, bytes.substr(0, 24)), damaged);
  EXPECT_EQ(message(kKind, bytes.substr(0, bytes.size() - 1)), damaged);
  const HeaderJson table = internal::UnpackHeader(kKind, bytes, &begin).at("arrays");
  const auto of_reader = [&](const std::string& content) {
    return MessageOf<FileError>([&] { ArrayReader(table, content, begin); });
  };
  EXPECT_EQ(of_reader(bytes), "nothing was thrown");
  EXPECT_TRUE(Names(of_reader(bytes.substr(0, bytes.size() - 1)), {"arrays"}));
  EXPECT_TRUE(Names(of_reader(bytes + "x"), {"arrays"}));
}

}  // namespace
}  // namespace shapespace
