#include <shapespace/output/vtk.h>

#include <cstdint>
#include <cstring>
#include <regex>

#include <shapespace/analysis/quality.h>
#include <shapespace/analysis/vertex_energy.h>
#include <shapespace/base/error.h>
#include <shapespace/files/read.h>
#include <shapespace/files/vertex_field.h>

#include "mesh/bodies.h"
#include "mesh/files.h"
#include "support/path_of.h"

namespace shapespace {
namespace {

/// The arrays of a .vtp file, found by the offsets that its XML tells.
class Vtp {
 public:
  explicit Vtp(const std::string& file) : bytes_(testing::Content(file)) {
    data_ = bytes_.find("<AppendedData encoding=\"raw\">_") + 30;
  }

  /// All numbers of the array with this name, the `skip`-th from the beginning.
  template <typename Number>
  std::vector<Number> Array(const std::string& name, int skip = 0) const {
    const std::regex tag("<DataArray type=\"([A-Za-z0-9]+)\" Name=\"" + name +
                         "\"[^>]* offset=\"([0-9]+)\"/>");
    std::sregex_iterator match(bytes_.begin(), bytes_.begin() + data_, tag);
    for (; skip > 0; --skip) ++match;
    EXPECT_EQ((*match)[1], sizeof(Number) == 8 ? "Float64" : "Int32");
    const size_t at = data_ + std::stoul((*match)[2]);
    std::uint64_t size;
    std::memcpy(&size, &bytes_.at(at), 8);
    std::vector<Number> numbers(size / sizeof(Number));
    if (size > 0) std::memcpy(numbers.data(), &bytes_.at(at + 8), size);
    return numbers;
  }

  std::string Attribute(const std::string& name) const {
    std::smatch match;
    std::regex_search(bytes_, match, std::regex(name + "=\"([^\"]*)\""));
    return match[1];
  }

 private:
  const std::string bytes_;
  size_t data_;
};

std::vector<double> Numbers(const Eigen::VectorXd& vector) {
  return {vector.begin(), vector.end()};
}

class VtkTest : public testing::FilesTest {};

TEST_F(VtkTest, EveryShapeHasItsPointsCellsAndData) {
  Soup cube = testing::Cube();
  cube.segments = {{0, 7}};
  Shape larger = 2 * cube.vertices, bent = cube.vertices;
  bent.col(7) << 1.3, 1.2, 2;
  shapespace::Path path =
      testing::PathOf(testing::Connected(cube), {cube.vertices, bent, larger.array() + 1e6});
  path.parameters = {0, 0.25, 1};
  WriteVtkSeries(Path("%d.vtp"), path);
  const std::vector<Eigen::VectorXd> energies = VertexEnergy(path);
  for (int i = 0; i < 3; ++i) {
    const Vtp file(Path(std::to_string(i) + ".vtp"));
    const Shape placed = path.Placed(i);
    EXPECT_EQ(file.Array<double>("Points"),
              std::vector<double>(placed.data(), placed.data() + placed.size()));
    EXPECT_EQ(file.Array<double>("deviation"), Numbers(EdgeDeviation(path, i)));
    EXPECT_EQ(file.Array<double>("energy"), Numbers(energies[i]));
    EXPECT_EQ(file.Array<double>("TimeValue"), std::vector<double>{path.parameters[i]});
    EXPECT_EQ(file.Array<int>("connectivity", 0), (std::vector<int>{0, 7}));
    EXPECT_EQ(file.Array<int>("offsets", 0), std::vector<int>{2});
    EXPECT_EQ(file.Array<int>("connectivity", 1), cube.corners);
    EXPECT_EQ(file.Array<int>("offsets", 1), (std::vector<int>{4, 8, 12, 16, 20, 24}));
    EXPECT_EQ(file.Attribute("NumberOfPoints"), "8");
    EXPECT_EQ(file.Attribute("NumberOfLines"), "1");
    EXPECT_EQ(file.Attribute("NumberOfPolys"), "6");
  }
}

TEST_F(VtkTest, DeviationsAreFromTheReference) {
  const Soup cube = testing::Cube();
  Shape bent = cube.vertices;
  bent.col(7) << 1.3, 1.2, 2;
  const shapespace::Path path = testing::PathOf(testing::Connected(cube), {cube.vertices, bent});
  WriteVtkSeries(Path("%d.vtp"), path, path.shapes[1]);
  const auto deviation = [&](const char* file) {
    return Vtp(Path(file)).Array<double>("deviation");
  };
  EXPECT_EQ(deviation("0.vtp"),
            Numbers(EdgeDeviation(*path.metric, path.shapes[1], path.shapes[0])));
  EXPECT_GT(deviation("0.vtp")[7], 0.2);
  EXPECT_EQ(deviation("1.vtp"), std::vector<double>(8, 0));
}

// The reader, which follows the format's description, reads what was written.
TEST_F(VtkTest, SeriesAreReadBackExactly) {
  Soup cube = testing::Cube();
  cube.segments = {{0, 7}};
  Shape bent = cube.vertices;
  bent.col(7) << 1.3, 1.2, 2;
  const shapespace::Path path =
      testing::PathOf(testing::Connected(cube), {cube.vertices, bent.array() + 1e6});
  WriteVtkSeries(Path("%d.vtp"), path);
  for (int i = 0; i < 2; ++i) {
    const std::string file = Path(std::to_string(i) + ".vtp");
    const Soup read = ReadSoup(file);
    EXPECT_EQ(read.vertices, path.Placed(i));
    EXPECT_EQ(read.corners, cube.corners);
    EXPECT_EQ(read.polygon_begin, cube.polygon_begin);
    EXPECT_EQ(read.segments, cube.segments);
    EXPECT_EQ(ReadVertexField(file + ":deviation"), EdgeDeviation(path, i));
  }
}

TEST_F(VtkTest, TheRigidMetricHasNoEnergyOfVertices) {
  const Soup cube = testing::Cube();
  const Shape larger = 2 * cube.vertices;
  const auto connectivity = testing::Connected(cube);
  const auto metric = FreezeMetric(MetricOptions::Rigid(), connectivity, {cube.vertices, larger});
  WriteVtkSeries(Path("%d.vtp"), MakePath(metric, {cube.vertices, larger}));
  EXPECT_EQ(testing::Content(Path("1.vtp")).find("energy"), std::string::npos);
  EXPECT_EQ(Vtp(Path("1.vtp")).Array<double>("deviation").size(), 8u);
}

TEST_F(VtkTest, NamesNeedANumber) {
  const Soup cube = testing::Cube();
  const auto path = testing::PathOf(testing::Connected(cube), {cube.vertices, 2 * cube.vertices});
  EXPECT_THROW(WriteVtkSeries(Path("all.vtp"), path), FileError);
}

}  // namespace
}  // namespace shapespace
