#include "core_stack/vehicle/load_vehicle.h"

#include <dlfcn.h>

#include <algorithm>
#include <vector>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"

namespace karst::core {
namespace {

constexpr const char* kPrefix = "libkarst_vehicle_";

}  // namespace

std::vector<std::string> vehicles_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string stem = entry.path().stem().string();
    if (stem.starts_with(kPrefix)) names.push_back(stem.substr(std::string(kPrefix).size()));
  }
  std::sort(names.begin(), names.end());
  return names;
}

VehiclePlugin& load_vehicle(const std::string& name, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / (kPrefix + name + ".so");
  if (!std::filesystem::exists(file)) {
    std::string have = "no vehicle \"" + name + "\" here; there is:";
    for (const std::string& v : vehicles_in(folder)) have += " " + v;
    throw InputError(folder.string(), "", have);
  }
  check_input(file.string(), kMaxPluginBytes);
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw InputError(file.string(), "", dlerror());
  const auto entry = reinterpret_cast<karst_vehicle_plugin_fn>(dlsym(library, "karst_vehicle_plugin"));
  if (entry == nullptr)
    throw InputError(file.string(), "", "exports no karst_vehicle_plugin: no vehicle plugin");
  return *entry();
}

}  // namespace karst::core
