// From a policy's name to the file that offers it.
#pragma once
#include <optional>
#include <string>

#include "sdk/host/plugin/discovery.h"
#include "sdk/host/plugin/plugin_file.h"

namespace karst::host {

struct Selection {
  PluginFile plugin;
  const karst_policy_t* policy = nullptr;
};

/// The first file on the path that offers `name`, not opened in this process. A file named explicitly must be
/// valid. Throws core::InputError with the names available, the nearest name, broken candidates and the
/// folders searched.
PolicyListing find_policy(const std::string& name, const SearchPath& path);

/// The policy in a file, if `text` is the name of one: "my_nearest.py", "build/mine.so". None for a policy's
/// name. Throws core::InputError if there is no such file, if it is broken, or if it holds several policies.
std::optional<PolicyListing> policy_in_file(const std::string& text);

/// The same in place: the policy becomes its name, and its file the first of the plugins.
void take_policy_file(std::string& policy, std::vector<std::string>& plugins);

/// Opens a file that was found to offer `name`.
Selection open_policy(const std::string& file, const std::string& name);

/// Opens the file that find_policy() finds, and no other.
Selection select_policy(const std::string& name, const SearchPath& path);

}  // namespace karst::host
