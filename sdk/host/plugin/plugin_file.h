// Opening a plugin: dlopen, the handshake, and a check of every table before any slot is called.
#pragma once
#include <string>
#include <vector>

#include "sdk/abi/karst_abi.h"

namespace karst::host {

/// Stays open until the process ends: code that may still run is never unmapped.
struct PluginFile {
  std::string path;
  const karst_plugin_t* plugin = nullptr;
  std::vector<const karst_policy_t*> policies;  // with valid tables and descriptors
  std::string process_change;  // process state that opening it changed, restored since; "" for nothing
};

/// Throws core::InputError with the file and the reason: not a shared object, no entry, another ABI (with
/// both versions and what to do), a missing slot, a descriptor that contradicts itself.
PluginFile open_plugin(const std::string& path);

// The same step by step: each returns "" or the reason, and requires that the steps before it succeeded.

/// dlopen and the entry; throws core::InputError.
const karst_plugin_t& enter_plugin(const std::string& path);
/// "" if this host can use a plugin of that ABI, otherwise both versions and a remedy.
std::string handshake_fault(std::uint32_t abi_major, std::uint32_t abi_minor);
/// Checks the plugin's own table.
std::string plugin_fault(const karst_plugin_t& plugin);
/// Checks that a policy's table has every mandatory slot.
std::string table_fault(const karst_policy_t* policy);
/// Checks its texts and the karst release that it needs.
std::string descriptor_fault(const karst_policy_descriptor_t& descriptor);
std::string parameters_fault(const karst_policy_descriptor_t& descriptor);

}  // namespace karst::host
