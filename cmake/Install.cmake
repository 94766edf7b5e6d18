# What `cmake --install` installs, in components: library (shared only), development, command, python.
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/roadstereo)

# A 0.x version is compatible with itself only. Objects of shared and static libraries are the same, for compiler caches.
set(roadstereo_libraries roadstereo roadstereo_graph roadstereo_mapping roadstereo_odometry roadstereo_synth)
if(NOT ROADSTEREO_EMBEDDED_ONLY)
  list(APPEND roadstereo_libraries roadstereo_io)
endif()
set_target_properties(${roadstereo_libraries} PROPERTIES
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} DEFINE_SYMBOL "")

# roadstereo_install(<export> <target>...): a library and what its users link.
function(roadstereo_install export)
  install(TARGETS ${ARGN} EXPORT ${export}
          LIBRARY COMPONENT library NAMELINK_COMPONENT development
          ARCHIVE COMPONENT development)
endfunction()
roadstereo_install(roadstereoTargets roadstereo roadstereo_mapping roadstereo_odometry roadstereo_synth)
if(ROADSTEREO_WITH_CUDA AND NOT BUILD_SHARED_LIBS)
  roadstereo_install(roadstereoTargets roadstereo_cuda)
endif()
install(EXPORT roadstereoTargets NAMESPACE roadstereo:: DESTINATION ${package_folder} COMPONENT development)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/roadstereo DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        COMPONENT development FILES_MATCHING PATTERN "*.hpp" PATTERN "io" EXCLUDE)
install(FILES ${PROJECT_BINARY_DIR}/generated/roadstereo/version.hpp
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/roadstereo COMPONENT development)

# Sets of their own, so that a user of the embedded library need have neither Ceres nor OpenCV.
roadstereo_install(roadstereoGraphTargets roadstereo_graph)
install(EXPORT roadstereoGraphTargets NAMESPACE roadstereo:: DESTINATION ${package_folder} COMPONENT development)
if(NOT ROADSTEREO_EMBEDDED_ONLY)
  roadstereo_install(roadstereoIoTargets roadstereo_io)
  install(EXPORT roadstereoIoTargets NAMESPACE roadstereo:: DESTINATION ${package_folder} COMPONENT development)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/roadstereo/io DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/roadstereo
          COMPONENT development)
  install(TARGETS roadstereo_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT command)
endif()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/roadstereoConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/roadstereoConfig.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/roadstereoConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/roadstereoConfig.cmake ${PROJECT_BINARY_DIR}/roadstereoConfigVersion.cmake
        DESTINATION ${package_folder} COMPONENT development)

# pkg-config, for builds without CMake: what a static library needs stands in Libs, too.
set(private_libraries "")
if(NOT BUILD_SHARED_LIBS)
  set(private_libraries "-lpthread")
  if(ROADSTEREO_TBB)
    string(APPEND private_libraries " -ltbb")
  endif()
  if(NOT ROADSTEREO_HIGHWAY_SOURCE)
    string(APPEND private_libraries " -lhwy")
  endif()
endif()
# Relative, so that any --prefix of an installation will do.
file(RELATIVE_PATH prefix_of_pkgconfig /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(${PROJECT_SOURCE_DIR}/cmake/roadstereo.pc.in ${PROJECT_BINARY_DIR}/roadstereo.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/roadstereo.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development)
