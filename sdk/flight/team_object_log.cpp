#include "sdk/flight/team_object_log.h"

#include <nlohmann/json.hpp>

#include "core_stack/common/json_point.h"
#include "core_stack/vehicle/object_detection.h"

namespace karst::flight {

void TeamObjectLog::robot(core::TimeNs now, const core::TeamNode& robot, TeamLog& log) {
  news(now, "object", robot.objects(), robot.self(), reported_, log);
}

void TeamObjectLog::base(core::TimeNs now, const core::TeamNode& base, TeamLog& log) {
  news(now, "object_known", base.objects(), core::kBase, known_, log);
}

/// Logs the changes in the objects of one robot, or, for the base, of all robots.
void TeamObjectLog::news(core::TimeNs now, const char* kind, const core::ReportedObjects& objects,
                         core::RobotId of, core::ReportedObjects& noted, TeamLog& log) {
  for (const auto& [key, seen] : objects) {
    if (of != core::kBase && key.first != of) continue;
    const auto before = noted.find(key);
    if (before != noted.end() && before->second.stamp == seen.stamp && before->second.kind == seen.kind)
      continue;
    const core::ObjectState state = seen.kind == 0          ? core::ObjectState::withdrawn
                                    : before == noted.end() ? core::ObjectState::found
                                                            : core::ObjectState::revised;
    nlohmann::json fields{{"robot", key.first}, {"number", key.second}, {"state", core::name_of(state)}};
    if (seen.kind != 0) {
      fields["what"] = core::name_of(static_cast<core::ObjectKind>(seen.kind));
      fields["position"] = core::rounded_list(seen.position);
      fields["deviation"] = core::to_thousandths(seen.deviation_m);
    }
    log.event(now, kind, fields);
    noted[key] = seen;
  }
}

}  // namespace karst::flight
