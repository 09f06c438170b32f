#include <shapespace/output/page.h>

#include <ostream>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/atomic_file.h>
#include <shapespace/output/detail/page_scene.h>
#include <shapespace/output/internal/view.h>

namespace shapespace {
namespace {

// The placeholder for scenes in the viewer.
constexpr char kMark[] = "<!-- scenes -->";

std::string Base64(const std::string& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](size_t k) {
      return k < bytes.size() ? unsigned{static_cast<unsigned char>(bytes[k])} : 0u;
    };
    const unsigned three = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    for (int k = 0; k < 4; ++k) {
      text.push_back(i + k > bytes.size() ? '=' : kDigits[three >> (18 - 6 * k) & 63]);
    }
  }
  return text;
}

// As the value of an attribute in double quotes.
std::string Escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '&') {
      escaped += "&amp;";
    } else if (c == '"') {
      escaped += "&quot;";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

std::string Element(const std::string& type, const std::string& name, const std::string& bytes) {
  return "<script type=\"" + type + "\" data-scene data-name=\"" + Escaped(name) + "\">" +
         Base64(bytes) + "</script>\n";
}

struct MakeElement {
  const PageView& view;
  std::vector<std::string>* warnings;

  std::string operator()(const PagePath& path) const {
    return Element("application/x-shapespace", path.name,
                   internal::EncodeScene(path, view, warnings));
  }
  std::string operator()(const PageSpace& space) const {
    return Element("application/x-shapespace", space.name, internal::EncodeScene(space, view));
  }
  std::string operator()(const PageModes& modes) const {
    return Element("application/x-shapespace", modes.name, internal::EncodeScene(modes, view));
  }
  std::string operator()(const PageMesh& mesh) const {
    return Element("application/x-shapespace", mesh.name, internal::EncodeScene(mesh, view));
  }
  std::string operator()(const PageGlb& glb) const {
    return Element("model/gltf-binary", glb.name, glb.bytes);
  }
};

}  // namespace

void PageView::Validate() const {
  if (!up.allFinite()) throw InvalidOptions("up", "not finite");
  if (!eye.allFinite()) throw InvalidOptions("eye", "not finite");
  if (!up.isZero(0) && !eye.isZero(0) && internal::Parallel(up, eye)) {
    throw InvalidOptions("up", "parallel to the direction to the eye; give another, or none");
  }
}

std::string MakePage(const std::string& page_template, const std::vector<PageScene>& scenes,
                     const PageView& view, std::vector<std::string>* warnings) {
  view.Validate();
  if (scenes.empty() || scenes.size() > 2)
    throw InvalidOptions("scenes", "there must be one or two");
  for (const PageScene& scene : scenes) {
    if (scenes.size() == 2 &&
        (std::holds_alternative<PageSpace>(scene) || std::holds_alternative<PageModes>(scene))) {
      throw InvalidOptions("scenes", "a space or a model is shown alone");
    }
  }
  if (scenes.size() == 2 &&
      std::holds_alternative<PageMesh>(scenes[0]) != std::holds_alternative<PageMesh>(scenes[1])) {
    throw InvalidOptions("scenes", "beside a mesh there may only be another mesh");
  }
  const size_t mark = page_template.find(kMark);
  if (mark == std::string::npos || page_template.find(kMark, mark + 1) != std::string::npos) {
    throw InvalidOptions("page_template", "is not the viewer that ./dev viewer builds");
  }
  std::string page = page_template.substr(0, mark);
  std::vector<std::string> found;
  for (const PageScene& scene : scenes) page += std::visit(MakeElement{view, &found}, scene);
  if (warnings != nullptr) warnings->insert(warnings->end(), found.begin(), found.end());
  return page.append(page_template, mark + sizeof kMark - 1);
}

void WritePage(const std::string& file, const std::string& page_template,
               const std::vector<PageScene>& scenes, const PageView& view,
               std::vector<std::string>* warnings) {
  const std::string page = MakePage(page_template, scenes, view, warnings);
  internal::WriteFileAtomically(file, [&](std::ostream& out) { out << page; });
}

}  // namespace shapespace
