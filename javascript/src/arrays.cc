#include "arrays.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <regex>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/mesh/arrays.h>

namespace shapespace::javascript {
namespace {

bool IsMissing(const val& value) { return value.isUndefined() || value.isNull(); }

// A copy of an array as one of JavaScript's, of the class `name`.
template <typename Number>
val TypedArray(const char* name, size_t count, const Number* numbers) {
  return val::global(name).new_(val(emscripten::typed_memory_view(count, numbers)));
}

// Files lie in a folder of their own, which is in memory.
class UploadedFiles {
 public:
  UploadedFiles() {
    std::filesystem::remove_all(kFolder);
    std::filesystem::create_directory(kFolder);
  }
  UploadedFiles(const UploadedFiles&) = delete;
  ~UploadedFiles() {
    std::error_code ignored;
    std::filesystem::remove_all(kFolder, ignored);
  }

  static constexpr const char* kFolder = "/files";

  // Two files may have one name, but not one place.
  std::string Add(const std::string& name, const std::string& bytes) {
    const std::filesystem::path folder = std::filesystem::path(kFolder) / std::to_string(++count_);
    std::filesystem::create_directory(folder);
    const std::filesystem::path file = folder / std::filesystem::path(name).filename();
    std::ofstream(file, std::ios::binary) << bytes;
    return file.string();
  }

 private:
  int count_ = 0;
};

Soup ToSoup(const val& pose, const Eigen::Matrix3Xi& triangles, const std::string& name) {
  return MakeSoup(ToShape(pose["positions"], name + ".positions"), triangles, Layout::kColumns,
                  IsMissing(pose["name"]) ? name : pose["name"].as<std::string>());
}

Eigen::Matrix3Xi ToTriangles(const val& indices, const std::string& name) {
  if (IsMissing(indices)) {
    throw InvalidOptions(name,
                         "is missing: three indices of vertices for each triangle. A geometry "
                         "without an index has every vertex several times: merge them first");
  }
  const std::vector<int> corners = ToIntegers(indices, name);
  if (corners.size() % 3 != 0) {
    throw InvalidOptions(name, "must have three indices for each triangle, and has " +
                                   std::to_string(corners.size()));
  }
  return Eigen::Map<const Eigen::Matrix3Xi>(corners.data(), 3, corners.size() / 3);
}

}  // namespace

std::vector<double> ToNumbers(const val& numbers, const std::string& name) {
  if (!numbers.isArray() && !val::global("ArrayBuffer").call<bool>("isView", numbers)) {
    throw InvalidOptions(name, "must be an array of numbers");
  }
  return emscripten::convertJSArrayToNumberVector<double>(numbers);
}

Shape ToShape(const val& positions, const std::string& name) {
  const std::vector<double> numbers = ToNumbers(positions, name);
  if (numbers.size() % 3 != 0) {
    throw InvalidOptions(name, "must have three coordinates for each vertex, and has " +
                                   std::to_string(numbers.size()) + " numbers");
  }
  return Eigen::Map<const Shape>(numbers.data(), 3, numbers.size() / 3);
}

std::vector<int> ToIntegers(const val& numbers, const std::string& name) {
  const std::vector<double> values = ToNumbers(numbers, name);
  std::vector<int> integers(values.size());
  for (size_t i = 0; i < values.size(); ++i) {
    const bool fits = std::floor(values[i]) == values[i] &&
                      std::abs(values[i]) <= std::numeric_limits<int>::max();
    if (!fits) {
      throw InvalidOptions(name + "[" + std::to_string(i) + "]", "must be a whole number");
    }
    integers[i] = static_cast<int>(values[i]);
  }
  return integers;
}

Poses ToPoses(const val& poses, const ReadOptions& options) {
  if (!poses.isArray()) throw InvalidOptions("poses", "must be an array");
  const int count = poses["length"].as<int>();
  UploadedFiles uploaded;
  std::vector<Soup> soups;
  Eigen::Matrix3Xi triangles;
  for (int i = 0; i < count; ++i) {
    const val pose = poses[i];
    const std::string name = "poses[" + std::to_string(i) + "]";
    if (!IsMissing(pose["data"])) {
      const std::string file =
          uploaded.Add(pose["name"].as<std::string>(), ToBytes(pose["data"], name + ".data"));
      for (Soup& soup : ReadSoups(file)) soups.push_back(std::move(soup));
    } else {
      if (i == 0 || !IsMissing(pose["indices"])) {
        triangles = ToTriangles(pose["indices"], name + ".indices");
      }
      soups.push_back(ToSoup(pose, triangles, name));
    }
  }
  return MakePoses(std::move(soups), options);
}

val FromShape(const Shape& shape) { return TypedArray("Float64Array", shape.size(), shape.data()); }

val FromNumbers(const std::vector<double>& numbers) {
  return TypedArray("Float64Array", numbers.size(), numbers.data());
}

val IndicesOf(const Connectivity& connectivity) {
  const Eigen::Matrix3Xi& triangles = connectivity.Triangles();
  return TypedArray("Uint32Array", triangles.size(), triangles.data());
}

val FromStrings(const std::vector<std::string>& strings) {
  val array = val::array();
  for (const std::string& string : strings) array.call<void>("push", WithoutFolder(string));
  return array;
}

val FromPath(const Path& path) {
  val result = val::object(), shapes = val::array(), poses = val::array();
  for (int i = 0; i < path.NumShapes(); ++i) shapes.call<void>("push", FromShape(path.Placed(i)));
  for (const int pose : path.poses) poses.call<void>("push", pose);
  result.set("indices", IndicesOf(*path.metric->connectivity));
  result.set("shapes", shapes);
  result.set("times", FromNumbers(path.parameters));
  result.set("poses", poses);
  result.set("names", FromStrings(path.pose_names));
  result.set("converged", path.converged);
  return result;
}

std::string WithoutFolder(const std::string& sentence) {
  static const std::regex folder(std::string(UploadedFiles::kFolder) + "/[0-9]+/");
  return std::regex_replace(sentence, folder, "");
}

val FromBytes(const std::string& bytes) {
  return TypedArray("Uint8Array", bytes.size(),
                    reinterpret_cast<const std::uint8_t*>(bytes.data()));
}

std::string ToBytes(const val& bytes, const std::string& name) {
  if (!bytes.instanceof (val::global("Uint8Array"))) {
    throw InvalidOptions(name, "must be a Uint8Array");
  }
  const auto content = emscripten::convertJSArrayToNumberVector<std::uint8_t>(bytes);
  return {content.begin(), content.end()};
}

}  // namespace shapespace::javascript
