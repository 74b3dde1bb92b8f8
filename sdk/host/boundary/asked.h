// What a policy was asked or told, named in the messages about its failures: what to look for in a record
// of requests (docs/testing_policies.md). The same in every replay.
#pragma once
#include <string>

#include "core_stack/common/format_text.h"
#include "core_stack/common/time.h"
#include "core_stack/mission/policy/policy_port.h"

namespace karst::host {

inline std::string at_time(core::TimeNs stamp) {
  return core::format_text(" at %.1f s", core::seconds(stamp));
}

/// "request 7 at 12.3 s".
inline std::string asked(const core::DecisionRequest& request) {
  return "request " + std::to_string(request.sequence) + at_time(request.stamp);
}

/// "event reached at 12.3 s".
inline std::string told(const core::PolicyEvent& event) {
  return std::string("event ") + core::name_of(event.kind) + at_time(event.stamp);
}

}  // namespace karst::host
