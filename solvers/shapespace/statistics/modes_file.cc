#include <shapespace/statistics/modes_file.h>

#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/statistics/internal/modes_arrays.h>

namespace shapespace {
namespace {

constexpr internal::ArrayFileKind kModesKind = {"SHAPMODE", 1, ".modes"};

}  // namespace

void WriteModes(const std::string& file, const PoseModes& modes) {
  try {
    modes.Validate();
  } catch (const MeshError& error) {
    throw MeshError(file + ": " + error.what());
  }
  internal::HeaderJson header;
  internal::ArrayWriter arrays;
  internal::AddModes(modes, file, &header, &arrays);
  internal::WriteArrayFile(file, kModesKind, std::move(header), arrays);
}

PoseModes ReadModes(const std::string& file) {
  return internal::ReadArrayFile(
      file, kModesKind,
      [&](const internal::HeaderJson& header, const internal::ArrayReader& arrays) {
        return internal::ReadModes(file, header, arrays);
      });
}

}  // namespace shapespace
