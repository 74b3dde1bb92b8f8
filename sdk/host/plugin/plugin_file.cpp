#include "sdk/host/plugin/plugin_file.h"

#include <dlfcn.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <set>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "sdk/host/boundary/text.h"
#include "sdk/host/plugin/process_state.h"
#include "sdk/host/plugin/script_file.h"

namespace karst::host {
namespace {

using core::InputError;

constexpr std::array<std::uint32_t, 3> kHostRelease = {KARST_VERSION_MAJOR, KARST_VERSION_MINOR,
                                                       KARST_VERSION_PATCH};
constexpr std::uint32_t kMaxPolicies = 64, kMaxParameters = 256;

std::string abi_text(std::uint32_t major, std::uint32_t minor) {
  return std::to_string(major) + "." + std::to_string(minor);
}

std::string release_text(const std::uint32_t* v) {
  return std::to_string(v[0]) + "." + std::to_string(v[1]) + "." + std::to_string(v[2]);
}

bool is_identifier(const std::string& s) {
  if (s.empty() || s[0] < 'a' || s[0] > 'z') return false;
  return s.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
}

/// "" or the first mandatory slot that is missing. The size check comes first: a short table has no later
/// slots.
std::string missing_slot(const karst_policy_t& p) {
// NOLINTBEGIN(bugprone-sizeof-expression): slots are pointers, and their size is what is meant
#define KARST_NEED(slot) \
  if (!KARST_HAS(karst_policy_t, &p, slot)) return #slot;
  KARST_NEED(descriptor)
  KARST_NEED(create)
  KARST_NEED(init)
  KARST_NEED(activate)
  KARST_NEED(decide)
  KARST_NEED(on_event)
  KARST_NEED(deactivate)
  KARST_NEED(destroy)
#undef KARST_NEED
  // NOLINTEND(bugprone-sizeof-expression)
  return "";
}

std::string parameter_fault(const karst_parameter_t& p) {
  for (const karst_text_t* t : {&p.id, &p.unit, &p.help, &p.choices, &p.default_text})
    if (const std::string fault = fault_of(*t, kLogLineLimit); !fault.empty()) return "a text " + fault;
  if (!is_identifier(string_of(p.id))) return "the id must be [a-z][a-z0-9_]*";
  switch (p.type) {
    case KARST_PARAMETER_REAL:
    case KARST_PARAMETER_INTEGER:
      if (!(p.low <= p.high)) return "the range is empty";
      if (!(p.default_number >= p.low && p.default_number <= p.high)) return "the default is out of range";
      if (p.type == KARST_PARAMETER_INTEGER &&
          (p.default_number != std::floor(p.default_number) || std::abs(p.default_number) > 0x1p53))
        return "the default is not a whole number";
      return "";
    case KARST_PARAMETER_BOOLEAN:
    case KARST_PARAMETER_TEXT:
      return "";
    default:
      return "unknown type " + std::to_string(p.type);
  }
}

/// Whether the file itself defines `symbol`: dlsym may find the entry of a library that the plugin links.
bool belongs_to(const void* symbol, const std::string& path) {
  Dl_info info{};
  std::error_code error;
  return dladdr(symbol, &info) != 0 && info.dli_fname != nullptr &&
         std::filesystem::equivalent(info.dli_fname, path, error) && !error;
}

}  // namespace

const karst_plugin_t& enter_plugin(const std::string& path) {
  if (is_script(path)) return enter_script(path);
  const std::string file =
      std::filesystem::absolute(path).string();  // a bare name must not search LD_LIBRARY_PATH
  core::check_input(path, core::kMaxPluginBytes);
  void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) throw InputError(path, "", std::string("cannot be opened: ") + dlerror());
  void* symbol = dlsym(handle, KARST_PLUGIN_ENTRY_NAME);
  if (symbol == nullptr || !belongs_to(symbol, file))
    throw InputError(path, "", "exports no " KARST_PLUGIN_ENTRY_NAME ": it is not a karst policy plugin");
  const karst_plugin_t* plugin = nullptr;
  try {
    const karst_plugin_t* (*entry)() = reinterpret_cast<karst_plugin_entry_fn>(symbol);
    plugin = entry();
  } catch (...) {
    throw InputError(path, "", KARST_PLUGIN_ENTRY_NAME " threw an exception");
  }
  if (plugin == nullptr) throw InputError(path, "", KARST_PLUGIN_ENTRY_NAME " returned nothing");
  if (plugin->size < offsetof(karst_plugin_t, abi_minor) + sizeof plugin->abi_minor)
    throw InputError(path, "", "its plugin table is too small to name an ABI version");
  return *plugin;
}

