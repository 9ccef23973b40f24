# Included before the project where the test `features` configures it: while FATHOM_TEST_HIDES is set
# in the environment, nothing of the optional packages is found.
if(NOT DEFINED ENV{FATHOM_TEST_HIDES})
  return()
endif()

macro(find_package name)
  if("${name}" MATCHES "^(fastcdr|pybind11|mrpt-graphslam|GTSAM|G2O|SESync)$")
    set(${name}_FOUND 0)
  else()
    _find_package(${name} ${ARGN})
  endif()
endmacro()

macro(find_path variable)
  if("${variable}" MATCHES "^(GEOTIFF_INCLUDE_DIR|SCOTCH_INCLUDE_DIR|FATHOM_(rosbag|rcutils)_INCLUDE)$")
    set(${variable} ${variable}-NOTFOUND CACHE PATH "hidden" FORCE)
  else()
    _find_path(${variable} ${ARGN})
  endif()
endmacro()

macro(find_library variable)
  if("${variable}" MATCHES "^(GEOTIFF_LIBRARY|SCOTCH_LIBRARY|FATHOM_rosbag_storage_LIBRARY)$")
    set(${variable} ${variable}-NOTFOUND CACHE FILEPATH "hidden" FORCE)
  else()
    _find_library(${variable} ${ARGN})
  endif()
endmacro()
