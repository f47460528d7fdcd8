# Script: version.cpp from its template, with the git hash of the sources ("unknown" outside a checkout).
execute_process(COMMAND git -C ${SOURCE} rev-parse --short=12 HEAD OUTPUT_VARIABLE GIT_HASH OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET
                RESULT_VARIABLE failed)
if(failed)
  set(GIT_HASH unknown)
endif()
configure_file(${TEMPLATE} ${OUTPUT} @ONLY)
