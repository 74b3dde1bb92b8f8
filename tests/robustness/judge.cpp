#include "tests/robustness/judge.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core_stack/common/error.h"
#include "sdk/evaluation/metrics/flight_figures.h"
#include "sdk/evaluation/team/team_folders.h"

namespace karst::robustness {
namespace {

using core::Vec3;
using evaluation::event_number;
using evaluation::event_text;
using evaluation::RunRecord;

struct Span {
  double begin_s, end_s;
};

/// Between take-offs and what followed each; the last may have no end.
std::vector<Span> times_in_air(const RunRecord& run) {
  std::vector<Span> spans;
  bool in_air = false;
  for (const auto& e : run.truth_events) {
    const std::string what = event_text(e, "event");
    const double t_s = event_number(e, "time_s").value_or(0);
    if (what == "take-off" && !in_air) spans.push_back({t_s, run.last_time_s()}), in_air = true;
    if ((what == "landed" || what == "contact" || what == "battery") && in_air)
      spans.back().end_s = t_s, in_air = false;
  }
  return spans;
}

Vec3 position_of(const nlohmann::json& e) {
  return {event_number(e, "x").value_or(0), event_number(e, "y").value_or(0),
          event_number(e, "z").value_or(0)};
}

const nlohmann::json* last_of(const RunRecord& run, std::initializer_list<const char*> kinds) {
  for (auto e = run.truth_events.rbegin(); e != run.truth_events.rend(); ++e)
    for (const char* kind : kinds)
      if (event_text(*e, "event") == kind) return &*e;
  return nullptr;
}

std::string reason_of(const RunRecord& run) {
  if (const auto end = run.last<core::event::Outcome>())
    return core::name_of(end->outcome) + (": " + end->reason);
  return "the mission did not end";
}

Outcome outcome_of(const RunRecord& run) {
  const auto* start = last_of(run, {"start"});
  if (!start) return Outcome::not_flown;
  if (last_of(run, {"contact"})) return Outcome::contact;
  const auto* last = last_of(run, {"take-off", "landed", "battery"});
  if (!last) return Outcome::home;  // it never left the ground
  if (event_text(*last, "event") != "landed") return Outcome::in_the_air;
  const Vec3 off = position_of(*last) - position_of(*start);
  return off.head<2>().norm() <= kAtHome_m && std::abs(off.z()) <= kAtHome_m ? Outcome::home
                                                                             : Outcome::elsewhere;
}

}  // namespace

const char* name_of(Outcome outcome) {
  constexpr std::array kNames{"home",    "elsewhere", "stalled",  "in the air",
                              "contact", "no exit",   "not flown"};
  return kNames[static_cast<std::size_t>(outcome)];
}

double longest_stall_s(const RunRecord& run) {
  double longest_s = 0;
  for (const Span& span : times_in_air(run))
    for (const evaluation::Phase& phase : run.phases) {
      const evaluation::StampedPose* landmark = nullptr;
      for (const auto& p : run.truth) {
        if (p.t_s < std::max(span.begin_s, phase.begin_s) || p.t_s > std::min(span.end_s, phase.end_s))
          continue;
        if (!landmark || (p.T_world_body.position - landmark->T_world_body.position).norm() > kStallRadius_m)
          landmark = &p;
        longest_s = std::max(longest_s, p.t_s - landmark->t_s);
      }
    }
  return longest_s;
}

Verdict judge_vehicle(const RunRecord& run) {
  Verdict v;
  v.outcome = outcome_of(run);
  v.least_clearance_m = evaluation::flight_figures(run).min_clearance_m;
  v.stall_s = longest_stall_s(run);
  for (const Span& span : times_in_air(run)) v.in_air_s += span.end_s - span.begin_s;
  v.reason = reason_of(run);
  if (!is_bad(v.outcome) && v.stall_s > kStall_s) v.outcome = Outcome::stalled;
  return v;
}

Verdict judge(const std::filesystem::path& run_dir, const host::ProcessEnd& end) {
  Verdict all;
  try {
    std::vector<std::filesystem::path> folders{run_dir};
    if (evaluation::is_team(run_dir)) folders = evaluation::robot_folders(run_dir);
    for (std::size_t i = 0; i < folders.size(); ++i) {
      Verdict v = judge_vehicle(evaluation::read_run(folders[i]));
      if (folders.size() > 1) v.reason = "robot " + std::to_string(i + 1) + " " + v.reason;
      const Verdict former = all;
      if (i == 0 || v.outcome > former.outcome) all = v;
      if (i == 0) continue;
      all.stall_s = std::max(former.stall_s, v.stall_s);
      all.in_air_s = former.in_air_s + v.in_air_s;
      all.least_clearance_m = v.least_clearance_m;
      if (former.least_clearance_m)
        all.least_clearance_m = std::min(*former.least_clearance_m, v.least_clearance_m.value_or(1e9));
    }
  } catch (const core::InputError& e) {
    all.outcome = Outcome::not_flown;
    all.reason = e.what();
  }
  if (end.hung) {
    all.outcome = Outcome::no_exit;
  } else if (end.signal != 0) {
    if (all.outcome != Outcome::contact) all.outcome = Outcome::in_the_air;
    all.reason = host::describe(end);
  } else if (end.exit_code == 1) {
    all.outcome = std::max(all.outcome, Outcome::not_flown);
    all.reason = host::describe(end);
  }
  return all;
}

}  // namespace karst::robustness
