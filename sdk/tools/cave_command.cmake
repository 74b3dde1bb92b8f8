find_package(nlohmann_json REQUIRED)
karst_library(karst_cave_command cave_command.cpp
              LINK karst_terminal karst_cave_description karst_reachable karst_cave_generator karst_cave nlohmann_json::nlohmann_json CLI11::CLI11)
