#include "sdk/host/plugin/script_file.h"

#include <dlfcn.h>

#include <cstring>
#include <fstream>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "sdk/abi/karst_abi_script.h"
#include "sdk/host/boundary/text.h"

namespace karst::host {
namespace {

namespace fs = std::filesystem;
using core::InputError;

constexpr std::uint64_t kMaxScriptBytes = 16u << 20;

fs::path language_of(const fs::path& file) {
  const std::string ending = file.extension().string();
  return ending.size() < 2 ? fs::path() : own_libraries() / "languages" / (ending.substr(1) + ".so");
}

}  // namespace

bool is_script(const fs::path& file) { return file.extension() == ".py"; }

fs::path own_libraries() {
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  if (error) return {};
  // A policy's process runs in lib/karst itself.
  const fs::path folder = self.parent_path();
  return folder.filename() == "karst" && folder.parent_path().filename() == "lib"
             ? folder
             : folder.parent_path() / "lib/karst";
}

std::string without_python() {
  return "this karst has no Python: install the package karst-python, or build karst where pybind11-dev, "
         "python3-dev and python3-numpy are installed";
}

const karst_plugin_t& enter_script(const std::string& path) {
  core::check_input(path, kMaxScriptBytes);
  const fs::path language = language_of(path);
  if (!fs::exists(language)) throw InputError(path, "", without_python());
  void* handle = dlopen(language.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr)
    throw InputError(path, "", "its language cannot be opened: " + std::string(dlerror()));
  const auto entry = reinterpret_cast<karst_script_entry_fn>(dlsym(handle, KARST_SCRIPT_ENTRY_NAME));
  if (entry == nullptr) throw InputError(language.string(), "", "exports no " KARST_SCRIPT_ENTRY_NAME);
  const std::string file = fs::absolute(path).string();
  karst_error_t error{};
  const karst_plugin_t* plugin = entry({file.data(), file.size()}, &error);
  if (plugin == nullptr) throw InputError(path, "", text_of(error));
  return *plugin;
}

bool may_hold_policy(const fs::path& file) {
  std::error_code error;
  if (fs::file_size(file, error) > kMaxScriptBytes || error) return false;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if ((line.starts_with("class ") && line.find("Policy") != std::string::npos) ||
        line.starts_with("def decide("))
      return true;
  return false;
}

}  // namespace karst::host
