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

# The programs of docs/library.md, the second with the plug-in above.
function(write_block title)
  set(opening "title=\"${title}\"\n")
  string(FIND "${page}" "${opening}" begin)
  if(begin EQUAL -1)
    message(FATAL_ERROR "docs/library.md has no ${title}")
  endif()
  string(LENGTH "${opening}" length)
  math(EXPR begin "${begin} + ${length}")
  string(SUBSTRING "${page}" ${begin} -1 block)
  string(FIND "${block}" "```" end)
  string(SUBSTRING "${block}" 0 ${end} block)
  file(WRITE ${programs}/${title} "${block}")
endfunction()

set(programs ${FOLDER}/programs)
file(READ ${SOURCE}/docs/library.md page)
foreach(title CMakeLists.txt replay_all.cpp study.cpp)
  write_block(${title})
endforeach()
step(${CMAKE_COMMAND} -G ${GENERATOR} -S ${programs} -B ${programs}/build
     -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_PREFIX_PATH=${prefix})
step(${CMAKE_COMMAND} --build ${programs}/build)
file(COPY ${plugin} DESTINATION ${programs})
# The program names the plug-in itself.
file(READ ${FOLDER}/study.yaml study)
string(REPLACE "plugins: [${plugin}]\n" "" study "${study}")
file(WRITE ${programs}/study.yaml "${study}")
file(WRITE ${programs}/intel.g2o "VERTEX_SE2 0 0 0 0
VERTEX_SE2 1 1 0 0
EDGE_SE2 0 1 1 0 0 10 0 0 10 0 10
")
step(${CMAKE_COMMAND} -E chdir ${programs} ${programs}/build/replay_all)
expect("${output}" "sparse_gauss_newton: converged, chi2 0.0000")
step(${CMAKE_COMMAND} -E chdir ${programs} ${programs}/build/study)
expect("${output}" "sparse_least_squares +2/2 done")
foreach(file report.html summary.csv tables.tex table.txt results.sqlite)
  if(NOT EXISTS ${programs}/runs/study/${file})
    message(FATAL_ERROR "the study has no ${file}")
  endif()
endforeach()
