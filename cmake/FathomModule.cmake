# fathom_module(NAME [HOT] SOURCES ... [PUBLIC ...] [PRIVATE ...])
#
# One static library `fathom_NAME`, alias `fathom::NAME`, per module of the design. PUBLIC and
# PRIVATE are exactly the edges that the module may have. HOT is one whose loops set the time of a
# run, where -O3 pays (docs/performance.md).
function(fathom_module name)
  cmake_parse_arguments(arg "HOT" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(fathom_${name} STATIC ${arg_SOURCES})
  add_library(fathom::${name} ALIAS fathom_${name})
  target_include_directories(fathom_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(fathom_${name} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  target_compile_features(fathom_${name} PUBLIC cxx_std_20)
  set_target_properties(fathom_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  if(arg_HOT)
    fathom_own_target(fathom_${name} HOT)
    fathom_reuse_precompiled(fathom_${name} fathom_hot_headers)
    # In a large unit less is inlined; without optimisation, as lint reads them, that is nothing.
    if(NOT CMAKE_BUILD_TYPE STREQUAL "Debug")
      set_target_properties(fathom_${name} PROPERTIES UNITY_BUILD OFF)
    endif()
  else()
    fathom_own_target(fathom_${name})
    fathom_reuse_precompiled(fathom_${name} fathom_headers)
  endif()
  set_property(GLOBAL APPEND PROPERTY FATHOM_MODULES fathom_${name})
endfunction()

# Warnings, optimisation and sanitizers of a target of ours; never of a user's. HOT as above.
function(fathom_own_target target)
  if(ARGN STREQUAL "HOT")
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O3>)
    # From g++ 14 on, some sums of products are fused and others not, by the shape of the loop. A
    # kernel gives the same bits for any number of rows, and so for any number of threads.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      target_compile_options(${target} PRIVATE --param=avoid-fma-max-bits=0)
    endif()
  else()
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O2>)
  endif()
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-qual
    -Wformat=2 -Wimplicit-fallthrough)
  # g++ 12 warns of its own std::string operator+ when it is inlined (GCC bugs 105651 and 105329);
  # of more of it with precompiled headers.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${target} PRIVATE -Wno-restrict)
    if(FATHOM_PRECOMPILED_HEADERS)
      target_compile_options(${target} PRIVATE
        -Wno-stringop-overflow -Wno-stringop-overread -Wno-array-bounds)
    endif()
  endif()
  if(FATHOM_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(FATHOM_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${FATHOM_SANITIZE} -fno-omit-frame-pointer
                                             -fno-sanitize-recover=all)
    target_link_options(${target} PUBLIC -fsanitize=${FATHOM_SANITIZE})
    # With sanitizers g++ warns of its own std::regex (GCC bug 105562).
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      target_compile_options(${target} PRIVATE -Wno-maybe-uninitialized)
    endif()
  endif()
endfunction()

# fathom_loaded_module(NAME COMPONENT … SOURCES …): code of the program in a file of its own, NAME.so,
# which it loads when it needs it.
function(fathom_loaded_module name)
  cmake_parse_arguments(arg "" "COMPONENT" "SOURCES" ${ARGN})
  add_library(${name} MODULE ${arg_SOURCES})
  fathom_own_target(${name})
  set_target_properties(${name} PROPERTIES
    PREFIX "" INSTALL_RPATH "" LIBRARY_OUTPUT_DIRECTORY $<1:${PROJECT_BINARY_DIR}>)
  install(TARGETS ${name} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/fathom
          COMPONENT ${arg_COMPONENT})
endfunction()

# fathom_loads(TARGET SOURCE MODULE): that source of the target loads the module NAME.so
# (core/module.hpp) from FATHOM_MODULE_INSTALLED, a folder relative to the program's, or from
# FATHOM_MODULE_BUILT.
function(fathom_loads target source module)
  set(built ${PROJECT_BINARY_DIR})
  if(FATHOM_INSTALLED_ONLY)
    set(built ${CMAKE_INSTALL_FULL_LIBDIR}/fathom)
  endif()
  file(RELATIVE_PATH installed ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR}/fathom)
  set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES COMPILE_DEFINITIONS
    "FATHOM_MODULE_BUILT=\"${built}/${module}.so\";FATHOM_MODULE_INSTALLED=\"${installed}\"")
endfunction()
