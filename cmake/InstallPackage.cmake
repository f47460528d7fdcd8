# The CMake package of the installed project: libraries Thixis::core ... Thixis::drive with their public headers, and Dependencies.cmake,
# by which a client finds Trilinos and the rest again. No path of the build is written down.
include(CMakePackageConfigHelpers)
set(THIXIS_INSTALL_CMAKE ${CMAKE_INSTALL_LIBDIR}/cmake/Thixis)

get_property(packages GLOBAL PROPERTY THIXIS_PACKAGES)
foreach(package ${packages})
  install(TARGETS thixis_${package} EXPORT ThixisTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/packages/${package}/include/thixis DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN *.hpp)
endforeach()
install(EXPORT ThixisTargets NAMESPACE Thixis:: DESTINATION ${THIXIS_INSTALL_CMAKE})

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/ThixisConfig.cmake.in ${PROJECT_BINARY_DIR}/ThixisConfig.cmake
  INSTALL_DESTINATION ${THIXIS_INSTALL_CMAKE})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/ThixisConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/ThixisConfig.cmake ${PROJECT_BINARY_DIR}/ThixisConfigVersion.cmake
              ${CMAKE_CURRENT_LIST_DIR}/Dependencies.cmake
  DESTINATION ${THIXIS_INSTALL_CMAKE})
