#include "sdk/tools/policy_new.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core_stack/common/error.h"
#include "core_stack/common/output_file.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/arguments.h"
#include "sdk/tools/policy_name.h"
#include "sdk/tools/policy_templates.h"

namespace karst::tools {
namespace {

namespace fs = std::filesystem;
using core::InputError;

struct Template {
  std::string_view name, help;
  std::string_view id;      // of its policy
  std::string_view ending;  // of its sources
  std::string_view policy, test;
  std::string_view setting;  // of a parameter, for the README
};

constexpr std::string_view kSetting = "min_cells=20";

std::array<Template, 5> templates() {
  return {
      {{"nearest", "flies to the nearest frontier", "my_nearest", ".cpp", nearest_policy(), nearest_test(),
        kSetting},
       {"tour", "a short tour over the nearest viewpoints", "my_tour", ".cpp", tour_policy(), tour_test(),
        kSetting},
       {"memory", "remembers across decisions: branch by branch", "my_memory", ".cpp", memory_policy(),
        memory_test(), kSetting},
       {"c", "in C: flies to the lowest frontier", "deepest", ".c", c_policy(), c_test(), "max_path=50"},
       {"python", "in Python: flies to the nearest frontier", "my_nearest", ".py", python_policy(),
        python_test(), kSetting}}};
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

/// The template's text with the policy's name `id` replaced by `name`.
std::string renamed(std::string_view text, const std::string& id, const std::string& name) {
  return replaced(replaced(std::string(text), id, name), class_name(id), class_name(name));
}

fs::path this_karst() { return fs::read_symlink("/proc/self/exe"); }

/// The command as typed: its name if the shell finds this very program by it, otherwise its path.
std::string karst_command() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path program = fs::path(folder) / "karst";
    if (::access(program.c_str(), X_OK) != 0) continue;
    std::error_code error;
    if (fs::equivalent(program, this_karst(), error)) return "karst";
    break;
  }
  const std::string all = this_karst().string();
  return all.find_first_of(" \t'\"\\$`;&|<>()*?[]{}~#!") == std::string::npos
             ? all
             : "'" + replaced(all, "'", "'\\''") + "'";
}

/// The prefix where this karst was installed or built with its SDK, or "" if there is no SDK.
std::string sdk_prefix() {
  const fs::path prefix = this_karst().parent_path().parent_path();
  return fs::exists(prefix / "lib/cmake/karst/karstConfig.cmake") ? prefix.string() : "";
}

void write(const fs::path& file, const std::string& text) {
  std::ofstream out = core::open_output(file);
  out << text;
  out.close();
  if (!out) throw InputError(file.string(), "", std::string("cannot be written: ") + std::strerror(errno));
}

std::string cmake_of(const Template& from, const std::string& name) {
  return from.ending == ".c" ? renamed(c_cmake(), std::string(from.id), name)
                             : renamed(policy_cmake(), "my_nearest", name);
}

bool is_compiled(const Template& from) { return from.ending != ".py"; }

std::string readme_of(const Template& from, const std::string& name) {
  std::string text = renamed(is_compiled(from) ? policy_readme() : python_readme(), "my_nearest", name);
  text = replaced(text, "@ending@", std::string(from.ending));
  text = replaced(text, "@setting@", std::string(from.setting));
  // For a debugger: without class or file the name would fit functions of karst, too.
  text = replaced(text, "@decide@", from.ending == ".c" ? name + ".c:decide" : class_name(name) + "::decide");
  return replaced(text, "@karst@", karst_command());
}

void write_folder(const fs::path& folder, const Template& from, const std::string& name,
                  const std::string& sdk) {
  if (is_compiled(from)) {
    std::string cmake = cmake_of(from, name);
    if (!sdk.empty())
      cmake = replaced(cmake, "find_package(karst REQUIRED)",
                       "find_package(karst REQUIRED HINTS [==[" + sdk + "]==])");
    write(folder / "CMakeLists.txt", cmake);
  }
  write(folder / "README.md", readme_of(from, name));
  const std::string id(from.id), ending(from.ending);
  write(folder / (name + ending), renamed(from.policy, id, name));
  write(folder / (name + "_test" + ending), renamed(from.test, id, name));
}

void write_policy(const std::string& name, const std::string& dir, const std::string& kind) {
  if (const std::string fault = name_fault(name); !fault.empty())
    throw InputError("karst policy new", name, fault);
  const std::array all = templates();
  const auto* const from =
      std::find_if(all.begin(), all.end(), [&](const Template& t) { return t.name == kind; });
  const fs::path folder = fs::path(dir) / name;
  std::error_code error;
  if (fs::exists(folder, error))
    throw InputError(folder.string(), "", "is there already; give another name, or another --dir");
  fs::create_directories(dir, error);
  if (!error) fs::create_directory(folder, error);
  if (error) throw InputError(folder.string(), "", "cannot be made: " + error.message());
  const std::string sdk = sdk_prefix();
  try {
    write_folder(folder, *from, name, sdk);
  } catch (...) {
    fs::remove_all(folder, error);
    throw;
  }
  print_out("%s: starts as: %s\n", folder.lexically_normal().c_str(), std::string(from->help).c_str());
  std::vector<fs::path> files;
  for (const fs::directory_entry& e : fs::directory_iterator(folder)) files.push_back(e.path().filename());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) print_out("  %s\n", file.c_str());
  if (!is_compiled(*from)) {
    print_out("next, in that folder:\n  %s python %s_test.py\nREADME.md says how to fly it\n",
              karst_command().c_str(), name.c_str());
    return;
  }
  print_out(
      "next, in that folder:\n  cmake -S . -B build && cmake --build build && ctest --test-dir build\n"
      "README.md says how to fly it\n");
  if (sdk.empty())
    print_out("no SDK lies beside this karst: tell cmake where it is, by -DCMAKE_PREFIX_PATH=FOLDER\n");
}

}  // namespace

void add_policy_new(CLI::App& policy) {
  struct Arguments {
    std::string name, dir = ".", kind = "nearest";
  };
  auto args = std::make_shared<Arguments>();
  std::string help = "policy to start from:";
  std::vector<std::string> names;
  for (const Template& t : templates()) {
    names.emplace_back(t.name);
    help += " " + names.back() + " (" + std::string(t.help) + ")" +
            (names.size() < templates().size() ? "," : "");
  }
  CLI::App* command = policy.add_subcommand(
      "new", "Write a folder with a policy to start from: its code, its test, its build");
  command->add_option("NAME", args->name, "name of the policy: [a-z][a-z0-9_]*")->required();
  command->add_option("--dir", args->dir, "folder into which the new one is written")
      ->type_name(kFolder)
      ->check(not_empty());
  command->add_option("--template", args->kind, help)->check(CLI::IsMember(names))->capture_default_str();
  command->callback([args] { write_policy(args->name, args->dir, args->kind); });
}

}  // namespace karst::tools
