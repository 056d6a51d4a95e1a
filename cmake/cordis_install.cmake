# `cmake --install`: the programs with the page, idl and launch_configs, and a package for programs of others:
# find_package(cordis), cordis::engine and cordis::scene_file.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/cordis)

# The headers behind <cordis/world.h> and <cordis/scene_file.h>, and no others.
set(engine_headers
  core/aligned_vector.h core/vec.h core/vector_width.h
  description/drive.h description/energy.h description/integrator_kind.h description/network.h description/state_machine.h description/surface.h description/variable.h
  description/world_records.h
  expressions/instruction.h expressions/program.h expressions/program_term.h
  laws/law.h laws/law_field.h laws/law_term.h
  links/link_event.h
  world.h)
get_property(laws GLOBAL PROPERTY cordis_laws)
foreach(law ${laws})
  list(APPEND engine_headers laws/${law}.h)
endforeach()
foreach(header ${engine_headers})
  get_filename_component(folder ${header} DIRECTORY)
  install(FILES ${PROJECT_SOURCE_DIR}/sim_node/engine/${header}
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/cordis/sim_node/engine/${folder})
endforeach()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/cordis DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

# The static libraries behind both targets; all but these two are details of theirs.
install(TARGETS cordis_engine cordis_config cordis_scene cordis_plan cordis_reduction cordis_scene_file
  EXPORT cordis_targets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} ${CMAKE_INSTALL_INCLUDEDIR}/cordis)
install(EXPORT cordis_targets NAMESPACE cordis:: FILE cordis-targets.cmake DESTINATION ${package_dir})

configure_package_config_file(
  ${CMAKE_CURRENT_LIST_DIR}/cordis-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/cordis-config.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(
  ${CMAKE_CURRENT_BINARY_DIR}/cordis-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES
  ${CMAKE_CURRENT_BINARY_DIR}/cordis-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/cordis-config-version.cmake
  DESTINATION ${package_dir})

# The programs find each other in one folder, and the page in share/cordis/page beside it.
if(NOT CORDIS_UNIT_TESTS_ONLY)
  install(TARGETS cordis sim_node device_node viz_node record_node RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(DIRECTORY ${CMAKE_BINARY_DIR}/share/cordis/page DESTINATION share/cordis OPTIONAL)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/launch_configs DESTINATION share/cordis)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/idl DESTINATION share/cordis
    FILES_MATCHING PATTERN "*.idl" PATTERN "*.md" PATTERN "*.xml")
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples DESTINATION share/cordis)
endif()
