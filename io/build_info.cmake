# Writes build_info.hpp with the commit of the sources as they are now. Run at every build; configure_file leaves the
# file alone when nothing has changed, so that nothing is compiled again.
execute_process(COMMAND git -C ${SOURCE_DIR} rev-parse --show-toplevel
  OUTPUT_VARIABLE TOP OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE FAILED)
file(REAL_PATH ${SOURCE_DIR} HERE)
set(ALPHADOT_COMMIT unknown)
# A source folder without a repository of its own may lie inside that of something else.
if(NOT FAILED AND TOP STREQUAL HERE)
  execute_process(COMMAND git -C ${SOURCE_DIR} describe --always --dirty --abbrev=40 --exclude=*
    OUTPUT_VARIABLE COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE FAILED)
  if(NOT FAILED)
    set(ALPHADOT_COMMIT ${COMMIT})
  endif()
endif()
configure_file(${SOURCE_DIR}/io/build_info.hpp.in ${OUTPUT} @ONLY ESCAPE_QUOTES)
