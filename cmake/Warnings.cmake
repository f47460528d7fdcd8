# Null pointers stop the address sanitizer, too; together with the others of these checks they double the time of compilation.
set(THIXIS_NOT_SANITIZED -fno-sanitize=vptr,null,alignment,object-size)

# thixis_warnings: how every target of the project is compiled. With sanitizers g++ 12 reports initialized variables as uninitialized ones.
add_library(thixis_warnings INTERFACE)
target_compile_options(thixis_warnings INTERFACE -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wno-missing-field-initializers
  $<$<BOOL:${THIXIS_WARNINGS_AS_ERRORS}>:-Werror>
  $<$<BOOL:${THIXIS_SANITIZE}>:-fsanitize=address,undefined ${THIXIS_NOT_SANITIZED} -fno-omit-frame-pointer -Wno-maybe-uninitialized>)
# The sanitizer loads libraries in the program's place, and finds those beside it by the older kind of run path only.
target_link_options(thixis_warnings INTERFACE $<$<BOOL:${THIXIS_SANITIZE}>:-fsanitize=address,undefined -Wl,--disable-new-dtags>)
target_compile_definitions(thixis_warnings INTERFACE $<$<BOOL:${THIXIS_ASSERTIONS}>:THIXIS_ASSERTIONS>)
