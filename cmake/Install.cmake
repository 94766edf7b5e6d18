include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/roadstereo)

install(TARGETS roadstereo roadstereo_odometry roadstereo_synth EXPORT roadstereoTargets)
if(ROADSTEREO_WITH_CUDA)
  install(TARGETS roadstereo_cuda EXPORT roadstereoTargets)
endif()
install(EXPORT roadstereoTargets NAMESPACE roadstereo:: DESTINATION ${package_folder})

install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/roadstereo DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN "*.hpp" PATTERN "io" EXCLUDE)
install(FILES ${PROJECT_BINARY_DIR}/generated/roadstereo/version.hpp
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/roadstereo)

# A set of its own, so that a user of the embedded library need not have OpenCV.
if(NOT ROADSTEREO_EMBEDDED_ONLY)
  install(TARGETS roadstereo_io EXPORT roadstereoIoTargets)
  install(EXPORT roadstereoIoTargets NAMESPACE roadstereo:: DESTINATION ${package_folder})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/roadstereo/io DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/roadstereo)
  install(TARGETS roadstereo_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/roadstereoConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/roadstereoConfig.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/roadstereoConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/roadstereoConfig.cmake ${PROJECT_BINARY_DIR}/roadstereoConfigVersion.cmake
        DESTINATION ${package_folder})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
