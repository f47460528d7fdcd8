# Targets `format` (clang-format 14, the version the layout is that of) and `tidy` (clang-tidy of all that is compiled in packages and apps).
find_program(THIXIS_CLANG_FORMAT NAMES clang-format-14 clang-format)
find_program(THIXIS_CLANG_TIDY NAMES run-clang-tidy-14 run-clang-tidy)
mark_as_advanced(THIXIS_CLANG_FORMAT THIXIS_CLANG_TIDY)
if(THIXIS_CLANG_FORMAT)
  add_custom_target(format COMMAND find packages apps tests -name "*.[ch]pp" -exec ${THIXIS_CLANG_FORMAT} -i {} +
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} COMMENT "Formatting" VERBATIM)
endif()
if(THIXIS_CLANG_TIDY)
  add_custom_target(tidy COMMAND ${THIXIS_CLANG_TIDY} -quiet -p ${PROJECT_BINARY_DIR} "${PROJECT_SOURCE_DIR}/(packages|apps)/.*"
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} COMMENT "Looking for mistakes" VERBATIM USES_TERMINAL)
endif()
