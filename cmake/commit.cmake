# Writes OUT, a header that names the commit of SOURCE, when that has changed: `cmake -DSOURCE=.. -DOUT=.. -P commit.cmake`.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=7 --match=
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit unknown)
endif()
set(text "#pragma once\n#define DMF_SIM_COMMIT \"${commit}\"\n")
set(old "")
if(EXISTS ${OUT})
  file(READ ${OUT} old)
endif()
if(NOT text STREQUAL old)
  file(WRITE ${OUT} "${text}")
endif()
