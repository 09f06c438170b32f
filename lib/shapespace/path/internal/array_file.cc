#include <shapespace/path/internal/array_file.h>

#include <algorithm>
#include <limits>
#include <string_view>
#include <utility>

#include <zlib.h>

#include <shapespace/base/internal/atomic_file.h>
#include <shapespace/base/internal/json.h>

namespace shapespace::internal {
namespace {

constexpr size_t kMagicSize = 8;
// Magic, version, checksum, length of the header.
constexpr size_t kPreamble = kMagicSize + 2 * sizeof(uint32_t) + sizeof(uint64_t);

// The checksum of what `sum` is of, followed by `bytes`.
uint32_t Checksum(uint32_t sum, std::string_view bytes) {
  uLong result = sum;
  while (!bytes.empty()) {
    const size_t count = std::min<size_t>(bytes.size(), 1 << 30);
    result = crc32(result, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(count));
    bytes.remove_prefix(count);
  }
  return static_cast<uint32_t>(result);
}

// All bytes in front of the arrays. The checksum is of what follows it, the arrays included.
std::string Beginning(const ArrayFileKind& kind, HeaderJson header, const ArrayWriter& arrays) {
  header["arrays"] = arrays.Table();
  std::string text = JsonText(header);
  text.resize((text.size() + 7) / 8 * 8, ' ');  // aligns arrays to 8 bytes
  const uint64_t header_size = text.size();
  std::string bytes(kind.magic, kMagicSize);
  bytes.append(reinterpret_cast<const char*>(&kind.version), sizeof kind.version);
  bytes.append(sizeof(uint32_t), '\0');
  bytes.append(reinterpret_cast<const char*>(&header_size), sizeof header_size);
  bytes += text;
  uint32_t checksum =
      Checksum(0, std::string_view(bytes).substr(kMagicSize + 2 * sizeof(uint32_t)));
  arrays.ForBytes([&](std::string_view part) { checksum = Checksum(checksum, part); });
  std::memcpy(&bytes[kMagicSize + sizeof kind.version], &checksum, sizeof checksum);
  return bytes;
}

}  // namespace

ArrayReader::ArrayReader(const HeaderJson& table, const std::string& bytes, size_t begin)
    : bytes_(bytes) {
  for (const HeaderJson& entry : table) {
    Array array;
    array.type = entry.at("type").get<std::string>();
    array.rows = CountFrom(entry, "rows");
    array.columns = CountFrom(entry, "columns");
    array.begin = begin;
    const size_t size = array.type == "f8" ? 8 : 4;
    if (array.columns != 0 && array.rows > (bytes.size() - begin) / size / array.columns) {
      throw FileError("its arrays are longer than the file");
    }
    begin += array.rows * array.columns * size;
    arrays_[entry.at("name").get<std::string>()] = array;
  }
  if (begin != bytes.size()) throw FileError("it is longer than its arrays");
}

std::string PackArrayFile(const ArrayFileKind& kind, HeaderJson header, const ArrayWriter& arrays) {
  std::string bytes = Beginning(kind, std::move(header), arrays);
  arrays.ForBytes([&](std::string_view part) { bytes += part; });
  return bytes;
}

HeaderJson UnpackHeader(const ArrayFileKind& kind, const std::string& bytes, size_t* arrays_begin) {
  if (bytes.size() < kPreamble || std::memcmp(bytes.data(), kind.magic, kMagicSize) != 0) {
    throw FileError(std::string("this is not a ") + kind.name + " file");
  }
  uint32_t version, checksum;
  uint64_t header_size;
  std::memcpy(&version, bytes.data() + 8, sizeof version);
  std::memcpy(&checksum, bytes.data() + 12, sizeof checksum);
  std::memcpy(&header_size, bytes.data() + 16, sizeof header_size);
  if (version != kind.version) {
    throw FileError("version " + std::to_string(version) + " of the format is not read, only " +
                    std::to_string(kind.version) +
                    " is; use the shapespace that wrote it, or make it again with this one");
  }
  if (Checksum(0, std::string_view(bytes).substr(16)) != checksum ||
      header_size > bytes.size() - kPreamble) {
    throw FileError("it is damaged or was cut off (its checksum does not fit); make it again");
  }
  *arrays_begin = kPreamble + header_size;
  return HeaderJson::parse(bytes.substr(kPreamble, header_size));
}

void WriteArrayFile(const std::string& file, const ArrayFileKind& kind, HeaderJson header,
                    const ArrayWriter& arrays) {
  const std::string beginning = Beginning(kind, std::move(header), arrays);
  WriteFileAtomically(file, [&](std::ostream& out) {
    out << beginning;
    arrays.ForBytes([&](std::string_view part) {
      out.write(part.data(), static_cast<std::streamsize>(part.size()));
    });
  });
}

int CountFrom(const HeaderJson& header, const char* name) {
  const HeaderJson& json = header.at(name);
  constexpr int kMax = std::numeric_limits<int>::max();
  if (!json.is_number_unsigned() || json.get<std::uint64_t>() > kMax) {
    throw FileError(std::string(name) + ": must be an integer from 0 to " + std::to_string(kMax));
  }
  return json.get<int>();
}

std::vector<int> IndicesFrom(const ArrayReader& arrays, const std::string& name) {
  const auto column = arrays.Get<Eigen::VectorXi>(name, Eigen::Dynamic, 1);
  return {column.begin(), column.end()};
}

}  // namespace shapespace::internal
