#include <shapespace/files/detail/write_formats.h>

namespace shapespace::internal {
namespace {

/// The names of polygons as statements, written where they change from one polygon to the next.
class NameStatements {
 public:
  NameStatements(const char* keyword, const PolygonNames& names)
      : keyword_(keyword), names_(names) {}

  void Next(int polygon, OutputText* text) {
    const int name = names_.of_polygon.empty() ? -1 : names_.of_polygon[polygon];
    if (name == current_) return;
    current_ = name;
    text->Add(keyword_);
    if (name >= 0) text->Add(" " + names_.names[name]);
    text->Add("\n");
  }

 private:
  const char* keyword_;
  const PolygonNames& names_;
  int current_ = -1;
};

}  // namespace

std::string ObjContent(const Shape& vertices, const Soup& soup) {
  const Appearance& appearance = soup.appearance;
  OutputText text;
  for (const std::string& library : appearance.material_libraries) {
    text.Add("mtllib " + library + "\n");
  }
  for (int v = 0; v < vertices.cols(); ++v) {
    text.Add("v");
    for (const double x : vertices.col(v)) text.Add(" ", x);
    if (appearance.vertex_colours.size() > 0) {
      for (const double x : appearance.vertex_colours.col(v)) text.Add(" ", x);
    }
    text.Add("\n");
  }
  for (const auto& coordinates : appearance.texture_coordinates.colwise()) {
    text.Add("vt");
    for (const double x : coordinates) text.Add(" ", x);
    text.Add("\n");
  }
  NameStatements objects("o", appearance.objects), groups("g", appearance.groups),
      materials("usemtl", appearance.materials);
  for (int p = 0; p < soup.NumPolygons(); ++p) {
    for (NameStatements* names : {&objects, &groups, &materials}) names->Next(p, &text);
    text.Add("f");
    for (int k = soup.polygon_begin[p]; k < soup.polygon_begin[p + 1]; ++k) {
      text.Add(" ", soup.corners[k] + 1);
      if (!appearance.corner_texture.empty() && appearance.corner_texture[k] >= 0) {
        text.Add("/", appearance.corner_texture[k] + 1);
      }
    }
    text.Add("\n");
  }
  for (const auto& [a, b] : soup.segments) {
    text.Add("l ", a + 1);
    text.Add(" ", b + 1);
    text.Add("\n");
  }
  return text.Get();
}

}  // namespace shapespace::internal
