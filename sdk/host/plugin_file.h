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

/// "" if this host can use a plugin of that ABI, otherwise both versions and what to do.
std::string handshake_fault(std::uint32_t abi_major, std::uint32_t abi_minor);

}  // namespace karst::host
