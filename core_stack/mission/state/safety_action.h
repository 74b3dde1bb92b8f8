// What is done for safety.
#pragma once
#include "core_stack/common/enum_names.h"

namespace karst::core {

/// In order of severity.
enum class SafetyAction {
  none,
  replan,    // a detour in flight
  fallback,  // for a policy that failed
  slow,
  brake,
  home,
  land
};
constexpr auto names_of(SafetyAction) {
  using enum SafetyAction;
  return std::to_array<Named<SafetyAction>>({{none, "none"},
                                             {replan, "replan"},
                                             {fallback, "fallback"},
                                             {slow, "slow"},
                                             {brake, "brake"},
                                             {home, "home"},
                                             {land, "land"}});
}

}  // namespace karst::core
