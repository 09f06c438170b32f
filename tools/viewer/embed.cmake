# Makes SOURCE, a C++ file in which FUNCTION returns the text of PAGE; an empty one where there is no such
# file.
# cmake -DPAGE=... -DFUNCTION=... -DSOURCE=... -P embed.cmake
set(page "")
if(EXISTS "${PAGE}")
  file(READ "${PAGE}" page)
endif()
file(WRITE "${SOURCE}.new" "#include \"viewer/page.h\"

namespace shapespace::tools {

std::string_view ${FUNCTION}() {
  return R\"~page~(${page})~page~\";
}

}  // namespace shapespace::tools
")
file(COPY_FILE "${SOURCE}.new" "${SOURCE}" ONLY_IF_DIFFERENT)
