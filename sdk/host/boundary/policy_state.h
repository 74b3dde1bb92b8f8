// What a policy remembers, as bytes: the host's side of the extension "karst.state/1".
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "sdk/abi/karst_abi_policy.h"
#include "sdk/abi/karst_abi_state.h"

namespace karst::host {

constexpr std::uint64_t kMaxStateBytes = 16u << 20;

/// The policy's table for it, or null: then it begins anew whenever it is started. A table with a slot
/// missing counts as none.
const karst_state_extension_t* state_extension(const karst_policy_t& policy, void* self);

/// Writes what the active policy remembers into `bytes`. "" or why there is nothing to
/// keep; `bytes` is then unspecified. On the decision thread. May throw what the plugin throws.
std::string save_state(const karst_state_extension_t& state, void* self, std::vector<std::byte>& bytes);

/// Gives an initialized policy its memory back. "" or why not: destroy it, and start one without.
std::string restore_state(const karst_state_extension_t& state, void* self, std::span<const std::byte> bytes);

}  // namespace karst::host
