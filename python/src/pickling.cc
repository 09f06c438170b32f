#include "pickling.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include <shapespace/exploration/internal/space_arrays.h>
#include <shapespace/output/frames.h>
#include <shapespace/path/internal/path_arrays.h>
#include <shapespace/statistics/internal/modes_arrays.h>

#include "bind.h"

namespace shapespace::python {
namespace {

using internal::ArrayReader;
using internal::ArrayWriter;
using internal::HeaderJson;

constexpr internal::ArrayFileKind kKind = {"SHAPPICK", 1, "pickle"};
// Names of folders relative to this one are absolute but for their first letter.
constexpr char kFile[] = "/pickle";

// The folder that libraries must lie in is not that of the pickle.
void AddOwnFolder(const Appearance& appearance, HeaderJson* header) {
  const auto folder = std::filesystem::current_path() / appearance.own_folder;
  (*header)["own_folder"] = internal::NamesToJson({folder.string()});
}

void ReadOwnFolder(const HeaderJson& header, Appearance* appearance) {
  appearance->own_folder = internal::NamesFromJson(header.at("own_folder")).at(0);
}

void Add(const Path& path, HeaderJson* header, ArrayWriter* arrays) {
  internal::AddPath(path, kFile, header, arrays);
  AddOwnFolder(path.appearance, header);
}

void Read(const HeaderJson& header, const ArrayReader& arrays, Path* path) {
  *path = internal::ReadPath(kFile, header, arrays);
  ReadOwnFolder(header, &path->appearance);
}

void Add(const PoseSpace& space, HeaderJson* header, ArrayWriter* arrays) {
  internal::AddSpace(space, kFile, header, arrays);
  AddOwnFolder(space.appearance, header);
}

void Read(const HeaderJson& header, const ArrayReader& arrays, PoseSpace* space) {
  *space = internal::ReadSpace(kFile, header, arrays);
  ReadOwnFolder(header, &space->appearance);
}

void Add(const PoseModes& modes, HeaderJson* header, ArrayWriter* arrays) {
  internal::AddModes(modes, kFile, header, arrays);
  AddOwnFolder(modes.appearance, header);
}

void Read(const HeaderJson& header, const ArrayReader& arrays, PoseModes* modes) {
  *modes = internal::ReadModes(kFile, header, arrays);
  ReadOwnFolder(header, &modes->appearance);
}

void Add(const FrozenMetric& frozen, HeaderJson* header, ArrayWriter* arrays) {
  internal::AddMetric(*frozen.metric, header, arrays);
}

void Read(const HeaderJson& header, const ArrayReader& arrays, FrozenMetric* frozen) {
  frozen->metric = internal::ReadMetric(header, arrays);
}

void Add(const Poses& poses, HeaderJson* header, ArrayWriter* arrays) {
  internal::AddConnectivity(*poses.connectivity, header, arrays);
  internal::AddAppearance(poses.soup.appearance, kFile, header, arrays);
  AddOwnFolder(poses.soup.appearance, header);
  for (size_t i = 0; i < poses.shapes.size(); ++i) {
    arrays->AddReference("shape" + std::to_string(i), poses.shapes[i]);
  }
  (*header)["shapes"] = poses.shapes.size();
  (*header)["names"] = internal::NamesToJson(poses.names);
  (*header)["warnings"] = internal::NamesToJson(poses.warnings);
  (*header)["notes"] = internal::NamesToJson(poses.notes);
  (*header)["dropped"] = internal::NamesToJson(poses.soup.dropped);
  (*header)["file"] = internal::NamesToJson({poses.soup.file, poses.soup.name});
}

void Read(const HeaderJson& header, const ArrayReader& arrays, Poses* poses) {
  const int num_vertices = header.at("vertices").get<int>();
  const size_t count = header.at("shapes").get<size_t>();
  for (size_t i = 0; i < count; ++i) {
    poses->shapes.push_back(arrays.Get<Shape>("shape" + std::to_string(i), 3, num_vertices));
  }
  poses->connectivity = internal::ReadConnectivity(num_vertices, arrays);
  Appearance appearance = internal::ReadAppearance(header, kFile, arrays);
  ReadOwnFolder(header, &appearance);
  poses->soup = FrameSoup(*poses->connectivity, appearance);
  poses->soup.vertices = poses->shapes.at(0);
  poses->names = internal::NamesFromJson(header.at("names"));
  poses->warnings = internal::NamesFromJson(header.at("warnings"));
  if (header.contains("notes")) poses->notes = internal::NamesFromJson(header.at("notes"));
  poses->soup.dropped = internal::NamesFromJson(header.at("dropped"));
  const std::vector<std::string> file = internal::NamesFromJson(header.at("file"));
  poses->soup.file = file.at(0);
  poses->soup.name = file.at(1);
}

}  // namespace

template <typename T>
py::bytes Pack(const T& value) {
  HeaderJson header;
  ArrayWriter arrays;
  Add(value, &header, &arrays);
  return internal::PackArrayFile(kKind, std::move(header), arrays);
}

template <typename T>
T Unpack(const py::bytes& bytes) {
  const std::string content = bytes;
  size_t begin;
  const HeaderJson header = internal::UnpackHeader(kKind, content, &begin);
  T value;
  Read(header, ArrayReader(header.at("arrays"), content, begin), &value);
  return value;
}

template py::bytes Pack(const Path&);
template py::bytes Pack(const PoseSpace&);
template py::bytes Pack(const PoseModes&);
template py::bytes Pack(const Poses&);
template py::bytes Pack(const FrozenMetric&);
template Path Unpack(const py::bytes&);
template PoseSpace Unpack(const py::bytes&);
template PoseModes Unpack(const py::bytes&);
template Poses Unpack(const py::bytes&);
template FrozenMetric Unpack(const py::bytes&);

}  // namespace shapespace::python
