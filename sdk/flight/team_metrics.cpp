#include "sdk/flight/team_metrics.h"

#include <algorithm>
#include <filesystem>

#include "core_stack/common/rounded.h"
#include "sdk/evaluation/metrics/metric_definitions.h"

namespace karst::flight {
namespace {

using core::to_millionths;
using nlohmann::json;
using nlohmann::ordered_json;

ordered_json text_or_null(const std::string& text) {
  return text.empty() ? ordered_json() : ordered_json(text);
}

/// Null if the value of any robot is not known.
ordered_json sum(const std::vector<json>& robots, const std::string& key) {
  double all = 0;
  for (const json& r : robots) {
    if (!r.contains(key) || !r[key].is_number()) return nullptr;
    all += r[key].get<double>();
  }
  return to_millionths(all);
}

}  // namespace

void add_sums(ordered_json& metrics, const std::vector<json>& robots) {
  for (const char* key : {"contacts", "path_length_m", "energy_wh", "flight_time_s"})
    if (metrics[key].is_null()) metrics[key] = sum(robots, key);
}

ordered_json begin_team_metrics(const TeamFlightFacts& flight, const std::vector<json>& robots) {
  ordered_json m;
  m["schema"] = "karst.metrics/1";
  m["policy"] = text_or_null(flight.policy);
  m["cave"] = text_or_null(std::filesystem::path(flight.cave).stem().string());
  m["seed"] = flight.seed;
  m["outcome"] = core::name_of(flight.outcome);
  m["reason"] = flight.reason;
  for (const evaluation::MetricDefinition& d : evaluation::metric_definitions())
    m[std::string(d.name)] = nullptr;
  // What the mission's survey lacks is counted by each robot alone, and a team has no earlier map.
  for (const char* of_one : {"unsurveyed_volume_m3", "time_to_unsurveyed_50_s", "earlier_map_found",
                             "earlier_volume_m3", "added_volume_m3"})
    m.erase(of_one);
  add_sums(m, robots);
  return m;
}

ordered_json team_metrics(const Mission& mission, const TeamResult& result, const std::vector<json>& robots) {
  const auto count = [&](auto&& holds) {
    return std::count_if(result.robots.begin(), result.robots.end(), holds);
  };
  const auto n = static_cast<long>(result.robots.size());
  const long landed =
      count([](const RobotResult& r) { return r.mission.outcome == core::MissionOutcome::landed; });
  const long connected = count(
      [](const RobotResult& r) { return r.mission.outcome == core::MissionOutcome::landed && r.connected; });
  double explored_s = 0;
  for (const RobotResult& r : result.robots) explored_s += r.exploration_time_s;

  const std::string reason = std::to_string(landed) + " of " + std::to_string(n) + " robots landed, " +
                             std::to_string(connected) + " of them connected to the base";
  ordered_json m = begin_team_metrics(
      {mission.policy, mission.cave, mission.seed,
       landed == n ? core::MissionOutcome::landed : core::MissionOutcome::incomplete, reason},
      robots);
  m["exploration_time_s"] = to_millionths(explored_s / static_cast<double>(n));
  std::uint64_t reported = 0, at_base = 0;
  for (const RobotResult& r : result.robots) {
    reported += r.records;
    at_base += r.records_at_base;
  }
  if (reported > 0)
    m["data_at_base_share"] = to_millionths(static_cast<double>(at_base) / static_cast<double>(reported));
  m["robots_landed"] = to_millionths(static_cast<double>(landed) / static_cast<double>(n));
  m["robots_connected"] =
      landed > 0 ? ordered_json(to_millionths(static_cast<double>(connected) / static_cast<double>(landed)))
                 : ordered_json(nullptr);
  for (std::size_t i = 0; i < result.robots.size(); ++i)
    if (const std::string key = "exploration_time_" + std::to_string(i + 1) + "_s"; m.contains(key))
      m[key] = to_millionths(result.robots[i].exploration_time_s);  // as many robots as campaigns compare

  m["strategy"] = core::name_of(mission.core.team.strategy);
  m["duration_s"] = to_millionths(result.duration_s);
  m["bytes_on_air"] = result.bytes_on_air;
  m["robots"] = ordered_json::array();
  for (const RobotResult& r : result.robots)
    m["robots"].push_back({{"outcome", core::name_of(r.mission.outcome)},
                           {"reason", r.mission.reason},
                           {"start_s", to_millionths(r.start_s)},
                           {"end_s", to_millionths(r.end_s)},
                           {"exploration_time_s", to_millionths(r.exploration_time_s)},
                           {"homing_reason", r.homing_reason},
                           {"battery_left", to_millionths(r.battery_left)},
                           {"connected", r.connected},
                           {"records", r.records},
                           {"records_at_base", r.records_at_base}});
  return m;
}

}  // namespace karst::flight
