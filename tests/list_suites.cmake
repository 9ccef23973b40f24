# Writes CTest's entries for a test program: one for each suite, whose tests share what is costly, the
# start of a process and fixtures. Variables: PROGRAM, NAME (the entries are NAME.SUITE), FILE (to
# write), SLOW (suites that CTest begins with), COST (of those).
#
# A suite that is skipped in part is no skipped entry: CTest would hide what failed. What was skipped
# is listed by scripts/skipped_tests.py.
cmake_minimum_required(VERSION 3.25)

execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE list
                COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "\n[A-Za-z0-9/]+\\." names "\n${list}")
set(suites "")
foreach(name IN LISTS names)
  # With values or types: Values/Suite, Suite/0 or Values/Suite/0.
  string(REGEX MATCH "^\n([A-Za-z]+/)?([A-Za-z0-9]+)(/[0-9]+)?\\.$" name "${name}")
  set(suite ${CMAKE_MATCH_2})
  string(STRIP "${name}" name)
  list(APPEND suites ${suite})
  list(APPEND filter_${suite} ${name}*)
endforeach()
list(REMOVE_DUPLICATES suites)

string(REPLACE "," ";" SLOW "${SLOW}")
set(entries "")
foreach(suite IN LISTS suites)
  set(cost 0)
  if(suite IN_LIST SLOW)
    set(cost ${COST})
    list(REMOVE_ITEM SLOW ${suite})
  endif()
  list(JOIN filter_${suite} ":" filter)
  string(APPEND entries
    "add_test(\"${NAME}.${suite}\" \"${PROGRAM}\" \"--gtest_filter=${filter}\")\n"
    "set_tests_properties(\"${NAME}.${suite}\" PROPERTIES TIMEOUT 3600 COST ${cost})\n")
endforeach()
if(SLOW)
  message(FATAL_ERROR "${NAME} has no such suite: ${SLOW}")
endif()
file(WRITE ${FILE} "${entries}")
