find_package(nlohmann_json REQUIRED)
# What `karst policy new` writes is what the tutorials explain.
set(examples ${PROJECT_SOURCE_DIR}/examples/policies)
set(templates ${CMAKE_CURRENT_BINARY_DIR}/policy_templates.cpp)
karst_embed(${templates} HEADER sdk/tools/policy_templates.h NAMESPACE karst::tools
  ONE nearest_policy=${examples}/1_nearest/my_nearest.cpp nearest_test=${examples}/1_nearest/my_nearest_test.cpp
      tour_policy=${examples}/2_tour/my_tour.cpp tour_test=${examples}/2_tour/my_tour_test.cpp
      memory_policy=${examples}/3_memory/my_memory.cpp memory_test=${examples}/3_memory/my_memory_test.cpp
      policy_cmake=${examples}/1_nearest/CMakeLists.txt policy_readme=${CMAKE_CURRENT_SOURCE_DIR}/new_policy/README.md)
karst_library(karst_policy_command policy_command.cpp policy_name.cpp policy_new.cpp ${templates}
              check_command.cpp request_replay_command.cpp
              LINK karst_terminal karst_check karst_host nlohmann_json::nlohmann_json CLI11::CLI11)
