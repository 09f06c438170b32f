# include_each(<target> <headers>...): a library of one source for each header, which includes this
# alone. No header may need one that comes before it, or that was not installed.
function(include_each target)
  foreach(header IN LISTS ARGN)
    string(MAKE_C_IDENTIFIER ${header} name)
    file(CONFIGURE OUTPUT ${name}.cc CONTENT "#include <@header@>\n" @ONLY)
    list(APPEND sources ${CMAKE_CURRENT_BINARY_DIR}/${name}.cc)
  endforeach()
  add_library(${target} OBJECT ${sources})
endfunction()
