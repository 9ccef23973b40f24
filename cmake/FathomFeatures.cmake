# What a build can do beyond the program itself, each where its packages are found: one list, from
# which the build, the program (`fathom list features`), the packages and the scripts take it.
#
# The cache keeps a choice for each, FATHOM_NAME = AUTO, ON or OFF. What is found is looked for at
# every configuration: a package that has come since is used, one that has gone is not.
#
# Afterwards FATHOM_HAS_NAME says whether the build has it, and FATHOM_FEATURES lists the names.
set(choices AUTO ON OFF)
set(FATHOM_FEATURES "")

# Builds that were configured by an option() kept what they had found; it is no choice of a user's.
get_property(latched CACHE FATHOM_ADAPTERS PROPERTY TYPE)
if(latched)
  foreach(name ADAPTERS EXIF FASTCDR GEOTIFF PROJ PYTHON ROSBAG)
    unset(FATHOM_${name} CACHE)
  endforeach()
endif()

# Results of find_path() and its like whose file is gone, and all that FindPython3 and pkg-config
# remember. What is there stays: it may have been given on the command line.
get_cmake_property(cached CACHE_VARIABLES)
foreach(variable IN LISTS cached)
  get_property(type CACHE ${variable} PROPERTY TYPE)
  get_property(value CACHE ${variable} PROPERTY VALUE)
  if(variable MATCHES "^(_Python3_|__pkg_config_checked_)"
     OR (type MATCHES "PATH$" AND value MATCHES "^/" AND NOT value MATCHES ";"
         AND variable MATCHES "_(LIBRARY|INCLUDE|INCLUDE_DIR)(_[A-Z]+)?$|^pkgcfg_lib_"
         AND NOT EXISTS "${value}"))
    unset(${variable} CACHE)
  endif()
endforeach()

# What the groups of packages hold on this system, which may not have all.
execute_process(COMMAND ${PROJECT_SOURCE_DIR}/scripts/setup.sh --list import python adapters
                OUTPUT_VARIABLE FATHOM_SYSTEM_PACKAGES COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n]+" FATHOM_SYSTEM_PACKAGES "${FATHOM_SYSTEM_PACKAGES}")

# fathom_feature(NAME FOUND … GROUP … PACKAGES … GIVES …): FOUND is what was found of it; PACKAGES
# are Debian's, which `scripts/build.sh GROUP` installs where the system has them.
macro(fathom_feature name)
  cmake_parse_arguments(arg "" "FOUND;GROUP;GIVES" "PACKAGES" ${ARGN})
  set(default AUTO)
  if(NOT PROJECT_IS_TOP_LEVEL AND arg_GROUP MATCHES "^(adapters|python)$")
    set(default OFF)
  endif()
  set(FATHOM_${name} ${default} CACHE STRING "${arg_GIVES}: AUTO (where found), ON or OFF")
  set_property(CACHE FATHOM_${name} PROPERTY TYPE STRING)
  set_property(CACHE FATHOM_${name} PROPERTY STRINGS ${choices})
  string(TOUPPER "${FATHOM_${name}}" asked)
  set(choice ${asked})
  string(REPLACE ";" " " packages "${arg_PACKAGES}")
  set(group ${arg_GROUP})
  foreach(package IN LISTS arg_PACKAGES)
    if(NOT package IN_LIST FATHOM_SYSTEM_PACKAGES)
      set(group none)
    endif()
  endforeach()
  set(FATHOM_HAS_${name} 0)
  set(why "it is not found")
  if(choice STREQUAL "ON" OR choice STREQUAL "AUTO")
    # Plug-ins and Python's modules go into programs that are not built with the sanitizer.
    if(FATHOM_SANITIZE AND arg_GROUP MATCHES "^(adapters|python)$")
      set(why "is not for a build with FATHOM_SANITIZE")
      set(choice OFF)
    elseif(arg_FOUND)
      set(FATHOM_HAS_${name} 1)
    elseif(packages)
      set(why "${packages} is not found; 'scripts/build.sh ${arg_GROUP}' installs what this system has")
    endif()
    if(asked STREQUAL "ON" AND NOT FATHOM_HAS_${name})
      message(FATAL_ERROR "FATHOM_${name} is ON, but ${why}")
    endif()
  elseif(NOT choice STREQUAL "OFF")
    message(FATAL_ERROR "FATHOM_${name} is '${FATHOM_${name}}'; it takes AUTO, ON or OFF")
  endif()
  list(APPEND FATHOM_FEATURES ${name})
  set(FATHOM_FEATURE_${name} "${group};${choice};${arg_GIVES};${packages}")
