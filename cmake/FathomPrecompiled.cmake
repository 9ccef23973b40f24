# Headers that nearly every source includes, compiled once: more than half of the build's time.
# No source depends on it: each includes what it uses, and builds with the option off.
option(FATHOM_PRECOMPILED_HEADERS "Compile the common headers once" ON)

# fathom_precompiled(NAME [HOT] PIC ON|OFF HEADERS … LIBRARIES …): the target NAME that compiles
# HEADERS, with the flags of our own targets that use LIBRARIES. A function in a header keeps the
# optimisation that the header was compiled with: what is HOT has headers of its own.
function(fathom_precompiled name)
  if(NOT FATHOM_PRECOMPILED_HEADERS)
    return()
  endif()
  cmake_parse_arguments(arg "HOT" "PIC" "HEADERS;LIBRARIES" ${ARGN})
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "// Holds a place: a target must compile something.\n")
  add_library(${name} OBJECT ${source})
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ${arg_PIC})
  target_link_libraries(${name} PRIVATE ${arg_LIBRARIES})
  target_precompile_headers(${name} PRIVATE ${arg_HEADERS})
  if(arg_HOT)
    fathom_own_target(${name} HOT)
  else()
    fathom_own_target(${name})
  endif()
endfunction()

# The target uses the headers that NAME compiled.
function(fathom_reuse_precompiled target name)
  if(FATHOM_PRECOMPILED_HEADERS)
    target_precompile_headers(${target} REUSE_FROM ${name})
  endif()
endfunction()

set(FATHOM_COMMON_HEADERS
  <algorithm> <array> <cmath> <cstddef> <cstdint> <filesystem> <functional> <map> <memory>
  <optional> <span> <string> <string_view> <utility> <vector> <Eigen/Core> <Eigen/Cholesky>)
