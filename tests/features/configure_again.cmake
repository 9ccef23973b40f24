# The steps of the test `features`. Variables: SOURCE and BUILD (of Fathom, configured), FOLDER (to
# work in), GENERATOR, CXX, PREFIX_PATH, PKG_CONFIG.
cmake_minimum_required(VERSION 3.25)

set(work ${FOLDER}/build)
file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER}/pkgconfig)

# All that pkg-config knows, but what the features ask it for.
execute_process(COMMAND ${PKG_CONFIG} --variable pc_path pkg-config OUTPUT_VARIABLE folders
                OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE ":" ";" folders "${folders}")
foreach(folder IN LISTS folders)
  file(GLOB files ${folder}/*.pc)
  list(FILTER files EXCLUDE REGEX "/(libexif|proj|libtiff-4|liblz4|libzstd)\\.pc$")
  if(files)
    file(COPY ${files} DESTINATION ${FOLDER}/pkgconfig)
  endif()
endforeach()

# configure(HIDES [options of CMake …]): sets `status`, `output` and `features`.
function(configure hides)
  unset(ENV{FATHOM_TEST_HIDES})
  unset(ENV{PKG_CONFIG_LIBDIR})
  if(hides)
    set(ENV{FATHOM_TEST_HIDES} 1)
    set(ENV{PKG_CONFIG_LIBDIR} ${FOLDER}/pkgconfig)
  endif()
  execute_process(COMMAND ${CMAKE_COMMAND} -G ${GENERATOR} -S ${SOURCE} -B ${work}
      -DCMAKE_CXX_COMPILER=${CXX} "-DCMAKE_PREFIX_PATH=${PREFIX_PATH}"
      -DFATHOM_TESTS=OFF -DFATHOM_BENCHMARKS=OFF
      -DCMAKE_PROJECT_TOP_LEVEL_INCLUDES=${SOURCE}/tests/features/hidden.cmake ${ARGN}
    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  set(status ${status} PARENT_SCOPE)
  set(output "${output}" PARENT_SCOPE)
  file(READ ${work}/features.txt features)
  set(features "${features}" PARENT_SCOPE)
endfunction()

function(expect_none when)
  if(NOT status EQUAL 0 OR features MATCHES " 1 ")
    message(FATAL_ERROR "${when}: ${status}\n${features}${output}")
  endif()
  # The choice is all that is kept.
  file(STRINGS ${work}/CMakeCache.txt kept REGEX "^FATHOM_(GEOTIFF|PYTHON|ROSBAG):")
  if(NOT kept STREQUAL "FATHOM_GEOTIFF:STRING=AUTO;FATHOM_PYTHON:STRING=AUTO;FATHOM_ROSBAG:STRING=AUTO")
    message(FATAL_ERROR "${when}: the cache has ${kept}")
  endif()
endfunction()

# Those of the build that is tested, whose packages are there; a sanitizer's has no plug-ins.
file(READ ${BUILD}/features.txt of_build)
string(REGEX REPLACE "[a-z0-9_]+ [01] [A-Z]+ (python|adapters|none)[^\n]*\n" "" of_build "${of_build}")
function(expect_those_of_the_build when)
  string(REGEX REPLACE "[a-z0-9_]+ [01] [A-Z]+ (python|adapters|none)[^\n]*\n" "" found "${features}")
  if(NOT status EQUAL 0 OR NOT found STREQUAL of_build)
    message(FATAL_ERROR "${when}: ${status}\n${features}instead of\n${of_build}${output}")
  endif()
  if(NOT EXISTS /usr/include/pybind11 AND NOT EXISTS /usr/lib/cmake/pybind11)
    return()
  endif()
  if(NOT features MATCHES "python 1 ")
    message(FATAL_ERROR "${when}: no Python\n${features}${output}")
  endif()
endfunction()

configure(YES)
expect_none("hidden")
configure(NO)
expect_those_of_the_build("shown")
configure(YES)
expect_none("hidden again")

configure(YES -DFATHOM_FASTCDR=ON)
if(status EQUAL 0 OR NOT output MATCHES "libfastcdr-dev is not found; +'scripts/build.sh[ \n]+import'")
  message(FATAL_ERROR "ON, and hidden: ${status}\n${output}")
endif()
configure(NO -DFATHOM_FASTCDR=OFF)
if(NOT features MATCHES "fastcdr 0 OFF")
  message(FATAL_ERROR "OFF, and shown: ${features}")
endif()
configure(NO -DFATHOM_FASTCDR=maybe)
if(status EQUAL 0 OR NOT output MATCHES "it takes AUTO, ON or OFF")
  message(FATAL_ERROR "no choice: ${status}\n${output}")
endif()

# The folder of an older commit, whose option() had kept that nothing was there.
configure(NO -DFATHOM_ADAPTERS:BOOL=OFF -DFATHOM_FASTCDR:BOOL=OFF -DFATHOM_GEOTIFF:BOOL=OFF
          -DFATHOM_PYTHON:BOOL=OFF)
expect_those_of_the_build("of an older commit")
