# `cpack`: Debian packages, one for each component of install() (docs/packages.md). Include last.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME fathom)
set(CPACK_PACKAGE_VENDOR Fathom)
set(CPACK_PACKAGE_CONTACT "Fathom maintainers <maintainers@users.noreply.h-seed-07ab0633.example>")
# Each package has a synopsis of its own; one that is set here would go before it.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_OUTPUT_FILE_PREFIX ${PROJECT_BINARY_DIR}/packages)
# Folders are for everybody, whatever the umask of who packs.
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

# Debian wants every package's changes compressed in its folder of documents.
set(changelog ${PROJECT_BINARY_DIR}/changelog)
configure_file(${PROJECT_SOURCE_DIR}/cmake/package/changelog.in ${changelog} @ONLY)
execute_process(COMMAND gzip -9nkf ${changelog} COMMAND_ERROR_IS_FATAL ANY)

# Licences in the package's form: lines begin with a blank there.
function(fathom_licence variable file)
  file(READ ${PROJECT_SOURCE_DIR}/${file} text)
  string(STRIP "${text}" text)
  string(REPLACE "\n" "\n " text " ${text}")
  string(REPLACE "\n \n" "\n .\n" text "${text}")
  set(${variable} "${text}" PARENT_SCOPE)
endfunction()
fathom_licence(fathom_licence LICENSE)
fathom_licence(vega_licence src/report/page/vega_licence.txt)
configure_file(${PROJECT_SOURCE_DIR}/cmake/package/copyright.in ${PROJECT_BINARY_DIR}/copyright @ONLY)

# fathom_package(COMPONENT PACKAGE SECTION DEPENDS SYNOPSIS TEXT): what the component is packed as.
set(CPACK_COMPONENTS_ALL "")
function(fathom_package component name section depends synopsis text)
  string(TOUPPER ${component} key)
  set(CPACK_DEBIAN_${key}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_DEPENDS "${depends}" PARENT_SCOPE)
  set(CPACK_COMPONENT_${key}_DESCRIPTION "${synopsis}
Runs several SLAM back ends on the same recorded measurements of a survey
and reports how accurate, how consistent and how expensive each of them is.
.
${text}" PARENT_SCOPE)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} PARENT_SCOPE)
  install(FILES ${PROJECT_BINARY_DIR}/copyright ${changelog}.gz
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component})
  # Why some have a path of their own to the libraries: cmake/ThreadSafeBlas.cmake.
  set(overrides ${PROJECT_SOURCE_DIR}/cmake/package/${name}.lintian-overrides)
  if(EXISTS ${overrides})
    install(FILES ${overrides} DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides
            RENAME ${name} COMPONENT ${component})
  endif()
endfunction()

set(same_version "(= ${PROJECT_VERSION})")
# The threaded OpenBLAS by name: any other would do for the linker (cmake/ThreadSafeBlas.cmake).
set(blas "")
if(FATHOM_BLAS_DIR)
  set(blas "libopenblas0-pthread")
endif()

fathom_package(program fathom science "${blas}"
  "comparison of SLAM back ends for robots over a flat floor"
  "This package has the program, its man pages and its completion for bash.")

# What find_package(fathom) looks for.
set(headers libeigen3-dev libopencv-dev libceres-dev libsuitesparse-dev libfmt-dev libyaml-cpp-dev
    libsqlitecpp-dev libsqlite3-dev nlohmann-json3-dev libcairo2-dev libopenblas-dev libboost-dev
    pkg-config)
foreach(pair EXIF:libexif-dev SCOTCH:libscotch-dev PROJ:libproj-dev GEOTIFF:libgeotiff-dev GEOTIFF:libtiff-dev
             FASTCDR:libfastcdr-dev COMPRESSION:liblz4-dev COMPRESSION:libzstd-dev)
  string(REPLACE ":" ";" pair ${pair})
  list(GET pair 0 part)
  list(GET pair 1 package)
  if(FATHOM_HAS_${part})
    list(APPEND headers ${package})
  endif()
endforeach()
list(JOIN headers ", " headers)
fathom_package(dev libfathom-dev libdevel "${headers}"
  "comparison of SLAM back ends - libraries and headers"
  "This package has the static libraries, the headers and the CMake package, for
programs that use them and for plug-ins.")

if(TARGET fathom_python)
  get_directory_property(minor DIRECTORY python DEFINITION Python3_VERSION_MINOR)
  math(EXPR next "${minor} + 1")
  fathom_package(python python3-fathom python
    "fathom ${same_version}, python3 (>= 3.${minor}), python3 (<< 3.${next}), python3-numpy"
    "comparison of SLAM back ends - Python module"
    "This package has the Python module, and lets the program read estimators that
are written in Python.")
  # Recommended, it would bring a compiler along.
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-pandas, python3-matplotlib, python3-tqdm")
endif()

get_property(adapters GLOBAL PROPERTY FATHOM_ADAPTER_NAMES)
foreach(adapter IN LISTS adapters)
  fathom_package(adapter_${adapter} fathom-adapter-${adapter} science "fathom ${same_version}"
    "comparison of SLAM back ends - ${adapter} as a plug-in"
    "This package has ${adapter}'s solver as a plug-in.")
endforeach()

include(CPack)
