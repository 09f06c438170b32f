#include <shapespace/bodies/skinned.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/quadruped.h>

namespace shapespace {
namespace {

struct SkinnedEntry {
  SkinnedBodyInfo info;
  SkinnedBody (*make)(int triangles, const std::string& proportions);
};

const std::vector<SkinnedEntry>& SkinnedRegistry() {
  static const auto* const registry = new std::vector<SkinnedEntry>{
      {{"quadruped", QuadrupedPoses(), QuadrupedProportions(), 20000},
       [](int triangles, const std::string& proportions) {
         return MakeQuadruped(triangles, NamedQuadrupedForm(proportions));
       }}};
  return *registry;
}

}  // namespace

std::vector<SkinnedBodyInfo> ListSkinnedBodies() {
  std::vector<SkinnedBodyInfo> infos;
  for (const SkinnedEntry& entry : SkinnedRegistry()) infos.push_back(entry.info);
  return infos;
}

SkinnedBody MakeSkinnedBody(const std::string& name, int triangles,
                            const std::string& proportions) {
  std::string known;
  for (const auto& [info, make] : SkinnedRegistry()) {
    if (info.name == name) {
      return make(triangles == 0 ? info.default_triangles : triangles,
                  proportions.empty() ? info.proportions[0] : proportions);
    }
    known += (known.empty() ? "" : ", ") + info.name;
  }
  throw InvalidOptions("name", "no body with bones is called '" + name + "'; known are " + known);
}

}  // namespace shapespace
