#include "sdk/host/load_policy.h"

#include "sdk/host/in_process/loaded_policy.h"
#include "sdk/host/isolation/isolated_policy.h"
#include "sdk/host/plugin/selection.h"

namespace karst::host {

std::unique_ptr<HostedPolicy> load_policy(const PolicyChoice& choice, const SearchPath& path) {
  if (choice.isolation == Isolation::process)
    return std::make_unique<IsolatedPolicy>(find_policy(choice.name, path).file, choice);
  const Selection found = select_policy(choice.name, path);
  return std::make_unique<LoadedPolicy>(found.plugin, *found.policy, choice);
}

std::unique_ptr<HostedPolicy> load_policy(const PolicyChoice& choice) {
  return load_policy(choice, default_search_path(choice.plugin_files));
}

}  // namespace karst::host
