# The steps of the test `packages`. Variables: BUILD (of Fathom, built), FOLDER (to work in), LIB (the
# folder of libraries below a prefix), VERSION, and what was built: HAS_ROS1, HAS_PYTHON, HAS_MRPT,
# HAS_PAGES.
cmake_minimum_required(VERSION 3.25)

function(install_component component)
  execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${FOLDER}/${component}
                          --component ${component}
                  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${component}: ${output}")
  endif()
  file(GLOB_RECURSE files RELATIVE ${FOLDER}/${component} ${FOLDER}/${component}/*)
  set(${component}_files ${files} PARENT_SCOPE)
endfunction()

function(expect component)
  foreach(file ${ARGN})
    if(NOT file IN_LIST ${component}_files)
      message(FATAL_ERROR "${component} lacks ${file}; it has ${${component}_files}")
    endif()
  endforeach()
endfunction()

# Every file of the component is of these kinds.
function(expect_only component pattern)
  foreach(file IN LISTS ${component}_files)
    if(NOT file MATCHES "${pattern}")
      message(FATAL_ERROR "${component} has ${file}")
    endif()
  endforeach()
endfunction()

file(REMOVE_RECURSE ${FOLDER})

# An install rule without a component is packed nowhere.
install_component(Unspecified)
if(Unspecified_files)
  message(FATAL_ERROR "of no component: ${Unspecified_files}")
endif()

install_component(program)
expect(program bin/fathom share/doc/fathom/copyright share/doc/fathom/changelog.gz
               share/fathom/configs/quickstart.yaml)
expect(program ${LIB}/fathom/fathom_codecs.so)
expect_only(program "^(bin/fathom|share/.*|${LIB}/fathom/fathom_(codecs|ros1).so)$")
if(HAS_PAGES)
  expect(program share/man/man1/fathom.1.gz share/man/man1/fathom-compare.1.gz
                 share/bash-completion/completions/fathom)
endif()
if(HAS_ROS1)
  expect(program ${LIB}/fathom/fathom_ros1.so)
endif()
execute_process(COMMAND ${FOLDER}/program/bin/fathom --version OUTPUT_VARIABLE said
                COMMAND_ERROR_IS_FATAL ANY)
if(NOT said STREQUAL "fathom ${VERSION}\n")
  message(FATAL_ERROR "fathom --version: ${said}")
endif()

install_component(dev)
expect(dev ${LIB}/libfathom_core.a include/fathom/core/version.hpp
           ${LIB}/cmake/fathom/fathomConfig.cmake ${LIB}/cmake/fathom/fathomTargets.cmake)
expect_only(dev "^(${LIB}/(libfathom_[a-z_]+[.]a|cmake/fathom/.*[.]cmake)|include/fathom/.*[.]hpp|share/doc/.*)$")

if(HAS_PYTHON)
  install_component(python)
  file(GLOB PYTHON RELATIVE ${FOLDER}/python ${FOLDER}/python/lib/python3*/dist-packages)
  expect(python ${PYTHON}/fathom/__init__.py)
  expect_only(python "^(${PYTHON}/fathom/[a-z0-9_.-]+|${LIB}/fathom/fathom_python_plugins.so|share/.*)$")
  if(NOT "${python_files}" MATCHES "fathom/_fathom[.][a-z0-9_-]+[.]so")
    message(FATAL_ERROR "python has no extension: ${python_files}")
  endif()
endif()

if(HAS_MRPT)
  install_component(adapter_mrpt)
  expect(adapter_mrpt ${LIB}/fathom/adapters/mrpt.so)
endif()
