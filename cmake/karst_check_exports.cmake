# Fails, and removes the file, unless it exports karst_plugin_entry and nothing else.
execute_process(COMMAND ${NM} -D --defined-only ${FILE} OUTPUT_VARIABLE symbols RESULT_VARIABLE failed)
string(REGEX MATCHALL "[A-Za-z] [^\n]+" symbols "${symbols}")
list(TRANSFORM symbols REPLACE "^. " "")
if(failed OR NOT symbols STREQUAL "karst_plugin_entry")
  file(REMOVE ${FILE})
  list(JOIN symbols ", " symbols)
  message(FATAL_ERROR "${FILE} must export karst_plugin_entry and nothing else; it exports: ${symbols}.\n"
                      "Register the policy with KARST_POLICY, once.")
endif()
