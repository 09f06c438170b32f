#include <shapespace/files/detail/write_formats.h>

namespace shapespace::internal {

std::string OffContent(const Shape& vertices, const Soup& soup) {
  OutputText text;
  text.Add("OFF\n", vertices.cols());
  text.Add(" ", soup.NumPolygons());
  text.Add(" 0\n");
  for (int v = 0; v < vertices.cols(); ++v) {
    text.Add("", vertices(0, v));
    text.Add(" ", vertices(1, v));
    text.Add(" ", vertices(2, v));
    text.Add("\n");
  }
  for (int p = 0; p < soup.NumPolygons(); ++p) {
    text.Add("", soup.polygon_begin[p + 1] - soup.polygon_begin[p]);
    for (int k = soup.polygon_begin[p]; k < soup.polygon_begin[p + 1]; ++k) {
      text.Add(" ", soup.corners[k]);
    }
    text.Add("\n");
  }
  return text.Get();
}

}  // namespace shapespace::internal
