// The options that say how a bare mesh is to be read: --scale, --unit, --up, --offset.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core_stack/vehicle/mesh_keys.h"
#include "sdk/tools/arguments.h"

namespace karst::tools {

/// Those given: keys of core::MeshKeys with their values.
using MeshOptions = std::vector<std::pair<std::string, std::string>>;

/// `given` must outlive the application's parsing.
inline void add_mesh_options(CLI::App& app, MeshOptions& given) {
  core::MeshKeys keys;
  core::OptionTable table;
  describe(table, keys);
  for (const auto& row : table.rows()) {
    std::string help = row.help;
    for (const std::string& choice : row.choices)
      help += (&choice == &row.choices.front() ? ": " : " or ") + choice;
    app.add_option_function<std::string>(
           "--" + row.key,
           [&given, key = row.key](const std::string& value) { given.emplace_back(key, value); },
           help + "; a cave file has it as a key")
        ->check(not_empty());
  }
}

/// Throws core::InputError naming the option.
inline core::MeshKeys mesh_keys_of(const MeshOptions& given) {
  core::MeshKeys keys;
  core::OptionTable table;
  describe(table, keys);
  for (const auto& [key, value] : given) table.set("command line", key, value);
  return keys;
}

}  // namespace karst::tools
