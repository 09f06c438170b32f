#include <shapespace/output/usd.h>

#include <algorithm>
#include <ostream>
#include <string_view>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/atomic_file.h>
#include <shapespace/base/internal/check_range.h>
#include <shapespace/base/internal/extension.h>
#include <shapespace/base/internal/number_chars.h>
#include <shapespace/files/internal/storable.h>
#include <shapespace/output/internal/colour.h>

// Meshes in USD: https://openusd.org/release/api/class_usd_geom_mesh.html

namespace shapespace {
namespace {

/// Writes one layer.
class UsdWriter {
 public:
  UsdWriter(std::ostream* stream, const Path& path, const UsdOptions& options,
            const std::vector<Shape>& shapes, const Eigen::Vector3d& centre)
      : stream_(*stream), path_(path), options_(options), shapes_(shapes), centre_(centre) {
    const std::vector<double>& t = path.parameters;
    const auto codes = static_cast<double>(t.size() - 1);
    for (const double parameter : t) {
      times_.push_back(codes == 0 ? 0 : (parameter - t.front()) / (t.back() - t.front()) * codes);
    }
  }

  void Write() {
    WriteHeader();
    stream_ << "\ndef Xform \"body\"\n{\n    double3 xformOp:translate = ";
    WriteTuple(centre_);
    stream_ << "\n    uniform token[] xformOpOrder = [\"xformOp:translate\"]\n\n"
               "    def Mesh \"mesh\"\n    {\n"
               "        uniform token subdivisionScheme = \"none\"\n"
               "        uniform token orientation = \"rightHanded\"\n";
    WriteFaces();
    WriteSamples("float3[] extent", shapes_.size(), [&](size_t i) {
      Shape corners(3, 2);
      corners << shapes_[i].rowwise().minCoeff(), shapes_[i].rowwise().maxCoeff();
      WriteTuples(corners.cast<float>());
    });
    WriteSamples("point3f[] points", shapes_.size(),
                 [&](size_t i) { WriteTuples(shapes_[i].cast<float>()); });
    options_.colours.empty() ? WriteAppearance() : WriteColours(options_.colours);
    stream_ << "    }\n}\n";
  }

 private:
  void WriteHeader() {
    stream_
        << "#usda 1.0\n(\n    defaultPrim = \"body\"\n    startTimeCode = 0\n    endTimeCode = ";
    WriteNumber(times_.back());
    stream_ << "\n    timeCodesPerSecond = ";
    WriteNumber(options_.fps);
    stream_ << "\n    framesPerSecond = ";
    WriteNumber(options_.fps);
    stream_ << "\n    metersPerUnit = ";
    WriteNumber(options_.unit);
    stream_ << "\n    upAxis = \"" << (options_.up == 'z' ? 'Z' : 'Y') << "\"\n)\n";
  }

  void WriteFaces() {
    const std::vector<int>& begin = path_.metric->connectivity->PolygonBegin();
    std::vector<int> counts;
    for (size_t p = 1; p < begin.size(); ++p) counts.push_back(begin[p] - begin[p - 1]);
    stream_ << "        int[] faceVertexCounts = ";
    WriteList(counts);
    stream_ << "\n        int[] faceVertexIndices = ";
    WriteList(path_.metric->connectivity->Corners());
    stream_ << '\n';
  }

  void WriteAppearance() {
    const Appearance& appearance = path_.appearance;
    if (appearance.vertex_colours.size() > 0) {
      WriteColours({appearance.vertex_colours.topRows(3)});
      if (appearance.vertex_colours.rows() == 4) {
        stream_ << "        float[] primvars:displayOpacity = ";
        WriteList(std::vector<float>(appearance.vertex_colours.row(3).begin(),
                                     appearance.vertex_colours.row(3).end()));
        stream_ << " (\n            interpolation = \"vertex\"\n        )\n";
      }
    }
    if (!appearance.corner_texture.empty()) {
      stream_ << "        texCoord2f[] primvars:st = ";
      WriteTuples(TextureCoordinates());
      stream_ << " (\n            interpolation = \"faceVarying\"\n        )\n"
                 "        int[] primvars:st:indices = ";
      WriteList(TextureIndices());
      stream_ << '\n';
    }
  }

  /// With a coordinate for corners that have none, the last one.
  Eigen::Matrix2Xf TextureCoordinates() const {
    Eigen::Matrix2Xf coordinates = path_.appearance.texture_coordinates.cast<float>();
    coordinates.conservativeResize(2, coordinates.cols() + 1);
    coordinates.rightCols(1).setZero();
    return coordinates;
  }

  std::vector<int> TextureIndices() const {
    std::vector<int> indices = path_.appearance.corner_texture;
    const auto none = static_cast<int>(path_.appearance.texture_coordinates.cols());
    std::replace(indices.begin(), indices.end(), -1, none);
    return indices;
  }

  /// `colours` in sRGB, one for all times or one for each; USD's are linear.
  void WriteColours(const std::vector<Eigen::MatrixXd>& colours) {
    const auto write = [&](size_t i) {
      WriteTuples(colours[i].cast<float>().unaryExpr(&internal::ToLinear).eval());
    };
    constexpr std::string_view kName = "color3f[] primvars:displayColor";
    // A value without a time, for readers that show no colours that change.
    stream_ << "        " << kName << " = ";
    write(0);
    stream_ << " (\n            interpolation = \"vertex\"\n        )\n";
    if (colours.size() > 1) WriteSamples(kName, colours.size(), write);
  }

