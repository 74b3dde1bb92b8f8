#include "sdk/preflight/preflight_words.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core_stack/common/counted.h"
#include "core_stack/common/format_text.h"

namespace karst::preflight {
namespace {

using core::format_text;

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
  Section s{"Cave",
            {{"volume", format_text("%.0f m^3 that a vehicle can reach or see, %.0f m of passages",
                                    f.volume_m3, f.length_m)},
             {"passages", format_text("%.1f m wide, %.1f m high (median); one in ten places is narrower than "
                                      "%.1f m or lower than %.1f m",
                                      p.width_m[1], p.height_m[1], p.width_m[0], p.height_m[0])},
             {"shape", shape_text(f)},
             {"start", format_text("%.2f %.2f %.2f, %.1f m from rock", c.start.x(), c.start.y(), c.start.z(),
                                   c.start_clearance_m)}}};
  return s;
}

std::string interval_text(const RankedPolicy& r, double level) {
  if (std::isnan(r.low) || std::isnan(r.high)) return "";
  return format_text(", %.0f %% interval %.3g to %.3g", 100 * level, r.low, r.high);
}

/// The figures that tell most beforehand, in this order.
std::string expected_text(const PolicyFacts& p) {
  std::string out;
  const auto add = [&](const char* metric, const char* unit, double factor) {
    const double v = expected_value(p, metric);
    if (std::isnan(v)) return;
    out += (out.empty() ? "" : ", ") + format_text("%.0f", factor * v) + unit;
  };
  add("coverage", " % of the cave", 100);
  add("explored_volume_m3", " m^3", 1);
  add("path_length_m", " m of flight", 1);
  add("energy_wh", " Wh", 1);
  if (!out.empty() && p.horizon_s > 0) out += format_text(", in at most %.0f s", p.horizon_s);
  return out;
}

Section policy_section(const PolicyFacts& p) {
  Section s{"Policy", {}};
  std::string parameters;
  for (const auto& [key, value] : p.parameters)
    parameters += (parameters.empty() ? " with " : ", ") + key + "=" + value;
  s.rows.push_back(
      {"policy", p.policy + parameters + (p.selected ? ", selected for this cave" : ", as named")});
  if (p.ranking.empty()) return s;
  if (p.selected) s.rows.push_back({"confidence", format_text("%.0f %%", 100 * p.confidence)});
  if (p.own) {
    const RankedPolicy& own = p.ranking[*p.own];
    s.rows.push_back(
        {"expected " + p.metric, format_text("%.3g", own.expected) + interval_text(own, p.level)});
    if (const std::string text = expected_text(p); !text.empty()) s.rows.push_back({"expected", text});
  }
  if (const std::size_t other = p.own == 0u ? 1 : 0; other < p.ranking.size())
    s.rows.push_back({other == 1 ? "runner-up" : "best",
                      p.ranking[other].name + format_text(", %.3g", p.ranking[other].expected) +
                          interval_text(p.ranking[other], p.level)});
  s.rows.push_back({p.selected ? "why this policy" : "by experience", p.reason});
  return s;
}

Section time_section(const TimeBudget& t) {
  Section s{"Time", {}};
  if (t.limits.battery_s) s.rows.push_back({"battery", duration_text(*t.limits.battery_s) + " of hovering"});
  s.rows.push_back({"flight time allowed", duration_text(t.limits.max_flight_time_s)});
  if (!t.can_explore) return s;
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
  if (p.time) all.push_back(time_section(*p.time));
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
      const std::string name = "  " + r.name + " ";
      out += name + std::string(kNameColumns - std::min(name.size(), kNameColumns), ' ') + r.text + "\n";
    }
  }
  return out;
}

}  // namespace karst::preflight
