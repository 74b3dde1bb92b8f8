# karst_add_policy(NAME sources...): a policy plugin NAME.so in lib/karst/policies of the build tree.
#
# Only karst_plugin_entry is exported; the build fails if anything else is. `cmake --install` puts it where
# `karst` looks: with --prefix ~/.local that is the user's folder of policies.
function(karst_add_policy name)
  set(support ${CMAKE_CURRENT_FUNCTION_LIST_DIR})
  set(destination share/karst/policies)
  if(KARST_POLICY_DESTINATION)
    set(destination ${KARST_POLICY_DESTINATION})
  endif()
  add_library(${name} MODULE ${ARGN})
  get_property(languages GLOBAL PROPERTY ENABLED_LANGUAGES)
  if(CXX IN_LIST languages)
    target_link_libraries(${name} PRIVATE karst::sdk)
  else()
    target_link_libraries(${name} PRIVATE karst::abi)  # a project in C has no C++17 to ask for
  endif()
  target_link_options(${name} PRIVATE LINKER:--version-script=${support}/karst_policy.map)
  set_target_properties(${name} PROPERTIES
    PREFIX "" C_VISIBILITY_PRESET hidden CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib/karst/policies
    LINK_DEPENDS ${support}/karst_policy.map)
  add_custom_command(TARGET ${name} POST_BUILD VERBATIM
    COMMAND ${CMAKE_COMMAND} -DNM=${CMAKE_NM} -DFILE=$<TARGET_FILE:${name}>
            -P ${support}/karst_check_exports.cmake)
  install(TARGETS ${name} LIBRARY DESTINATION ${destination})
endfunction()
