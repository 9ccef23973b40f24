# The steps of the test `consumer`, each of which must succeed. Variables: SOURCE and BUILD (of
# Fathom, built), PROJECT (the consumer), FOLDER (to work in), GENERATOR, CXX, VERSION (of the
# installed program).
cmake_minimum_required(VERSION 3.25)

function(step)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output
                  ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    string(JOIN " " line ${ARGN})
    message(FATAL_ERROR "${line}\nended with ${status}:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

function(expect text pattern)
  if(NOT text MATCHES "${pattern}")
    message(FATAL_ERROR "expected ${pattern} in:\n${text}")
  endif()
endfunction()

file(REMOVE_RECURSE ${FOLDER})
set(prefix ${FOLDER}/prefix)

step(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
step(${prefix}/bin/fathom --version)
expect("${output}" "fathom ${VERSION}")

# The prefix must work where there is neither source nor build folder.
file(GLOB_RECURSE package_files ${prefix}/*fathom*.cmake)
foreach(file IN LISTS package_files)
  file(READ ${file} text)
  foreach(folder ${SOURCE} ${BUILD})
    string(FIND "${text}" "${folder}" place)
    if(NOT place EQUAL -1)
      message(FATAL_ERROR "${file} names ${folder}")
    endif()
  endforeach()
endforeach()

step(${CMAKE_COMMAND} -G ${GENERATOR} -S ${PROJECT} -B ${FOLDER}/build
     -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_PREFIX_PATH=${prefix})
step(${CMAKE_COMMAND} --build ${FOLDER}/build)
step(${FOLDER}/build/consumer)
expect("${output}" "keyframe 3")
expect("${output}" "trajectory_iekf")
message(STATUS "${output}")