endmacro()

# Whether all of these are found, each a variable.
function(fathom_all_found result)
  set(${result} 1 PARENT_SCOPE)
  foreach(variable IN LISTS ARGN)
    if(NOT ${variable})
      set(${result} 0 PARENT_SCOPE)
    endif()
  endforeach()
endfunction()

find_package(PkgConfig REQUIRED)

pkg_check_modules(LIBEXIF QUIET IMPORTED_TARGET libexif)
fathom_feature(EXIF FOUND ${LIBEXIF_FOUND} GROUP base PACKAGES libexif-dev
  GIVES "times and focal lengths that cameras write into pictures")

# Its package has no CMake or pkg-config file.
find_path(SCOTCH_INCLUDE_DIR scotch.h PATH_SUFFIXES scotch)
find_library(SCOTCH_LIBRARY scotch)
mark_as_advanced(SCOTCH_INCLUDE_DIR SCOTCH_LIBRARY)
fathom_all_found(found SCOTCH_INCLUDE_DIR SCOTCH_LIBRARY)
fathom_feature(SCOTCH FOUND ${found} GROUP base PACKAGES libscotch-dev
  GIVES "fewer products in large and in dense pose graphs: nested dissection")

pkg_check_modules(PROJ QUIET IMPORTED_TARGET proj)
fathom_feature(PROJ FOUND ${PROJ_FOUND} GROUP import PACKAGES libproj-dev
  GIVES "fixes in latitude and longitude")

# libgeotiff has no pkg-config file of its own.
pkg_check_modules(TIFF QUIET IMPORTED_TARGET libtiff-4)
find_path(GEOTIFF_INCLUDE_DIR geotiffio.h PATH_SUFFIXES geotiff libgeotiff)
find_library(GEOTIFF_LIBRARY geotiff)
mark_as_advanced(GEOTIFF_INCLUDE_DIR GEOTIFF_LIBRARY)
fathom_all_found(found PROJ_FOUND TIFF_FOUND GEOTIFF_INCLUDE_DIR GEOTIFF_LIBRARY)
fathom_feature(GEOTIFF FOUND ${found} GROUP import PACKAGES libgeotiff-dev libproj-dev
  GIVES "maps on Earth: GeoTIFF and GeoJSON")

# The package's own files for CMake and pkg-config ask for catkin, so that its parts are looked for
# one by one; rosbag/bag.h includes headers of the last five.
set(FATHOM_ROSBAG_LIBRARIES "")
set(FATHOM_ROSBAG_INCLUDES "")
set(parts "")
foreach(library rosbag_storage roscpp_serialization rostime cpp_common console_bridge)
  find_library(FATHOM_${library}_LIBRARY ${library})
  mark_as_advanced(FATHOM_${library}_LIBRARY)
  list(APPEND parts FATHOM_${library}_LIBRARY)
  list(APPEND FATHOM_ROSBAG_LIBRARIES ${FATHOM_${library}_LIBRARY})
endforeach()
foreach(header rosbag/bag.h pluginlib/class_loader.hpp class_loader/class_loader.hpp
               rcpputils/shared_library.hpp rcutils/macros.h ament_index_cpp/get_package_prefix.hpp)
  string(REGEX REPLACE "/.*" "" part ${header})
  find_path(FATHOM_${part}_INCLUDE ${header} PATH_SUFFIXES ${part})
  mark_as_advanced(FATHOM_${part}_INCLUDE)
  list(APPEND parts FATHOM_${part}_INCLUDE)
  list(APPEND FATHOM_ROSBAG_INCLUDES ${FATHOM_${part}_INCLUDE})
