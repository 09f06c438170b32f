#include <shapespace/files/display_names.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include <shapespace/base/internal/extension.h>

namespace shapespace {
namespace {

bool IsMeshFile(const std::string& name) {
  const std::string extension = internal::FileExtension(name);
  const auto known = {".obj", ".ply", ".off", ".stl", ".glb", ".gltf", ".vtk", ".vtp"};
  return std::find(known.begin(), known.end(), extension) != known.end();
}

}  // namespace

std::string DisplayName(const std::string& name) {
  return IsMeshFile(name) ? std::filesystem::u8path(name).stem().u8string() : name;
}

std::vector<std::string> DisplayNames(const std::vector<std::string>& names) {
  std::vector<std::string> shown;
  for (const std::string& name : names) shown.push_back(DisplayName(name));
  std::set<std::string> taken;
  for (std::string& name : shown) {
    std::string distinct = name;
    for (int number = 2; !taken.insert(distinct).second; ++number) {
      distinct = name + " " + std::to_string(number);
    }
    name = distinct;
  }
  return shown;
}

}  // namespace shapespace
