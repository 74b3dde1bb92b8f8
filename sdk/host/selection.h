// From a policy's name to the file that offers it.
#pragma once
#include <string>

#include "sdk/host/discovery.h"
#include "sdk/host/plugin_file.h"

namespace karst::host {

struct Selection {
  PluginFile plugin;
  const karst_policy_t* policy = nullptr;
};

/// Opens the first file on the path that offers `name`, and no other. A file named explicitly must be sound.
/// Throws core::InputError with what there is, the nearest name, broken candidates and the folders searched.
Selection select_policy(const std::string& name, const SearchPath& path);

}  // namespace karst::host
