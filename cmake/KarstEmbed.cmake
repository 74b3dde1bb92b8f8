# karst_embed(OUT HEADER header NAMESPACE namespace [ONE name=file...] [MANY name=file,file...]): the C++ source
# OUT, which defines the functions that HEADER declares: each gives a file's text, or a list of several.
function(karst_embed out)
  cmake_parse_arguments(A "" "HEADER;NAMESPACE" "ONE;MANY" ${ARGN})
  set(files)
  foreach(asset IN LISTS A_ONE A_MANY)
    string(REGEX REPLACE "^[^=]*=" "" paths "${asset}")
    string(REPLACE "," ";" paths "${paths}")
    list(APPEND files ${paths})
  endforeach()
  list(JOIN A_ONE "|" one)
  list(JOIN A_MANY "|" many)
  set(script ${PROJECT_SOURCE_DIR}/cmake/karst_embed.cmake)
  add_custom_command(
    OUTPUT ${out}
    COMMAND ${CMAKE_COMMAND} -DOUT=${out} -DHEADER=${A_HEADER} -DNAMESPACE=${A_NAMESPACE}
            "-DONE=${one}" "-DMANY=${many}" -P ${script}
    DEPENDS ${script} ${files}
    COMMENT "Embedding ${A_HEADER}"
    VERBATIM)
  set_source_files_properties(${out} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)  # it is not there yet
endfunction()
