#include "support/stdin_mesh.h"

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <iterator>
#include <regex>
#include <sstream>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/files/read.h>

#include "support/outside_files_flag.h"

namespace shapespace::tools {
namespace {

// \throw FileError
std::string ReadStdin() {
  std::string content{std::istreambuf_iterator<char>(std::cin), {}};
  if (std::ferror(stdin) != 0) throw FileError("stdin: cannot be read to its end");
  return content;
}

// All of stdin, which a tool may ask for twice.
const std::string& StdinContent() {
  static const std::string content = ReadStdin();
  return content;
}

MeshFormat FormatOfContent(const std::string& content) {
  const auto begins = [&](const char* pattern) {
    return std::regex_search(content.begin(),
                             content.begin() + std::min<size_t>(content.size(), 80),
                             std::regex(pattern), std::regex_constants::match_continuous);
  };
  if (begins("ply\\s")) return MeshFormat::kPly;
  if (begins("# vtk DataFile")) return MeshFormat::kVtk;
  if (begins("(<\\?xml|<VTKFile)\\s")) return MeshFormat::kVtp;
  if (begins("glTF|\\s*\\{")) return MeshFormat::kGltf;
  if (begins("(ST)?C?N?4?n?OFF\\s")) return MeshFormat::kOff;
  // A binary STL has a header of 80 bytes, the number of triangles, and 50 bytes for each of them.
  constexpr size_t kHeader = 84, kTriangle = 50;
  const bool has_size_of_stl = content.size() >= kHeader &&
                               (content.size() - kHeader) % kTriangle == 0 &&
                               content.find('\0') != content.npos;
  return begins("solid\\s") || has_size_of_stl ? MeshFormat::kStl : MeshFormat::kObj;
}

}  // namespace

std::vector<Soup> ReadSoupsOrStdin(const std::string& file) {
  if (file != "-") return ReadSoups(file, FLAGS_allow_outside_files);
  std::istringstream stream(StdinContent());
  return {ReadSoup(stream, "stdin", FormatOfContent(StdinContent()))};
}

Soup ReadSoupOrStdin(const std::string& file) {
  return file == "-" ? std::move(ReadSoupsOrStdin(file)[0])
                     : ReadSoup(file, FLAGS_allow_outside_files);
}

}  // namespace shapespace::tools