std::string handshake_fault(std::uint32_t abi_major, std::uint32_t abi_minor) {
  const std::string both = "built for policy ABI " + abi_text(abi_major, abi_minor) + ", this karst offers " +
                           abi_text(KARST_ABI_MAJOR, KARST_ABI_MINOR) + ": ";
  if (abi_major != KARST_ABI_MAJOR)
    return both + "rebuild the plugin with this karst's SDK, or use a karst of ABI " +
           std::to_string(abi_major);
  if (abi_minor > KARST_ABI_MINOR)
    return both + "install a newer karst, or rebuild the plugin with this karst's SDK";
  return "";
}

std::string plugin_fault(const karst_plugin_t& plugin) {
  if (!KARST_HAS(karst_plugin_t, &plugin, policy)) return "its plugin table has no \"policy\"";
  if (plugin.policy_count == 0 || plugin.policy_count > kMaxPolicies)
    return "offers " + std::to_string(plugin.policy_count) + " policies, 1 to 64 were expected";
  return "";
}

std::string table_fault(const karst_policy_t* p) {
  if (p == nullptr) return "has no table (could it not be constructed?)";
  if (const std::string slot = missing_slot(*p); !slot.empty())
    return "its table has no \"" + slot + "\", which ABI 1.0 demands";
  return "";
}

std::string descriptor_fault(const karst_policy_descriptor_t& d) {
  if (d.size < sizeof(karst_policy_descriptor_t)) return "its descriptor is smaller than in ABI 1.0";
  for (const karst_text_t* t : {&d.id, &d.name, &d.version, &d.one_line})
    if (const std::string fault = fault_of(*t, kLineLimit); !fault.empty())
      return "a text in its descriptor " + fault;
  if (!is_identifier(string_of(d.id))) return "its id must be [a-z][a-z0-9_]*";
  const std::string id = string_of(d.id);
  if (std::lexicographical_compare(kHostRelease.begin(), kHostRelease.end(), d.min_host, d.min_host + 3))
    return id + " needs karst " + release_text(d.min_host) + " or later, this is " +
           release_text(kHostRelease.data()) + ": install a newer karst, or an older release of the policy";
  return "";
}

std::string parameters_fault(const karst_policy_descriptor_t& d) {
  const std::string id = string_of(d.id);
  if (d.parameter_count > kMaxParameters) return id + " declares too many parameters";
  if (d.parameter_count > 0 && d.parameters == nullptr) return id + " declares parameters but gives none";
  std::set<std::string> seen;
  for (std::uint32_t i = 0; i < d.parameter_count; ++i) {
    std::string fault = parameter_fault(d.parameters[i]);
    if (fault.empty() && !seen.insert(string_of(d.parameters[i].id)).second) fault = "the id is given twice";
    if (fault.empty()) continue;
    const std::string name = string_of(d.parameters[i].id);
    return id + ": parameter " + std::to_string(i) + (is_identifier(name) ? " (" + name + "): " : ": ") +
           fault;
  }
  return "";
}

namespace {

/// Runs the plugin's constructors, its entry and its tables' getters.
PluginFile opened(const std::string& path) {
  const karst_plugin_t& plugin = enter_plugin(path);
  const auto require = [&](const std::string& place, const std::string& fault) {
    if (!fault.empty()) throw InputError(path, place, fault);
  };
  require("", handshake_fault(plugin.abi_major, plugin.abi_minor));
  require("", plugin_fault(plugin));
  PluginFile out{path, &plugin, {}, ""};
  for (std::uint32_t i = 0; i < plugin.policy_count; ++i) {
    const karst_policy_t* policy = plugin.policy(i);
    const std::string place = "policy " + std::to_string(i);
    require(place, table_fault(policy));
    require(place, descriptor_fault(*policy->descriptor));
    require(place, parameters_fault(*policy->descriptor));
    out.policies.push_back(policy);
  }
  return out;
}

}  // namespace

PluginFile open_plugin(const std::string& path) {
  const ProcessState before;
  try {
    PluginFile out = opened(path);
    out.process_change = before.restore();
    return out;
  } catch (...) {
    before.restore();
    throw;
  }
}

}  // namespace karst::host
