#include "core_stack/mission/object_log.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core_stack/mission/json_point.h"
#include "core_stack/vehicle/object_detection.h"

namespace karst::core {
namespace {

const char* name(std::uint8_t kind) { return name_of(static_cast<ObjectKind>(kind)); }

}  // namespace

void ObjectLog::robot(TimeNs now, const Teammate& robot, TeamLog& log) {
  news(now, "object", robot.objects(), robot.self(), told_, log);
}

void ObjectLog::base(TimeNs now, const Teammate& base, TeamLog& log) {
  news(now, "object_known", base.objects(), kBase, known_, log);
}

/// Of one robot, or, for the base, of all.
void ObjectLog::news(TimeNs now, const char* kind, const ToldObjects& objects, RobotId of, ToldObjects& noted,
                     TeamLog& log) {
  for (const auto& [key, seen] : objects) {
    if (of != kBase && key.first != of) continue;
    const auto before = noted.find(key);
    if (before != noted.end() && before->second.stamp == seen.stamp && before->second.kind == seen.kind)
      continue;
    const char* state = seen.kind == 0 ? "withdrawn" : before == noted.end() ? "found" : "revised";
    nlohmann::json fields{{"robot", key.first}, {"number", key.second}, {"state", state}};
    if (seen.kind != 0) {
      fields["what"] = name(seen.kind);
      fields["position"] = rounded_list(seen.position);
      fields["deviation"] = rounded(seen.deviation_m);
    }
    log.event(now, kind, fields);
    noted[key] = seen;
  }
}

nlohmann::json list_of(const std::vector<TeamObject>& objects) {
  nlohmann::json all = nlohmann::json::array();
  for (const TeamObject& o : objects)
    all.push_back({{"what", name(o.kind)},
                   {"position", rounded_list(o.position)},
                   {"deviation", rounded(o.deviation_m)},
                   {"told_by", o.told_by}});
  return all;
}

}  // namespace karst::core
