#include "sdk/preflight/verdict.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core_stack/common/counted.h"
#include "core_stack/common/format_text.h"
#include "sdk/selection/figure_words.h"

namespace karst::preflight {
namespace {

using core::format_text;
using Findings = std::vector<Finding>;

void watch(Findings& found, Subject subject, std::string text) {
  found.push_back({Severity::watch, subject, std::move(text)});
}

void judge_time(const TimeBudget& t, Findings& found) {
  const char* battery = t.limits.battery_s ? "the battery and " : "";
  if (!t.can_explore) {
    found.push_back({Severity::no_go, Subject::time,
                     format_text("no time is left to explore: %sthe flight time allowed last %.0f s, and "
                                 "take-off, landing and the reserve (mission.home_reserve, %.0f s) need more",
                                 battery, t.endurance_s, t.limits.home_reserve_s)});
    return;
  }
  if (!t.explores()) {
    found.push_back(
        {Severity::no_go, Subject::time,
         format_text("the time is too short to explore: of %.0f s, take-off, landing, the reserve "
                     "(mission.home_reserve, %.0f s) and the margin leave a flight of %.0f m from "
                     "the start and back, less than the %.0f m between two decisions "
                     "(mission.decision_period)",
                     t.endurance_s, t.limits.home_reserve_s, t.reach_m, t.stride_m)});
    return;
  }
  if (!t.reaches_all())
    watch(
        found, Subject::time,
        format_text("the cave is deeper than the vehicle can fly and come back: its farthest place is %.0f m "
                    "from the start, and %.0f s allow at most %.0f m",
                    t.farthest_m, t.endurance_s, t.reach_m));
}

void judge_cave(const CaveFacts& c, const VehicleFacts& v, Findings& found) {
  const double narrow = c.hull_reachable_m3 > 0 ? 1 - c.reachable_m3 / c.hull_reachable_m3 : 0;
  if (narrow >= kNarrowFraction)
    watch(found, Subject::passages,
          format_text("%.0f %% of the space that the hull (%.2f m wide) could reach lies behind passages too "
                      "narrow for the vehicle's clearance: it needs %.2f m. planning.narrow_margin allows "
                      "narrower ones",
                      100 * narrow, 2 * v.radius_m, 2 * v.clearance_m));
  if (c.blind_climb_fraction >= kBlindFraction)
    watch(found, Subject::climbs,
          format_text("%.0f %% of the places lie behind shafts steeper than the vehicle's sensors look (%.0f "
                      "deg up, %.0f deg down), and are left out; on the way to one, ",
                      100 * c.blind_climb_fraction, v.looks_up_rad * 180 / std::numbers::pi,
                      v.looks_down_rad * 180 / std::numbers::pi) +
              c.blind_climb);
  if (!c.holes.empty() && c.holes.front().distance_m < kNearHole_m) {
    const Hole& h = c.holes.front();
    watch(found, Subject::hole,
          format_text("the start is %.1f m from a hole of the mesh, %.1f m across, around %.1f %.1f %.1f; "
                      "`karst cave info CAVE --cap OUT.ply` closes it",
                      std::max(0.0, h.distance_m), h.diameter_m, h.centre.x(), h.centre.y(), h.centre.z()));
  } else if (!c.holes.empty()) {
    watch(found, Subject::hole,
          "the mesh has " + core::counted(c.holes.size(), "hole") +
              format_text(", the nearest %.0f m from the start", c.holes.front().distance_m));
  }
}

void judge_policy(const PolicyFacts& p, Findings& found) {
  if (p.ranking.empty()) {
    watch(found, Subject::policy,
          (p.fallback ? "no policy could be selected, so it is " + p.policy +
                            ", and nothing can be said of what it will explore: "
                      : "nothing can be said of what it will explore: ") +
              p.reason);
    return;
  }
  if (p.selected && p.confidence < kLowConfidence)
    watch(found, Subject::confidence,
          "the choice of the policy is uncertain: it is first in only " +
              selection::share_text(p.confidence) + " of the resamplings" +
              (p.ranking.size() > 1 ? ", next is " + p.ranking[1].name : ""));
  if (!p.selected && !p.own)
    watch(found, Subject::policy,
          p.policy + " has not been flown in caves like this; expected to do best is " +
              p.ranking.front().name);
  if (!p.selected && p.own.value_or(0) > 0)
    watch(found, Subject::policy,
          p.ranking.front().name + " is expected to do better in " + selection::metric_words(p.metric) +
              ": " + selection::metric_value_text(p.metric, p.ranking.front().expected) + ", against " +
              selection::metric_value_text(p.metric, p.ranking[*p.own].expected) + " of " +
              p.ranking[*p.own].name);
}

/// The figures expected, in the time there is.
void judge_coverage(const PolicyFacts& p, Findings& found) {
  if (const double coverage = expected_value(p, "coverage"); coverage < kMuchCoverage)
    watch(found, Subject::coverage,
          "the cave is larger than this flight explores: " + selection::share_text(coverage) +
              " of it is expected");
}

/// Flights of another length are behind what is expected. Longer ones matter only if something is left to
/// explore.
void judge_horizon(const PolicyFacts& p, const TimeBudget& t, Findings& found) {
  if (p.expected.empty() || !(p.horizon_s > 0)) return;
  if (std::abs(t.endurance_s - p.horizon_s) <= kOtherHorizon * p.horizon_s) return;
  const bool longer = t.endurance_s > p.horizon_s;
  if (longer && !(expected_value(p, "coverage") < kMuchCoverage)) return;
  watch(found, Subject::coverage,
        format_text(
            "the expected figures come from flights of at most %.0f s, scaled to the %.0f s of this one, "
            "which explores %s",
            p.horizon_s, t.endurance_s, longer ? "more" : "less"));
}

}  // namespace

std::vector<Finding> findings_of(const Preflight& p) {
  Findings found;
  for (const Refusal& r : p.refusals) found.push_back({Severity::no_go, r.subject, r.reason});
  if (p.time) judge_time(*p.time, found);
  for (const std::string& note : p.mesh_notes) watch(found, Subject::cave, note);
  if (p.cave && p.vehicle) judge_cave(*p.cave, *p.vehicle, found);
  if (p.policy) judge_policy(*p.policy, found);
  if (p.policy && p.time && p.time->explores()) {
    judge_coverage(*p.policy, found);
    judge_horizon(*p.policy, *p.time, found);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Finding& a, const Finding& b) { return a.severity < b.severity; });
  return found;
}

bool is_go(const std::vector<Finding>& findings) {
  return std::none_of(findings.begin(), findings.end(),
                      [](const Finding& f) { return f.severity == Severity::no_go; });
}

}  // namespace karst::preflight
