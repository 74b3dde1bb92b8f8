# Run at installation: the manual pages name the documentation that is installed with them. A package is built in a
# folder of its own, and unpacked below /usr (CPACK_PACKAGING_INSTALL_PREFIX).
cmake_policy(VERSION 3.25)
set(karst_doc "${CMAKE_INSTALL_PREFIX}")
if(karst_doc MATCHES "/_CPack_Packages/")
  set(karst_doc /usr)
endif()
string(REPLACE "-" "\\-" karst_doc "${karst_doc}/share/doc/karst")  # as roff has it
if(NOT IS_ABSOLUTE "${karst_man_pages}")
  set(karst_man_pages "${CMAKE_INSTALL_PREFIX}/${karst_man_pages}")
endif()
file(GLOB karst_pages "$ENV{DESTDIR}${karst_man_pages}/karst*.1")
foreach(karst_page IN LISTS karst_pages)
  file(READ "${karst_page}" karst_text)
  string(REPLACE "KARST_DOC_FOLDER" "${karst_doc}" karst_text "${karst_text}")
  file(WRITE "${karst_page}" "${karst_text}")
endforeach()
