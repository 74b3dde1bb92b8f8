#include "core_stack/team/team_objects.h"

#include <algorithm>
#include <cmath>

namespace karst::core {
namespace {

constexpr double kSize_m = 1.0, kFarthest_m = 3.0, kDeviations = 3.0;
constexpr double kMinDeviation_m = 0.05;  // reported in steps of 0.1 m

bool from(const TeamObject& o, RobotId finder) {
  return std::any_of(o.reported_by.begin(), o.reported_by.end(),
                     [&](const auto& key) { return key.first == finder; });
}

}  // namespace

void note(ReportedObjects& objects, RobotId finder, const ObjectSeen& seen) {
  const auto [known, fresh] = objects.try_emplace({finder, seen.object}, seen);
  if (!fresh && seen.stamp >= known->second.stamp) known->second = seen;
}

std::vector<TeamObject> merged(const ReportedObjects& reports) {
  std::vector<TeamObject> all;
  for (const auto& [key, seen] : reports) {
    if (seen.kind == 0) continue;
    const double deviation_m = std::max(seen.deviation_m, kMinDeviation_m);
    TeamObject* nearest = nullptr;
    double min_m = kFarthest_m;
    for (TeamObject& o : all) {
      if (o.kind != seen.kind || from(o, key.first)) continue;
      const double separation_m = (o.position - seen.position).norm();
      if (separation_m > kSize_m + kDeviations * std::hypot(o.deviation_m, deviation_m) ||
          separation_m > min_m)
        continue;
      min_m = separation_m;
      nearest = &o;
    }
    if (!nearest) {
      all.push_back({seen.kind, seen.position, deviation_m, {key}});
      continue;
    }
    const double a = 1 / (nearest->deviation_m * nearest->deviation_m), b = 1 / (deviation_m * deviation_m);
    nearest->position = (a * nearest->position + b * seen.position) / (a + b);
    nearest->deviation_m = 1 / std::sqrt(a + b);
    nearest->reported_by.push_back(key);
  }
  return all;
}

}  // namespace karst::core
