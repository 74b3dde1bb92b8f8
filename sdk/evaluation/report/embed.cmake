# cmake -DOUT=assets.cpp "-DTEMPLATE=..." "-DSTYLE=..." "-DLIBRARIES=a|b" "-DSCRIPTS=a|b" -P embed.cmake
# Writes the files' bytes into a C++ source as raw string literals.
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
  string(REPLACE "|" ";" files "${files}")
  file(APPEND "${OUT}" "std::vector<std::string_view> ${name}() {\n  return {\n")
  foreach(file IN LISTS files)
    literal("${file}" text)
    file(APPEND "${OUT}" "${text},\n")
  endforeach()
  file(APPEND "${OUT}" "  };\n}\n\n")
endfunction()

file(WRITE "${OUT}" "#include \"sdk/evaluation/report_assets.h\"\n\nnamespace karst::evaluation {\n\n")
one(report_template "${TEMPLATE}")
one(report_style "${STYLE}")
many(report_libraries "${LIBRARIES}")
many(report_scripts "${SCRIPTS}")
file(APPEND "${OUT}" "}  // namespace karst::evaluation\n")
