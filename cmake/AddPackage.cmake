# thixis_add_package(<name> LAYER <n> SOURCES <files> [PUBLIC <targets>] [PRIVATE <targets>])
#
# One package: library thixis_<name>, alias thixis::<name>, public headers in include/thixis/<name>. A package sees only packages
# of lower layers; anything else ends the configuration, in thixis_check_layers.
function(thixis_add_package name)
  cmake_parse_arguments(PACKAGE "" "LAYER" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set_property(GLOBAL PROPERTY THIXIS_LAYER_thixis::${name} ${PACKAGE_LAYER})
  set_property(GLOBAL PROPERTY THIXIS_ARROWS_${name} ${PACKAGE_PUBLIC} ${PACKAGE_PRIVATE})
  set_property(GLOBAL APPEND PROPERTY THIXIS_PACKAGES ${name})

  add_library(thixis_${name} STATIC ${PACKAGE_SOURCES})
  add_library(thixis::${name} ALIAS thixis_${name})
  target_include_directories(thixis_${name}
    PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
  target_compile_features(thixis_${name} PUBLIC cxx_std_17)
  target_link_libraries(thixis_${name} PUBLIC ${PACKAGE_PUBLIC} PRIVATE ${PACKAGE_PRIVATE} $<BUILD_INTERFACE:thixis_warnings>)
  set_target_properties(thixis_${name} PROPERTIES EXPORT_NAME ${name})
endfunction()

# Ends the configuration if an arrow goes up or sideways. To be called after the last package: the arrows that go up are those to
# packages that come later.
function(thixis_check_layers)
  get_property(packages GLOBAL PROPERTY THIXIS_PACKAGES)
  foreach(name ${packages})
    get_property(layer GLOBAL PROPERTY THIXIS_LAYER_thixis::${name})
    get_property(dependencies GLOBAL PROPERTY THIXIS_ARROWS_${name})
    foreach(dependency ${dependencies})
      get_property(below GLOBAL PROPERTY THIXIS_LAYER_${dependency})
      if(NOT "${below}" STREQUAL "" AND NOT below LESS layer)
        message(FATAL_ERROR "Package '${name}' (layer ${layer}) must not depend on '${dependency}' (layer ${below}): arrows go down.")
      endif()
    endforeach()
  endforeach()
endfunction()
