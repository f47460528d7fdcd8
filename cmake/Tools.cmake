# Target `format`: clang-format 14, the version the layout is that of.
find_program(THIXIS_CLANG_FORMAT NAMES clang-format-14 clang-format)
mark_as_advanced(THIXIS_CLANG_FORMAT)
if(THIXIS_CLANG_FORMAT)
  add_custom_target(format COMMAND find packages apps tests -name "*.[ch]pp" -exec ${THIXIS_CLANG_FORMAT} -i {} +
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} COMMENT "Formatting" VERBATIM)
endif()
