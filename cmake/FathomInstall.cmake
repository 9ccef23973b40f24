# Installs every module's library, the public headers and the CMake package `fathom`, whose targets
# are fathom::core, fathom::geometry … as in this build. Include after all modules are defined.
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/fathom)
get_property(modules GLOBAL PROPERTY FATHOM_MODULES)

install(TARGETS ${modules} EXPORT fathomTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/fathom DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        COMPONENT dev FILES_MATCHING PATTERN "*.hpp")
install(EXPORT fathomTargets NAMESPACE fathom:: DESTINATION ${package_folder} COMPONENT dev)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/fathomConfig.cmake.in fathomConfig.cmake
                              INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(fathomConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/fathomConfig.cmake
              ${PROJECT_BINARY_DIR}/fathomConfigVersion.cmake
        DESTINATION ${package_folder} COMPONENT dev)
