// The state of a policy as bytes: the host's side of the extension "karst.state/1".
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "sdk/abi/karst_abi_policy.h"
#include "sdk/abi/karst_abi_state.h"

namespace karst::host {

constexpr std::uint64_t kMaxStateBytes = 16u << 20;

/// The policy's table for the extension, or null: then every restart begins without a state. A table with a
/// missing slot counts as none.
const karst_state_extension_t* state_extension(const karst_policy_t& policy, void* self);

/// Writes the state of the active policy into `bytes`. Returns "", or the reason why there is none; `bytes`
/// is then unspecified. On the decision thread. Passes on exceptions of the plugin.
std::string save_state(const karst_state_extension_t& state, void* self, std::vector<std::byte>& bytes);

/// Restores the state of an initialized policy. "" or why it failed: destroy it, and start one without.
std::string restore_state(const karst_state_extension_t& state, void* self, std::span<const std::byte> bytes);

}  // namespace karst::host
