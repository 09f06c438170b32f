#include <shapespace/path/path_file.h>

#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/path/internal/path_arrays.h>

namespace shapespace {
namespace {

using internal::ArrayReader;
using internal::ArrayWriter;
using internal::HeaderJson;

constexpr internal::ArrayFileKind kKind = {"SHAPPATH", 1, ".path"};

}  // namespace

void WritePath(const std::string& file, const Path& path) {
  try {
    path.Validate();
  } catch (const MeshError& error) {
    throw MeshError(file + ": " + error.what());
  }
  HeaderJson header;
  ArrayWriter arrays;
  internal::AddPath(path, file, &header, &arrays);
  internal::WriteArrayFile(file, kKind, std::move(header), arrays);
}

Path ReadPath(const std::string& file) {
  return internal::ReadArrayFile(file, kKind,
                                 [&](const HeaderJson& header, const ArrayReader& arrays) {
                                   return internal::ReadPath(file, header, arrays);
                                 });
}

}  // namespace shapespace
