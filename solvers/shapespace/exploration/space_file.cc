#include <shapespace/exploration/space_file.h>

#include <algorithm>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/json.h>
#include <shapespace/base/internal/quoted.h>
#include <shapespace/base/internal/read_file.h>
#include <shapespace/exploration/internal/space_arrays.h>

namespace shapespace {
namespace {

using internal::ArrayReader;
using internal::ArrayWriter;
using internal::HeaderJson;

constexpr internal::ArrayFileKind kKind = {"SHAPPLAN", 1, ".space"};

Eigen::Vector2d PointFrom(const internal::Json& entry, const PoseSpace& space,
                          const std::string& field) {
  if (entry.is_string()) {
    const std::string name = entry.get<std::string>();
    const auto found = std::find(space.names.begin(), space.names.end(), name);
    if (found == space.names.end()) {
      internal::FailIn(field, internal::Quoted(name) + " is not a pose of the space");
    }
    return space.points.col(found - space.names.begin());
  }
  if (!entry.is_array() || entry.size() != 2) {
    internal::FailIn(field, "must be two numbers, or the name of a pose");
  }
  return {internal::NumberFrom(entry[0], field), internal::NumberFrom(entry[1], field)};
}

}  // namespace

void WriteSpace(const std::string& file, const PoseSpace& space) {
  try {
    space.Validate();
  } catch (const MeshError& error) {
    throw MeshError(file + ": " + error.what());
  }
  HeaderJson header;
  ArrayWriter arrays;
  internal::AddSpace(space, file, &header, &arrays);
  internal::WriteArrayFile(file, kKind, std::move(header), arrays);
}

PoseSpace ReadSpace(const std::string& file) {
  return internal::ReadArrayFile(file, kKind,
                                 [&](const HeaderJson& header, const ArrayReader& arrays) {
                                   return internal::ReadSpace(file, header, arrays);
                                 });
}

std::vector<Eigen::Vector2d> ReadCurve(const std::string& file, const PoseSpace& space) {
  const std::string text = internal::ReadFile(file);
  try {
    const internal::Json json = internal::ParseJson(text);
    internal::CheckKeys(json, "", {"points", "$schema"});
    const internal::Json& entries =
        internal::ListFrom(internal::Required(json, "", "points"), "points");
    std::vector<Eigen::Vector2d> points;
    for (size_t i = 0; i < entries.size(); ++i) {
      const std::string field = "points (point " + std::to_string(i + 1) + ")";
      points.push_back(PointFrom(entries[i], space, field));
    }
    return points;
  } catch (const InvalidOptions& error) {
    throw FileError(file + ": " + error.what());
  }
}

}  // namespace shapespace
