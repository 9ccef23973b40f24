# GTSAM 4: the target GTSAM::gtsam, GTSAM_VERSION and GTSAM_LIBRARY. Its own package files ask for
# files that Debian 13 and Ubuntu 24.04 do not install, and stop the configuration.
find_path(GTSAM_INCLUDE_DIR gtsam/config.h)
find_library(GTSAM_LIBRARY gtsam)
mark_as_advanced(GTSAM_INCLUDE_DIR GTSAM_LIBRARY)

if(GTSAM_INCLUDE_DIR)
  file(STRINGS ${GTSAM_INCLUDE_DIR}/gtsam/config.h lines REGEX "^[ \t]*#define GTSAM_")
  list(JOIN lines "\n" lines)
  set(number "[ \t]+([0-9]+)")
  string(REGEX MATCH "VERSION_MAJOR${number}.*VERSION_MINOR${number}.*VERSION_PATCH${number}" found "${lines}")
  set(GTSAM_VERSION ${CMAKE_MATCH_1}.${CMAKE_MATCH_2}.${CMAKE_MATCH_3})
  # With a copy of Eigen of its own its matrices are not those of this project.
  if(NOT lines MATCHES "GTSAM_USE_SYSTEM_EIGEN")
    set(GTSAM_NOT_FOUND_MESSAGE "built with an Eigen of its own; build it with GTSAM_USE_SYSTEM_EIGEN=ON")
    set(GTSAM_LIBRARY GTSAM_LIBRARY-NOTFOUND)
  endif()
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(GTSAM REQUIRED_VARS GTSAM_LIBRARY GTSAM_INCLUDE_DIR
  VERSION_VAR GTSAM_VERSION REASON_FAILURE_MESSAGE "${GTSAM_NOT_FOUND_MESSAGE}")

if(GTSAM_FOUND AND NOT TARGET GTSAM::gtsam)
  add_library(GTSAM::gtsam UNKNOWN IMPORTED)
  set_target_properties(GTSAM::gtsam PROPERTIES
    IMPORTED_LOCATION ${GTSAM_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${GTSAM_INCLUDE_DIR})
  target_link_libraries(GTSAM::gtsam INTERFACE Eigen3::Eigen)
  if(lines MATCHES "GTSAM_USE_TBB")
    find_library(GTSAM_TBB_LIBRARY tbb)
    mark_as_advanced(GTSAM_TBB_LIBRARY)
    if(GTSAM_TBB_LIBRARY)
      target_link_libraries(GTSAM::gtsam INTERFACE ${GTSAM_TBB_LIBRARY})
    endif()
  endif()
endif()
