// From a policy's name to the policy, ready to decide.
#pragma once
#include <memory>

#include "sdk/host/plugin/discovery.h"
#include "sdk/host/plugin/hosted_policy.h"

namespace karst::host {

/// Finds, loads, initializes and activates. Throws core::InputError: a name nobody offers (with what there
/// is, the nearest name and the folders searched), a plugin of another ABI (with both versions and what to
/// do), a parameter that is unknown, of another unit, or out of range.
std::unique_ptr<HostedPolicy> load_policy(const PolicyChoice& choice);
std::unique_ptr<HostedPolicy> load_policy(const PolicyChoice& choice, const SearchPath& path);

}  // namespace karst::host
