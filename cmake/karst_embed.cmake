# cmake -DOUT=assets.cpp -DHEADER=... -DNAMESPACE=... "-DONE=name=file|name=file" "-DMANY=name=file,file|..." -P karst_embed.cmake
# Writes the files' bytes into a C++ source as raw string literals: a function for each name, that gives one
# file's text or a list of several.
set(END "karst_asset")

function(literal file out)
  file(READ "${file}" text)
  string(FIND "${text}" ")${END}\"" found)
  if(NOT found EQUAL -1)
    message(FATAL_ERROR "${file} contains the literal's end mark")
  endif()
  set(${out} "R\"${END}(${text})${END}\"" PARENT_SCOPE)
endfunction()

function(one name file)
  literal("${file}" text)
  file(APPEND "${OUT}" "std::string_view ${name}() {\n  static const std::string_view text = ${text};\n  return text;\n}\n\n")
endfunction()

function(many name files)
  string(REPLACE "," ";" files "${files}")
  file(APPEND "${OUT}" "std::vector<std::string_view> ${name}() {\n  return {\n")
  foreach(file IN LISTS files)
    literal("${file}" text)
    file(APPEND "${OUT}" "${text},\n")
  endforeach()
  file(APPEND "${OUT}" "  };\n}\n\n")
endfunction()

file(WRITE "${OUT}" "#include \"${HEADER}\"\n\nnamespace ${NAMESPACE} {\n\n")
foreach(kind one many)
  string(TOUPPER ${kind} list)
  string(REPLACE "|" ";" assets "${${list}}")
  foreach(asset IN LISTS assets)
    string(REGEX MATCH "^([^=]*)=(.*)$" matched "${asset}")
    cmake_language(CALL ${kind} ${CMAKE_MATCH_1} "${CMAKE_MATCH_2}")
  endforeach()
endforeach()
file(APPEND "${OUT}" "}  // namespace ${NAMESPACE}\n")