endforeach()
list(REMOVE_DUPLICATES FATHOM_ROSBAG_INCLUDES)
list(REMOVE_ITEM FATHOM_ROSBAG_INCLUDES /usr/include)
fathom_all_found(found ${parts})
fathom_feature(ROSBAG FOUND ${found} GROUP import PACKAGES librosbag-storage-dev
  GIVES "bags of ROS 1")

find_package(fastcdr QUIET CONFIG)
fathom_feature(FASTCDR FOUND ${fastcdr_FOUND} GROUP import PACKAGES libfastcdr-dev
  GIVES "bags of ROS 2")

pkg_check_modules(LZ4 QUIET IMPORTED_TARGET liblz4)
pkg_check_modules(ZSTD QUIET IMPORTED_TARGET libzstd)
fathom_all_found(found LZ4_FOUND ZSTD_FOUND)
fathom_feature(COMPRESSION FOUND ${found} GROUP import PACKAGES liblz4-dev libzstd-dev
  GIVES "bags of ROS 2 as MCAP with compressed chunks")

# Debian's pybind11 and numpy are for Debian's interpreter, which another one may hide.
if(NOT DEFINED Python3_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python3_EXECUTABLE /usr/bin/python3)
endif()
find_package(Python3 QUIET COMPONENTS Interpreter Development.Module NumPy
             OPTIONAL_COMPONENTS Development.Embed)
find_package(pybind11 QUIET CONFIG)
fathom_all_found(found Python3_FOUND Python3_Development.Embed_FOUND pybind11_FOUND)
fathom_feature(PYTHON FOUND ${found} GROUP python PACKAGES pybind11-dev python3-dev python3-numpy
  GIVES "the Python module, and estimators in Python")

find_package(mrpt-graphslam 2.5 QUIET CONFIG)
fathom_feature(MRPT FOUND ${mrpt-graphslam_FOUND} GROUP adapters PACKAGES libmrpt-graphslam-dev
  GIVES "MRPT's solver as a plug-in")

find_package(GTSAM 4.0 QUIET MODULE)
fathom_feature(GTSAM FOUND ${GTSAM_FOUND} GROUP adapters PACKAGES libgtsam-dev
  GIVES "GTSAM's solvers as a plug-in")

find_package(G2O QUIET MODULE)
fathom_feature(G2O FOUND ${G2O_FOUND} GROUP adapters PACKAGES libg2o-dev
  GIVES "g2o's solvers as a plug-in")

find_package(SESync QUIET CONFIG)
fathom_feature(SE_SYNC FOUND ${SESync_FOUND} GROUP adapters PACKAGES SE-Sync
  GIVES "SE-Sync as a program for the estimator 'command'")

# For the program, and for the scripts: a line each, "name 0|1 choice group packages …".
set(FATHOM_FEATURE_ROWS "")
set(lines "")
set(has "")
set(lacks "")
foreach(name IN LISTS FATHOM_FEATURES)
  string(TOLOWER ${name} lower)
  list(GET FATHOM_FEATURE_${name} 0 group)
  list(GET FATHOM_FEATURE_${name} 1 choice)
  list(GET FATHOM_FEATURE_${name} 2 gives)
  list(GET FATHOM_FEATURE_${name} 3 packages)
  string(APPEND FATHOM_FEATURE_ROWS
    "    {\"${lower}\", ${FATHOM_HAS_${name}} == 1, \"${gives}\", \"${packages}\", \"${group}\"},\n")
  string(APPEND lines "${lower} ${FATHOM_HAS_${name}} ${choice} ${group} ${packages}\n")
  if(FATHOM_HAS_${name})
    list(APPEND has ${lower})
  else()
    list(APPEND lacks ${lower})
  endif()
endforeach()
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/features.txt CONTENT "${lines}" @ONLY)
list(JOIN has " " has)
list(JOIN lacks " " lacks)
message(STATUS "Features: ${has}; without: ${lacks}")
