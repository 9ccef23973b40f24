# Every program of this build runs on OpenBLAS with POSIX threads where Debian has put it
# (libopenblas0-pthread), whatever the system's choice of alternatives: the build for one thread has
# no locks, and a product that two threads ask of it at the same time can be wrong. Its pool is not
# started: src/core/pin_threads.cpp.
#
# The programs name libblas and liblapack, too, so that those which Ceres and CHOLMOD ask for are
# already loaded, and find all three by DT_RPATH, which goes before LD_LIBRARY_PATH and the
# alternatives. DT_RUNPATH would not hold for what the libraries themselves load.
find_path(FATHOM_BLAS_DIR libopenblas.so.0
  PATHS /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/openblas-pthread
  NO_DEFAULT_PATH DOC "Folder with the threaded libopenblas.so.0, libblas.so.3 and liblapack.so.3")

if(FATHOM_BLAS_DIR)
  string(JOIN " " blas_flags
    -Wl,--disable-new-dtags -Wl,--push-state,--no-as-needed ${FATHOM_BLAS_DIR}/libopenblas.so.0
    ${FATHOM_BLAS_DIR}/libblas.so.3 ${FATHOM_BLAS_DIR}/liblapack.so.3 -Wl,--pop-state)
  string(APPEND CMAKE_EXE_LINKER_FLAGS " ${blas_flags}")
  # The same path in the build folder: CMake ends one of its own with a separator, which stands for
  # the working directory.
  list(APPEND CMAKE_INSTALL_RPATH ${FATHOM_BLAS_DIR})
  set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON)
  set(CMAKE_BUILD_WITH_INSTALL_RPATH ON)
else()
  message(STATUS "No OpenBLAS with POSIX threads (Debian: libopenblas0-pthread): the programs run "
                 "on the system's, one call at a time where that has no locks")
endif()
