find_package(nlohmann_json REQUIRED)
karst_library(karst_policy_command policy_command.cpp check_command.cpp request_replay_command.cpp LINK karst_check karst_host nlohmann_json::nlohmann_json CLI11::CLI11)
