# The steps of the test `extending`, each of which must succeed. Variables: APPLY (the program), PAGE
# (docs/extending.md), SOURCE and BUILD (of Fathom, built), FOLDER (to work in), NINJA, CXX, TYPE and
# SANITIZE of the build.
cmake_minimum_required(VERSION 3.25)

cmake_path(GET FOLDER PARENT_PATH parent)

function(step)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${parent} RESULT_VARIABLE status
                  OUTPUT_VARIABLE output ERROR_VARIABLE errors)
  if(NOT status EQUAL 0)
    string(JOIN " " line ${ARGN})
    message(FATAL_ERROR "${line}\nended with ${status}:\n${output}${errors}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

function(expect text pattern)
  if(NOT text MATCHES "${pattern}")
    message(FATAL_ERROR "expected ${pattern} in:\n${text}")
  endif()
endfunction()

file(REMOVE_RECURSE ${FOLDER})
set(scratch ${FOLDER}/fathom)
# A cost is in a header of half of all sources, and a command needs the whole program again.
step(${APPLY} ${PAGE} ${SOURCE} ${scratch} "A cost" "A command")
string(REGEX MATCHALL "[^\n]+" files "${output}")

# What each target is compiled with, the CMake files of the examples included.
step(${CMAKE_COMMAND} -G Ninja -S ${scratch} -B ${scratch}/build -DCMAKE_MAKE_PROGRAM=${NINJA}
     -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_BUILD_TYPE=${TYPE} -DFATHOM_SANITIZE=${SANITIZE}
     -DFATHOM_TESTS=OFF -DFATHOM_BENCHMARKS=OFF -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON)

# Sources that CMake makes and that the examples change.
file(GLOB_RECURSE made RELATIVE ${scratch}/build ${scratch}/build/*.cpp)
list(FILTER made EXCLUDE REGEX CMakeFiles)
foreach(file IN LISTS made)
  execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${scratch}/build/${file} ${BUILD}/${file}
                  RESULT_VARIABLE differs ERROR_QUIET)
  if(differs)
    list(APPEND files ${scratch}/build/${file})
  endif()
endforeach()

list(TRANSFORM files APPEND "^")  # in Ninja's words: what is compiled of it
step(${NINJA} -C ${scratch}/build ${files})
file(GLOB_RECURSE objects ${scratch}/build/*.o)
list(LENGTH files wanted)
list(LENGTH objects compiled)
if(NOT wanted EQUAL compiled)
  message(FATAL_ERROR "${wanted} files, but ${compiled} objects: ${objects}")
endif()
string(JOIN "\n" objects ${objects})
file(WRITE ${FOLDER}/objects.txt "${objects}\n")
step(${CMAKE_COMMAND} --build ${BUILD} --target fathom_extended estimators_test_extended)

set(fathom ${BUILD}/fathom_extended)
foreach(listed "estimators:dense_least_squares" "estimators:welsch" "detectors:akaze_upright"
               "datasets:square" "metrics:path_length_m")
  string(REPLACE ":" ";" listed ${listed})
  list(GET listed 0 what)
  list(GET listed 1 name)
  step(${fathom} list ${what})
  expect("${output}" "${name}")
endforeach()

# Each at work: data set, estimator and metric; loss; detector.
step(${fathom} run ${scratch}/square.yaml --out ${FOLDER}/square)
file(READ ${FOLDER}/square/metrics.json metrics)
expect("${metrics}" "\"path_length_m\": 1[0-9][0-9]\\.")
step(${fathom} run ${scratch}/square.yaml --out ${FOLDER}/welsch
     --set estimator.type=ceres_pose_graph --set estimator.loss=welsch)
step(${fathom} run ${SOURCE}/configs/run.yaml --out ${FOLDER}/upright
     --set front_end.features.type=akaze_upright --set estimator.type=dense_least_squares
     --set dataset.camera.width=200 --set dataset.camera.height=150 --set dataset.camera.fx=150
     --set dataset.camera.fy=150 --set dataset.world.metres_per_pixel=0.01
     --set dataset.mission.loop_length_m=3 --set dataset.mission.loop_width_m=2
     --set dataset.mission.loop_overrun_m=1)
step(${BUILD}/estimators_test_extended --gtest_filter=Every/Conformance.*/dense_least_squares__*)
expect("${output}" "PASSED  . [1-9][0-9] tests")
