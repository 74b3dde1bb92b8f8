// From a policy's name to the policy, ready to decide.
#pragma once
#include <memory>

#include "sdk/host/plugin/discovery.h"
#include "sdk/host/plugin/hosted_policy.h"

namespace karst::host {

/// Finds, loads, initializes and activates a policy. Throws core::InputError for an unknown name (with the
/// names available, the nearest one and the folders searched), a plugin of another ABI (with both versions
/// and a remedy), or a parameter that is unknown, of another unit, or out of range; CannotConfine where a
/// policy cannot have a process of its own.
std::unique_ptr<HostedPolicy> load_policy(const PolicyChoice& choice);
std::unique_ptr<HostedPolicy> load_policy(const PolicyChoice& choice, const SearchPath& path);

}  // namespace karst::host