  /// An attribute with a value, which `write(i)` writes, at the time of each shape.
  template <typename Write>
  void WriteSamples(std::string_view attribute, size_t count, const Write& write) {
    stream_ << "        " << attribute << ".timeSamples = {\n";
    for (size_t i = 0; i < count; ++i) {
      stream_ << "            ";
      WriteNumber(times_[i]);
      stream_ << ": ";
      write(i);
      stream_ << ",\n";
    }
    stream_ << "        }\n";
  }

  /// A list of the matrix' columns.
  template <typename Matrix>
  void WriteTuples(const Matrix& matrix) {
    stream_ << '[';
    for (Eigen::Index i = 0; i < matrix.cols(); ++i) {
      if (i > 0) stream_ << ", ";
      WriteTuple(matrix.col(i));
    }
    stream_ << ']';
  }

  template <typename Vector>
  void WriteTuple(const Vector& vector) {
    stream_ << '(';
    for (Eigen::Index i = 0; i < vector.size(); ++i) {
      if (i > 0) stream_ << ", ";
      WriteNumber(vector[i]);
    }
    stream_ << ')';
  }

  template <typename Number>
  void WriteList(const std::vector<Number>& numbers) {
    stream_ << '[';
    for (size_t i = 0; i < numbers.size(); ++i) {
      if (i > 0) stream_ << ", ";
      WriteNumber(numbers[i]);
    }
    stream_ << ']';
  }

  /// With the fewest digits from which exactly the same number is read back.
  template <typename Number>
  void WriteNumber(Number number) {
    char digits[32];
    const char* end = internal::ToChars(digits, digits + sizeof digits, number);
    stream_.write(digits, end - digits);
  }

  std::ostream& stream_;
  const Path& path_;
  const UsdOptions& options_;
  const std::vector<Shape>& shapes_;  // relative to the centre
  const Eigen::Vector3d centre_;
  std::vector<double> times_;
};

std::vector<std::string> NotKeptByUsd(const Path& path, const UsdOptions& options) {
  const Appearance& appearance = path.appearance;
  std::string names;
  const auto add = [&names](bool present, const char* what) {
    if (present) names += (names.empty() ? "" : ", ") + std::string(what);
  };
  add(!appearance.materials.of_polygon.empty() && options.colours.empty(), "materials");
  add(!appearance.groups.of_polygon.empty(), "groups");
  add(!appearance.objects.of_polygon.empty(), "objects");
  add(!path.metric->connectivity->Segments().empty(), "segments");
  if (names.empty()) return {};
  return {names + " are dropped; frames in OBJ keep them"};
}

void CheckColours(const Path& path, const std::vector<Eigen::MatrixXd>& colours) {
  if (colours.size() > 1 && colours.size() != path.shapes.size()) {
    throw InvalidOptions("colours", "there must be one matrix, or as many as shapes");
  }
  for (const Eigen::MatrixXd& of_shape : colours) {
    if (of_shape.rows() != 3 || of_shape.cols() != path.shapes[0].cols() ||
        !(of_shape.array() >= 0).all() || !(of_shape.array() <= 1).all()) {
      throw InvalidOptions("colours", "must be 3 numbers from 0 to 1 for every vertex");
    }
  }
}

}  // namespace

void UsdOptions::Validate() const {
  internal::CheckRange("fps", fps, 0.01, 1000.0);
  if (up != 'y' && up != 'z') throw InvalidOptions("up", "must be 'y' or 'z'");
  internal::CheckRange("unit", unit, 1e-12, 1e12);
}

std::vector<std::string> WriteUsd(const std::string& file, const Path& path,
                                  const UsdOptions& options) {
  options.Validate();
  if (internal::FileExtension(file) != ".usda") {
    throw FileError(file + ": the text form of USD must end in .usda; rename it");
  }
  path.Validate();
  const Connectivity& connectivity = *path.metric->connectivity;
  path.appearance.Validate(connectivity.NumVertices(), connectivity.NumPolygons(),
                           static_cast<int>(connectivity.Corners().size()));
  CheckColours(path, options.colours);
  if (connectivity.NumPolygons() == 0) {
    throw MeshError(file +
                    ": the mesh has no polygons, and a .usda of lines alone is not written; "
                    "write .glb or .vtp");
  }
  std::vector<Shape> shapes = path.Placed();
  const Eigen::Vector3d centre =
      (shapes[0].rowwise().minCoeff() + shapes[0].rowwise().maxCoeff()) / 2;
  for (Shape& shape : shapes) {
    internal::CheckFinite(file, shape);
    shape.colwise() -= centre;
    internal::CheckSinglePrecision(file, shape);
  }
  internal::WriteFileAtomically(file, [&](std::ostream& stream) {
    UsdWriter(&stream, path, options, shapes, centre).Write();
  });
  return NotKeptByUsd(path, options);
}

}  // namespace shapespace
