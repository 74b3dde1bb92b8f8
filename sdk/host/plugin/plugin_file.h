// Opening a plugin: dlopen, the handshake, and a look at every table before anything in it is called.
#pragma once
#include <string>
#include <vector>

#include "sdk/abi/karst_abi.h"

namespace karst::host {

/// Stays open for the life of the process: code that may still run is never unmapped.
struct PluginFile {
  std::string path;
  const karst_plugin_t* plugin = nullptr;
  std::vector<const karst_policy_t*> policies;  // every table and descriptor sound
  std::string process_change;  // what opening it changed in the process, and was put back; "" for nothing
};

/// Throws core::InputError with the file and the reason: not a shared object, no entry, another ABI (with
/// both versions and what to do), a missing slot, a descriptor that contradicts itself.
PluginFile open_plugin(const std::string& path);

// The same, a step at a time: each returns "" or the reason, and presupposes the steps before it.

/// dlopen and the entry; throws core::InputError.
const karst_plugin_t& enter_plugin(const std::string& path);
/// "" if this host can use a plugin of that ABI, otherwise both versions and what to do.
std::string handshake_fault(std::uint32_t abi_major, std::uint32_t abi_minor);
/// The plugin's own table.
std::string plugin_fault(const karst_plugin_t& plugin);
/// A policy's table: every mandatory slot is there.
std::string table_fault(const karst_policy_t* policy);
/// Its texts and the karst it needs.
std::string descriptor_fault(const karst_policy_descriptor_t& descriptor);
std::string parameters_fault(const karst_policy_descriptor_t& descriptor);

}  // namespace karst::host
