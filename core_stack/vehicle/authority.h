// Who steers the vehicle.
#pragma once
#include "core_stack/common/enum_names.h"

namespace karst::core {

enum class Authority { core, pilot, autopilot };
constexpr auto names_of(Authority) {
  using enum Authority;
  return std::to_array<Named<Authority>>({{core, "core"}, {pilot, "pilot"}, {autopilot, "autopilot"}});
}

}  // namespace karst::core
