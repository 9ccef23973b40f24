# Every program of this build runs on a serial OpenBLAS where there is one (Debian: the package
# libopenblas0-serial): a threaded one starts a pool as soon as it is loaded, which costs
# processor time and waits for ever where it finds no memory. Sets FATHOM_HAS_SERIAL_BLAS.
#
# The programs name libblas and liblapack, too, so that those which Ceres and CHOLMOD ask for are
# already loaded, and find all three by DT_RPATH, which goes before LD_LIBRARY_PATH and the system's
# choice of alternatives. DT_RUNPATH would not hold for what the libraries themselves load.
find_path(FATHOM_SERIAL_BLAS_DIR libopenblas.so.0
  PATHS /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/openblas-serial
  NO_DEFAULT_PATH DOC "Folder with a serial libopenblas.so.0, libblas.so.3 and liblapack.so.3")

if(FATHOM_SERIAL_BLAS_DIR)
  set(FATHOM_HAS_SERIAL_BLAS 1)
  string(JOIN " " serial_blas_flags
    -Wl,--disable-new-dtags -Wl,--push-state,--no-as-needed
    ${FATHOM_SERIAL_BLAS_DIR}/libopenblas.so.0 ${FATHOM_SERIAL_BLAS_DIR}/libblas.so.3
    ${FATHOM_SERIAL_BLAS_DIR}/liblapack.so.3 -Wl,--pop-state)
  string(APPEND CMAKE_EXE_LINKER_FLAGS " ${serial_blas_flags}")
  # The same path in the build folder: CMake ends one of its own with a separator, which stands for
  # the working directory.
  list(APPEND CMAKE_INSTALL_RPATH ${FATHOM_SERIAL_BLAS_DIR})
  set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON)
  set(CMAKE_BUILD_WITH_INSTALL_RPATH ON)
else()
  set(FATHOM_HAS_SERIAL_BLAS 0)
  message(STATUS "No serial OpenBLAS (Debian: libopenblas0-serial): the programs hold the threaded "
                 "one to one thread, but its idle pool is started")
endif()
