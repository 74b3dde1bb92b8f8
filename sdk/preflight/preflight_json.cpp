#include "sdk/preflight/preflight_json.h"

#include <cmath>
#include <optional>
#include <string>

#include "core_stack/common/json_point.h"
#include "core_stack/common/json_text.h"

namespace karst::preflight {
namespace {

using nlohmann::ordered_json;

ordered_json known(double v) { return std::isfinite(v) ? ordered_json(v) : ordered_json(); }

ordered_json json_of(const TimeBudget& t) {
  const TimeLimits& l = t.limits;
  return {{"battery_s", l.battery_s ? ordered_json(*l.battery_s) : ordered_json()},
          {"max_flight_time_s", l.max_flight_time_s},
          {"endurance_s", t.endurance_s},
          {"home_margin", l.home_margin},
          {"home_reserve_s", l.home_reserve_s},
          {"farthest_m", t.farthest_m},
          {"reach_m", t.reach_m},
          {"home_s", t.home_s},
          {"turn_back_s", t.can_explore ? ordered_json(t.turn_back_s) : ordered_json()},
          {"return_s", t.can_explore ? ordered_json(t.return_s) : ordered_json()}};
}

ordered_json json_of(const VehicleFacts& v) {
  return {{"name", v.name},
          {"radius_m", v.radius_m},
          {"clearance_m", v.clearance_m},
          {"looks_up_rad", v.looks_up_rad},
          {"looks_down_rad", v.looks_down_rad}};
}

ordered_json json_of(const CaveFacts& c) {
  ordered_json j{{"figures", core::json_of<ordered_json>(selection::to_json(c.figures))},
                 {"width_m_p10_p50_p90", c.passages.width_m},
                 {"height_m_p10_p50_p90", c.passages.height_m},
                 {"start", core::list(c.start)},
                 {"start_clearance_m", c.start_clearance_m},
                 {"coverage_volume_m3", c.explorable_m3},
                 {"reachable_volume_m3", c.reachable_m3},
                 {"hull_reachable_volume_m3", c.hull_reachable_m3},
                 {"blind_climb_fraction", c.blind_climb_fraction}};
  j["holes"] = ordered_json::array();
  for (const Hole& h : c.holes)
    j["holes"].push_back(
        {{"centre", core::list(h.centre)}, {"diameter_m", h.diameter_m}, {"distance_m", h.distance_m}});
  return j;
}

ordered_json json_of(const PolicyFacts& p) {
  ordered_json j{
      {"name", p.policy}, {"selected", p.selected}, {"fallback", p.fallback}, {"reason", p.reason}};
  j["parameters"] = ordered_json::object();
  for (const auto& [key, value] : p.parameters) j["parameters"][key] = value;
  j["confidence"] = known(p.confidence);
  j["metric"] = p.metric;
  j["level"] = p.level;
  j["horizon_s"] = known(p.horizon_s);
  j["ranking"] = ordered_json::array();
  for (const RankedPolicy& r : p.ranking)
    j["ranking"].push_back({{"contestant", r.name},
                            {"expected", known(r.expected)},
                            {"low", known(r.low)},
                            {"high", known(r.high)}});
  j["rank"] = p.own ? ordered_json(*p.own + 1) : ordered_json();
  j["expected"] = ordered_json::object();
  for (const ExpectedFigure& f : p.expected) j["expected"][f.metric] = known(f.value);
  return j;
}

template <class Part>
ordered_json json_of(const std::optional<Part>& part) {
  return part ? json_of(*part) : ordered_json();
}

}  // namespace

ordered_json to_json(const Preflight& p, const std::vector<Finding>& findings) {
  ordered_json j{{"schema", "karst.preflight/1"},
                 {"cave_file", p.cave_file},
                 {"verdict", is_go(findings) ? "go" : "no_go"}};
  j["findings"] = ordered_json::array();
  for (const Finding& f : findings)
    j["findings"].push_back(
        {{"severity", core::name_of(f.severity)}, {"subject", core::name_of(f.subject)}, {"text", f.text}});
  j["time"] = json_of(p.time);
  j["policy"] = json_of(p.policy);
  j["cave"] = json_of(p.cave);
  j["vehicle"] = json_of(p.vehicle);
  return j;
}

}  // namespace karst::preflight
