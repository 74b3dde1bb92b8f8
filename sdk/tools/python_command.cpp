#include "sdk/tools/python_command.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core_stack/common/error.h"
#include "sdk/host/plugin/script_file.h"

namespace karst::tools {
namespace {

namespace fs = std::filesystem;

/// The Python for which the module was built.
std::string interpreter(const fs::path& modules) {
  std::ifstream in(modules / "interpreter");
  std::string program;
  if (!std::getline(in, program) || program.empty())
    throw core::InputError("karst python", "", host::without_python());
  return program;
}

/// Becomes Python: it has the terminal, and its exit code is ours.
[[noreturn]] void become_python(const std::vector<std::string>& words) {
  const fs::path modules = host::own_libraries() / "python";
  const std::string program = interpreter(modules);
  const char* const before = std::getenv("PYTHONPATH");
  const std::string path = modules.string() + (before == nullptr || *before == 0 ? "" : ":" + std::string(before));
  setenv("PYTHONPATH", path.c_str(), 1);
  setenv("KARST", fs::read_symlink("/proc/self/exe").c_str(), 0);
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  execv(program.c_str(), argv.data());
  throw core::InputError(program, "", std::string("cannot be started: ") + std::strerror(errno));
}

}  // namespace

void add_python_command(CLI::App& app) {
  CLI::App* python = app.add_subcommand("python",
                                        "Run Python with the module karst: a program, a test, a notebook\n\n"
                                        "  karst python my_policy_test.py\n"
                                        "  karst python -m pytest\n"
                                        "  karst python -c \"import karst; print(karst.load('runs/demo'))\"");
  python->prefix_command();  // all words are Python's
  python->callback([python] { become_python(python->remaining()); });
}

}  // namespace karst::tools
