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

# The example plug-in, as somebody else would build it, by name in a study.
step(${CMAKE_COMMAND} -G ${GENERATOR} -S ${SOURCE}/examples/plugin -B ${FOLDER}/plugin
     -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_PREFIX_PATH=${prefix})
step(${CMAKE_COMMAND} --build ${FOLDER}/plugin)
set(plugin ${FOLDER}/plugin/sparse_least_squares.so)
step(${prefix}/bin/fathom list estimators --plugin ${plugin})
expect("${output}" "sparse_least_squares: .*plug-in sparse_least_squares.so")
file(WRITE ${FOLDER}/study.yaml "dataset:
  type: simulated_log
  mission: {type: sweep, legs: 3, leg_length_m: 8, leg_spacing_m: 1.0}
  loops: {max_distance_m: 1.4}
plugins: [${plugin}]
estimators: [{type: sparse_least_squares}, {type: ekf}]
trials: 2
")
step(${prefix}/bin/fathom compare ${FOLDER}/study.yaml --out ${FOLDER}/study)
expect("${output}" "sparse_least_squares +2/2 done")
