#ifndef SHAPESPACE_FILES_DETAIL_VTP_DOCUMENT_H_
#define SHAPESPACE_FILES_DETAIL_VTP_DOCUMENT_H_

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace shapespace::internal {

using XmlAttributes = std::map<std::string, std::string, std::less<>>;

/// The attribute of this name; empty if there is none.
inline std::string_view AttributeOf(const XmlAttributes& attributes, std::string_view name) {
  const auto found = attributes.find(name);
  return found == attributes.end() ? std::string_view() : found->second;
}

/// The XML of a .vtp file, before its arrays are decoded.
struct VtpDocument {
  struct Array {
    std::string section;  ///< the element that it is in: Points, Polys, PointData, ...
    XmlAttributes attributes;
    std::string text;  ///< its content
    int line = 0;
  };
  struct Piece {
    XmlAttributes attributes;
    std::string texture;  ///< the name of the array with texture coordinates
    std::vector<Array> arrays;
    int line = 0;
  };

  XmlAttributes attributes;  ///< of the outermost element
  std::vector<Piece> pieces;
  bool has_field_data = false;
  bool appended_as_base64 = false;
  std::string_view appended;  ///< what appended arrays have their offsets in, to the file's end
};

/// Parses the XML up to the appended data, which need not be XML. The result refers to `text`.
/// \throw FileError naming file and line: no well-formed XML, a document type, another outermost
///        element than a VTKFile of PolyData, far more elements than such a file has.
VtpDocument ParseVtp(const std::string& file, const std::string& text);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_FILES_DETAIL_VTP_DOCUMENT_H_
