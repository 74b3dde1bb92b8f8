#include "sdk/preflight/vehicle/vehicle_words.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core_stack/common/counted.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/json_point.h"

namespace karst::preflight {
namespace {

using nlohmann::ordered_json;

std::size_t count_of(const std::vector<Check>& checks, Outcome outcome) {
  return static_cast<std::size_t>(
      std::count_if(checks.begin(), checks.end(), [&](const Check& c) { return c.outcome == outcome; }));
}

std::string with_outcome(const std::vector<Check>& checks, Outcome outcome, const char* title) {
  std::string out;
  for (const Check& c : checks) {
    if (c.outcome != outcome) continue;
    out += std::string("  ") + core::name_of(c.part) + ", " + c.what + ": " + c.measured +
           " (required: " + c.required + ")" + (c.remedy.empty() ? "" : ". To do: " + c.remedy) + "\n";
  }
  return out.empty() ? "" : title + out;
}

ordered_json known(double v) { return std::isfinite(v) ? ordered_json(v) : ordered_json(); }

ordered_json json_of(const SensorTimeline& s) {
  const Timeline& t = s.timeline;
  return {{"sensor", core::name_of(s.sensor)},
          {"name", s.name},
          {"messages", t.messages},
          {"required_hz", s.required_hz},
          {"rate_hz", known(t.rate_hz)},
          {"longest_gap_s", t.longest_gap_s},
          {"jitter_s", known(t.jitter_s)},
          {"backward", t.backward},
          {"future_s", t.future_s},
          {"jump_s", t.jump_s},
          {"latency_s", known(t.latency_s)}};
}

ordered_json json_of(const MotionFigures& motion) {
  ordered_json j{{"scans", motion.scans}, {"matched", motion.matched}, {"clipped", motion.clipped}};
  if (!motion.hand_eye) return j;
  const HandEye& h = *motion.hand_eye;
  j["delay_s"] = h.delay_s;
  j["delay_sigma_s"] = h.delay_sigma_s;
  j["mounting_error_rad"] = core::list(h.error_rad);
  j["mounting_sigma_rad"] = h.sigma_rad;
  j["gyroscope_scale"] = known(1 / h.scale);
  j["explained"] = h.explained;
  j["pairs"] = h.pairs;
  return j;
}

}  // namespace

std::string passed_text(const std::vector<Check>& checks, Part part) {
  std::string out;
  for (const Check& c : checks)
    if (c.part == part && c.outcome == Outcome::pass)
      out += (out.empty() ? "" : "; ") + c.what + " " + c.measured;
  return out;
}

std::string verdict_text(const std::vector<Check>& checks) {
  if (const std::size_t n = count_of(checks, Outcome::no_go); n > 0)
    return "NO-GO, for " + core::counted(n, "reason");
  if (const std::size_t n = count_of(checks, Outcome::watch); n > 0)
    return "GO, with " + core::counted(n, "thing") + " to watch for";
  return "GO";
}

std::string source_text(const VehicleMeasurements& m) {
  return "plugin " + m.plugin + ", " +
         (m.mission_file.empty() ? "without a mission file: the defaults" : "mission " + m.mission_file);
}

std::string checks_text(const VehicleMeasurements& m, const std::vector<Check>& checks) {
  std::string out = verdict_text(checks) + ": vehicle " + m.vehicle.name + " (" + source_text(m) + ")" +
                    core::format_text(", listened to for %.0f s at rest", m.rest_s) +
                    (m.motion ? core::format_text(" and %.0f s in motion", m.motion_s) : "") + "\n";
  out += with_outcome(checks, Outcome::no_go, "Reasons:\n");
  out += with_outcome(checks, Outcome::watch, "Watch for:\n");
  out += "Passed:\n";
  for (const auto& part : names_of(Part{}))
    if (const std::string line = passed_text(checks, part.value); !line.empty())
      out += std::string("  ") + part.name + ": " + line + "\n";
  out += "For a person to check:\n";
  for (const std::string& box : boxes_for_persons(m)) out += "  [ ] " + box + "\n";
  return out;
}

ordered_json to_json(const VehicleMeasurements& m, const std::vector<Check>& checks) {
  ordered_json j{{"schema", "karst.vehicle_preflight/1"},
                 {"vehicle", m.vehicle.name},
                 {"plugin", m.plugin},
                 {"mission_file", m.mission_file.empty() ? ordered_json() : ordered_json(m.mission_file)},
                 {"verdict", verdict_of(checks) == Outcome::no_go ? "no_go" : "go"},
                 {"rest_s", m.rest_s},
                 {"motion_s", m.motion_s}};
  j["checks"] = ordered_json::array();
  for (const Check& c : checks)
    j["checks"].push_back({{"outcome", core::name_of(c.outcome)},
                           {"part", core::name_of(c.part)},
                           {"what", c.what},
                           {"measured", c.measured},
                           {"required", c.required},
                           {"remedy", c.remedy}});
  j["sensors"] = ordered_json::array();
  for (const SensorTimeline& s : m.sensors) j["sensors"].push_back(json_of(s));
  j["motion"] = m.motion ? json_of(*m.motion) : ordered_json();
  j["for_persons"] = boxes_for_persons(m);
  return j;
}

}  // namespace karst::preflight
