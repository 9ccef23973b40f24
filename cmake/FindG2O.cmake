# g2o with CHOLMOD: the target G2O::slam2d, for pose graphs in the plane, and G2O_CORE_LIBRARY.
# Debian packs it without package files of its own.
find_path(G2O_INCLUDE_DIR g2o/core/sparse_optimizer.h)
set(G2O_LIBRARIES "")
set(required G2O_INCLUDE_DIR)
foreach(part CORE STUFF TYPES_SLAM2D SOLVER_CHOLMOD SOLVER_SLAM2D_LINEAR)
  string(TOLOWER g2o_${part} name)
  find_library(G2O_${part}_LIBRARY ${name})
  mark_as_advanced(G2O_${part}_LIBRARY)
  list(APPEND required G2O_${part}_LIBRARY)
  list(APPEND G2O_LIBRARIES ${G2O_${part}_LIBRARY})
endforeach()
mark_as_advanced(G2O_INCLUDE_DIR)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(G2O REQUIRED_VARS ${required})

if(G2O_FOUND AND NOT TARGET G2O::slam2d)
  add_library(G2O::slam2d INTERFACE IMPORTED)
  set_target_properties(G2O::slam2d PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${G2O_INCLUDE_DIR})
  target_link_libraries(G2O::slam2d INTERFACE ${G2O_LIBRARIES} Eigen3::Eigen)
endif()
