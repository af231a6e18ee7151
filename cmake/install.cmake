# Installs the program and the library: find_package(motes), then link motes::motes or single rooms.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(rooms GLOBAL PROPERTY MOTES_ROOMS)

# All rooms behind one name.
add_library(motes_all INTERFACE)
add_library(motes::motes ALIAS motes_all)
set_target_properties(motes_all PROPERTIES EXPORT_NAME motes)
target_link_libraries(motes_all INTERFACE ${rooms})
target_include_directories(motes_all INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/motes)
install(TARGETS ${rooms} motes_all EXPORT motes ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT motes NAMESPACE motes:: DESTINATION ${package_dir} FILE motesTargets.cmake)
# "room/file.h" below include/motes, where <motes/motes.h> finds them.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/motes
  FILES_MATCHING PATTERN "*.h")

# The package looks for its dependencies with the build's own list. Its files are made where
# find_package() does not look: it searches the directories of PATH, the program's among them.
set(generated_dir ${PROJECT_BINARY_DIR}/generated/package)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/motesConfig.cmake.in
  ${generated_dir}/motesConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${generated_dir}/motesConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${generated_dir}/motesConfig.cmake
  ${generated_dir}/motesConfigVersion.cmake
  ${PROJECT_SOURCE_DIR}/cmake/dependencies.cmake
  DESTINATION ${package_dir})

# All that cmake --install copies, without tests and benchmarks.
add_custom_target(installable)
add_dependencies(installable ${rooms})
if(TARGET motes)
  install(TARGETS motes RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  add_dependencies(installable motes)
endif()
