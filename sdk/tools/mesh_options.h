// The options that say how a bare mesh or a cloud is to be read: --scale, --unit, --up, --offset.
#pragma once
#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core_stack/vehicle/mesh_keys.h"
#include "sdk/tools/arguments.h"

namespace karst::tools {

/// Those given: keys of core::MeshKeys with their values.
using MeshOptions = std::vector<std::pair<std::string, std::string>>;

/// ": m, cm or mm"; "" of none.
inline std::string choices_text(const std::vector<std::string>& choices) {
  std::string text;
  for (std::size_t i = 0; i < choices.size(); ++i)
    text += (i == 0 ? ": " : i + 1 == choices.size() ? " or " : ", ") + choices[i];
  return text;
}

enum class ReadFile { mesh, cloud };

/// `given` must outlive the application's parsing.
inline void add_mesh_options(CLI::App& app, MeshOptions& given, ReadFile file = ReadFile::mesh) {
  core::MeshKeys keys;
  core::OptionTable table;
  describe(table, keys);
  for (const auto& row : table.rows()) {
    std::string help = row.help + choices_text(row.choices);
    if (file == ReadFile::mesh)
      help += " (also a key of cave files)";
    else if (const std::size_t at = help.find("mesh"); at != std::string::npos)
      help.replace(at, std::string("mesh").size(), "cloud");
    app.add_option_function<std::string>(
           "--" + row.key,
           [&given, key = row.key](const std::string& value) { given.emplace_back(key, value); }, help)
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
