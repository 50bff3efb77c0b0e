# cmake --install: headers, static libraries, the package for find_package(sinew), the program and
# the Python package. The installed program and Python package are self-contained. The static libraries
# need Sinew's system libraries, which sinewConfig.cmake finds.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(modules GLOBAL PROPERTY SINEW_MODULES)
list(TRANSFORM modules PREPEND sinew_)
install(TARGETS ${modules} sinew_sinew EXPORT sinewTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/sinew DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN "*.hpp")

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/sinew)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/sinewConfig.cmake.in
                              ${CMAKE_BINARY_DIR}/sinewConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/sinewConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(EXPORT sinewTargets NAMESPACE sinew:: DESTINATION ${package_dir})
install(FILES ${CMAKE_BINARY_DIR}/sinewConfig.cmake ${CMAKE_BINARY_DIR}/sinewConfigVersion.cmake
              ${CMAKE_CURRENT_LIST_DIR}/SinewSystemLibraries.cmake
        DESTINATION ${package_dir})

if(TARGET sinew)
  install(TARGETS sinew RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

if(SINEW_VIEWER)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DATADIR}/sinew)
endif()

if(SINEW_TESTS)
  # Builds a small project outside this tree against an installed copy.
  add_test(NAME install COMMAND ${CMAKE_COMMAND}
           -D SINEW_BINARY_DIR=${CMAKE_BINARY_DIR}
           -D SINEW_VERSION=${PROJECT_VERSION}
           -D SANITIZE=${SINEW_SANITIZE}
           -D GENERATOR=${CMAKE_GENERATOR}
           -D CXX_COMPILER=${CMAKE_CXX_COMPILER}
           -D LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER}
           -P ${PROJECT_SOURCE_DIR}/tests/install/run.cmake)
endif()
