# `cmake --install`: the engine as a package of its own, find_package(cordis) and cordis::engine.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/cordis)
install(TARGETS cordis_engine EXPORT cordis_targets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/cordis)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/sim_node/engine
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/cordis/sim_node
  FILES_MATCHING PATTERN "*.h")
install(EXPORT cordis_targets NAMESPACE cordis:: FILE cordis-targets.cmake DESTINATION ${package_dir})

configure_package_config_file(
  ${CMAKE_CURRENT_LIST_DIR}/cordis-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/cordis-config.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(
  ${CMAKE_CURRENT_BINARY_DIR}/cordis-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES
  ${CMAKE_CURRENT_BINARY_DIR}/cordis-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/cordis-config-version.cmake
  DESTINATION ${package_dir})
