# Makes SOURCE, a C++ file with the bytes of FONT. cmake -DFONT=... -DSOURCE=... -P embed.cmake
file(READ "${FONT}" bytes HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
# Lines of sixteen bytes.
string(REGEX REPLACE "(................................................................................)"
  "\\1\n" bytes "${bytes}")
file(WRITE "${SOURCE}" "#include <shapespace/output/detail/font.h>

namespace shapespace::internal {

const unsigned char kFont[] = {
${bytes}};

}  // namespace shapespace::internal
")
