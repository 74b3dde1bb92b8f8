#include "sdk/preflight/preflight_words.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core_stack/common/counted.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/unit_text.h"
#include "core_stack/homing/path_home/home.h"
#include "sdk/selection/figure_words.h"

namespace karst::preflight {
namespace {

using core::format_text;

constexpr double kClearlySooner = 0.95;  // of the time until the vehicle must turn back
constexpr double kByFar = 2;             // times the battery: a flight time that nothing depends on

Section vehicle_section(const VehicleFacts& v) {
  constexpr double kDegree_rad = std::numbers::pi / 180;
  return {
      "Vehicle",
      {{"vehicle", v.name + format_text(", hull %.2f m wide, flies where passages are %.2f m wide and more",
                                        2 * v.radius_m, 2 * v.clearance_m)},
       {"sensors look", format_text("up to %.0f deg up and %.0f deg down", v.looks_up_rad / kDegree_rad,
                                    v.looks_down_rad / kDegree_rad)}}};
}

/// A short cave has no verticality.
std::string shape_text(const selection::CaveFigures& f) {
  return format_text("%.0f m from the lowest to the highest place", f.drop_m) +
         (std::isnan(f.verticality) ? "" : format_text(", verticality %.2f", f.verticality)) +
         format_text("; %.1f junctions and %.1f loops in 100 m", f.branching, f.loops);
}

Section cave_section(const CaveFacts& c) {
  const selection::CaveFigures& f = c.figures;
  const selection::PassageFacts& p = c.passages;
  return {
      "Cave",
      {{"reachable volume", format_text("%.0f m³, by which coverage is measured", c.explorable_m3)},
       {"passages", format_text("%.0f m in all; the widest ball that fits has a diameter of %.1f m (median)",
                                f.length_m, f.width_m)},
       {"wall to wall", format_text("%.1f m wide, %.1f m high (median where the vehicle can fly); one in ten "
                                    "places is narrower than %.1f m or lower than %.1f m",
                                    p.width_m[1], p.height_m[1], p.width_m[0], p.height_m[0])},
       {"shape", shape_text(f)},
       {"start", format_text("%.2f %.2f %.2f, %.1f m from rock", c.start.x(), c.start.y(), c.start.z(),
                             c.start_clearance_m)}}};
}

/// "72 %, 90 % interval 35 % to 100 %"
std::string ranked_text(const PolicyFacts& p, const RankedPolicy& r) {
  const auto text = [&p](double v) { return selection::metric_value_text(p.metric, v); };
  if (std::isnan(r.low) || std::isnan(r.high)) return text(r.expected);
  return text(r.expected) + format_text(", %.0f %% interval ", 100 * p.level) + text(r.low) + " to " +
         text(r.high);
}

/// The figures that tell most beforehand, in this order.
std::string expected_text(const PolicyFacts& p) {
  const double coverage = expected_value(p, "coverage"), volume_m3 = expected_value(p, "explored_volume_m3"),
               flight_s = expected_value(p, "flight_time_s");
  if (std::isnan(coverage)) return "";
  std::string out = selection::share_text(coverage) + " of the reachable volume";
  if (!std::isnan(volume_m3)) out += format_text(", %.0f m³", volume_m3);
  const auto add = [&](const char* metric, const char* unit) {
    if (const double v = expected_value(p, metric); !std::isnan(v)) out += format_text(", %.0f %s", v, unit);
  };
  add("path_length_m", "m of flight");
  add("energy_wh", "Wh");
  if (!std::isnan(flight_s)) out += ", landed after " + duration_text(flight_s);
  return out;
}

std::string why_named(const PolicyFacts& p) {
  if (p.fallback) return ", because no policy could be selected for this cave";
  return p.selected ? ", selected for this cave" : ", as named";
}

Section policy_section(const PolicyFacts& p) {
  Section s{"Policy", {{"policy", p.policy + why_named(p)}}};
  std::string parameters;
  for (const auto& [key, value] : p.parameters)
    parameters += (parameters.empty() ? "" : ", ") + key + " " + core::unit_text(value);
  if (!parameters.empty()) s.rows.push_back({"parameters", parameters, true});
  if (p.ranking.empty()) return s;
  if (p.own)
    if (const std::string text = expected_text(p); !text.empty()) s.rows.push_back({"expected", text});
  s.rows.push_back({"ranked by", selection::metric_words(p.metric) + " (" + p.metric +
                                     format_text("), in flights of at most %.0f s", p.horizon_s)});
  if (p.own) s.rows.push_back({"this policy", ranked_text(p, p.ranking[*p.own])});
  if (const std::size_t other = p.own == 0u ? 1 : 0; other < p.ranking.size())
    s.rows.push_back(
        {other == 1 ? "runner-up" : "best", p.ranking[other].name + ", " + ranked_text(p, p.ranking[other])});
  if (p.selected) s.rows.push_back({"confidence", p.confidence_words});
  s.rows.push_back({p.selected ? "why this policy" : "by experience", p.reason});
  return s;
}

/// When nothing is left to explore, if that is before the vehicle must turn back; otherwise "".
std::string explored_text(const Preflight& p) {
  const TimeBudget& t = *p.time;
  const double landed_s = p.policy ? expected_value(*p.policy, "flight_time_s") : selection::kUnknown;
  if (const double explored_s = landed_s - t.home_s; explored_s < kClearlySooner * t.turn_back_s)
    return "after about " + duration_text(std::max(0.0, explored_s)) + ", as in the flights known";
  if (!std::isnan(landed_s) || !p.cave) return "";
  const double length_m = p.cave->figures.length_m,
               once_s = t.limits.takeoff_height_m / t.limits.landing_speed_mps +
                        core::flight_time_s(length_m, t.limits.motion);
  if (!(once_s < kClearlySooner * t.turn_back_s)) return "";
  return "roughly after " + duration_text(once_s) +
         format_text(": the time to fly once along the %.0f m of passages", length_m);
}

Section time_section(const Preflight& p) {
  const TimeBudget& t = *p.time;
  const TimeLimits& l = t.limits;
  Section s{"Time", {}};
  if (l.battery_s) s.rows.push_back({"battery", duration_text(*l.battery_s) + " of hovering"});
  if (!l.battery_s || l.max_flight_time_s < kByFar * *l.battery_s)
    s.rows.push_back({"flight time allowed", duration_text(l.max_flight_time_s)});
  if (!t.explores()) return s;
  if (const std::string text = explored_text(p); !text.empty()) s.rows.push_back({"explored", text});
  s.rows.push_back(
      {"turns back", duration_text(t.turn_back_s) +
                         format_text(" after take-off, if it is then %.0f m from the start and the "
                                     "cave is not explored sooner",
                                     t.reach_m)});
  s.rows.push_back({"time of return", duration_text(t.return_s) +
                                          format_text(" after take-off, with %.0f s in reserve and %.0f "
                                                      "%% of the time home as margin",
                                                      t.limits.home_reserve_s, 100 * t.limits.home_margin)});
  return s;
}

std::string list_of(const std::vector<Finding>& findings, Severity severity, const char* title) {
  std::string out;
  for (const Finding& f : findings)
    if (f.severity == severity) out += std::string("  ") + core::name_of(f.subject) + ": " + f.text + "\n";
  return out.empty() ? "" : title + out;
}

}  // namespace

std::string duration_text(double seconds) {
  const auto whole = static_cast<long>(std::lround(seconds));
  if (whole < 60) return format_text("%ld s", whole);
  return format_text("%ld:%02ld min", whole / 60, whole % 60);
}

std::string verdict_text(const std::vector<Finding>& findings) {
  if (!is_go(findings)) return "NO-GO";
  if (findings.empty()) return "GO";
  return "GO, with " + core::counted(findings.size(), "thing") + " to watch for";
}

std::vector<Section> sections_of(const Preflight& p) {
  std::vector<Section> all;
  if (p.time) all.push_back(time_section(p));
  if (p.policy) all.push_back(policy_section(*p.policy));
  if (p.cave) all.push_back(cave_section(*p.cave));
  if (p.vehicle) all.push_back(vehicle_section(*p.vehicle));
  return all;
}

std::string findings_text(const Preflight& preflight, const std::vector<Finding>& findings) {
  return verdict_text(findings) + ": " + preflight.cave_file + "\n" +
         list_of(findings, Severity::no_go, "Reasons:\n") +
         list_of(findings, Severity::watch, "Watch for:\n");
}

std::string facts_text(const Preflight& preflight) {
  std::string out;
  for (const Section& s : sections_of(preflight)) {
    out += s.title + ":\n";
    for (const Row& r : s.rows) {
      if (r.page_only) continue;
      const std::string name = "  " + r.name + " ";
      out += name + std::string(kNameColumns - std::min(name.size(), kNameColumns), ' ') + r.text + "\n";
    }
  }
  return out;
}

}  // namespace karst::preflight
