#include "sdk/host/boundary/policy_state.h"

#include "sdk/host/boundary/call_plugin.h"
#include "sdk/host/boundary/text.h"

namespace karst::host {
namespace {

struct Collected {
  std::vector<std::byte>& bytes;
  std::string fault;  // counts even if the policy reports success
};

std::int32_t write(const karst_state_sink_t* sink, const void* bytes, std::uint64_t count,
                   karst_error_t* error) noexcept {
  auto& to = *static_cast<Collected*>(sink->context);
  const auto refuse = [&](std::int32_t code, std::string why) {
    to.fault = std::move(why);
    fill_error(error, code, to.fault);
    return code;
  };
  try {
    if (count > 0 && bytes == nullptr) return refuse(KARST_ERROR_ARGUMENT, "write was given no bytes");
    if (count > kMaxStateBytes || to.bytes.size() + count > kMaxStateBytes)
      return refuse(KARST_ERROR_LIMIT,
                    "its state is larger than " + std::to_string(kMaxStateBytes >> 20) + " MiB");
    const auto* from = static_cast<const std::byte*>(bytes);
    to.bytes.insert(to.bytes.end(), from, from + count);
    return KARST_OK;
  } catch (const std::exception&) {
    return refuse(KARST_ERROR_FAILED, "the host ran out of memory");
  }
}

}  // namespace

const karst_state_extension_t* state_extension(const karst_policy_t& policy, void* self) {
  if (!KARST_HAS(karst_policy_t, &policy, extension)) return nullptr;
  const auto* table = static_cast<const karst_state_extension_t*>(
      call_plugin(policy.extension, self, view_of(KARST_STATE_EXTENSION)));
  if (table == nullptr || !KARST_HAS(karst_state_extension_t, table, save) ||
      !KARST_HAS(karst_state_extension_t, table, restore))
    return nullptr;
  return table;
}

std::string save_state(const karst_state_extension_t& state, void* self, std::vector<std::byte>& bytes) {
  bytes.clear();
  Collected to{bytes, ""};
  const karst_state_sink_t sink{sizeof sink, 0, kMaxStateBytes, &to, &write};
  karst_error_t error{};
  const bool saved = call_plugin(state.save, self, &sink, &error) == KARST_OK;
  return !to.fault.empty() ? to.fault : saved ? "" : text_of(error);
}

std::string restore_state(const karst_state_extension_t& state, void* self,
                          std::span<const std::byte> bytes) {
  karst_error_t error{};
  const bool restored = call_plugin(state.restore, self, bytes.data(), bytes.size(), &error) == KARST_OK;
  return restored ? "" : text_of(error);
}

}  // namespace karst::host
