# Writes CTest's entries for a test program: one for each suite, whose tests share what is costly, the
# start of a process and fixtures. Variables: PROGRAM, TESTS (of it, as a filter of GoogleTest), NAME
# (the entries are NAME.SUITE), FILE (to write), SLOW (suites that CTest begins with), COST (of those).
#
# A suite that is skipped in part is no skipped entry: CTest would hide what failed. What was skipped
# is listed by scripts/skipped_tests.py.
cmake_minimum_required(VERSION 3.25)

execute_process(COMMAND ${PROGRAM} --gtest_list_tests --gtest_filter=${TESTS}
                OUTPUT_VARIABLE list COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE " +#[^\n]*" "" list "${list}")  # values and types
string(REGEX MATCHALL "[^\n]+" lines "${list}")
set(suites "")
foreach(line IN LISTS lines)
  # With values or types a suite is Values/Suite, Suite/0 or Values/Suite/0.
  if(line MATCHES "^  (.+)$")
    list(APPEND tests_of_${suite} ${name}${CMAKE_MATCH_1})
  elseif(line MATCHES "^([A-Za-z0-9_]+/)?([A-Za-z_][A-Za-z0-9_]*)(/[0-9]+)?\\.$")
    set(name ${line})
    set(suite ${CMAKE_MATCH_2})
    list(APPEND suites ${suite})
  elseif(NOT line MATCHES "^Running main\\(\\)")
    # Its tests would be named after another suite, and a filter that matches nothing passes.
    message(FATAL_ERROR "${NAME}: not understood in the list of tests: ${line}")
  endif()
endforeach()
list(REMOVE_DUPLICATES suites)

string(REPLACE "," ";" SLOW "${SLOW}")
set(entries "")
foreach(suite IN LISTS suites)
  set(cost 0)
  if(suite IN_LIST SLOW)
    set(cost ${COST})
  endif()
  list(JOIN tests_of_${suite} ":" tests)
  string(APPEND entries
    "add_test(\"${NAME}.${suite}\" \"${PROGRAM}\" \"--gtest_filter=${tests}\")\n"
    "set_tests_properties(\"${NAME}.${suite}\" PROPERTIES LABELS gtest TIMEOUT 3600 COST ${cost})\n")
endforeach()
list(REMOVE_ITEM SLOW ${suites})
if(SLOW AND TESTS STREQUAL "*")
  message(FATAL_ERROR "${NAME} has no such suite: ${SLOW}")
endif()
file(WRITE ${FILE} "${entries}")
