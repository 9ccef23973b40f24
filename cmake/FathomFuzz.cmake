# With FATHOM_FUZZ every target of ours is instrumented for libFuzzer and runs under the address and
# the undefined-behaviour sanitizer; the fuzzers themselves are in tests/fuzz. Include before
# anything reads FATHOM_SANITIZE.
if(FATHOM_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "FATHOM_FUZZ is ON, but ${CMAKE_CXX_COMPILER_ID} has no libFuzzer; "
                        "configure with -DCMAKE_CXX_COMPILER=clang++")
  endif()
  if(FATHOM_SANITIZE)
    message(FATAL_ERROR "FATHOM_FUZZ is ON and FATHOM_SANITIZE is '${FATHOM_SANITIZE}'; the fuzzers "
                        "have sanitizers of their own: leave FATHOM_SANITIZE empty")
  endif()
  set(FATHOM_SANITIZE fuzzer-no-link,address,undefined)
endif()
