#ifndef SHAPESPACE_FILES_DETAIL_WRITE_FORMATS_H_
#define SHAPESPACE_FILES_DETAIL_WRITE_FORMATS_H_

#include <string>
#include <string_view>

#include <shapespace/base/internal/number_chars.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/mesh/soup.h>

// One writer per format. Each returns the content of a file with `vertices`, and with the
// polygons, segments and appearance of `soup`, which are valid (`WriteMesh`).

namespace shapespace::internal {

std::string ObjContent(const Shape& vertices, const Soup& soup);
std::string PlyContent(const Shape& vertices, const Soup& soup);
std::string OffContent(const Shape& vertices, const Soup& soup);
std::string StlContent(const Shape& vertices, const Soup& soup);

/// Whether every corner of the polygon has a texture coordinate; PLY stores only those of such
/// polygons.
bool IsTextured(const Soup& soup, int polygon);

/// Text assembled in one block of memory, because streams format numbers several times slower.
class OutputText {
 public:
  void Add(std::string_view words) { text_ += words; }

  /// Appends `words` and a number. Numbers that are not integers have the fewest digits that
  /// reproduce the number exactly.
  template <typename Number>
  void Add(std::string_view words, Number number) {
    Add(words);
    char buffer[32];
    text_.append(buffer, ToChars(buffer, buffer + sizeof buffer, number));
  }

  const std::string& Get() const { return text_; }

 private:
  std::string text_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_FILES_DETAIL_WRITE_FORMATS_H_
