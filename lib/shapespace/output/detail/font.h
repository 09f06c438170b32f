#ifndef SHAPESPACE_OUTPUT_DETAIL_FONT_H_
#define SHAPESPACE_OUTPUT_DETAIL_FONT_H_

namespace shapespace::internal {

/// The bytes of fonts/DejaVuSans-subset.ttf, which the build puts into a source file
/// (fonts/embed.cmake).
extern const unsigned char kFont[];

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_DETAIL_FONT_H_
