#include "sdk/evaluation/metrics/ending.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "core_stack/common/counted.h"
#include "core_stack/common/format_text.h"
#include "sdk/evaluation/metrics/flight_figures.h"

namespace karst::evaluation {
namespace {

using core::format_text;
using core::MissionOutcome;
namespace event = core::event;

/// Whether a vehicle turned back for it with mission.home_reserve left for after the way home.
enum class Reserve { none, kept };

/// A reason as mission control records it, and as it reads once the flight is over. What follows a reason
/// that ends in a colon is a detail.
struct Reason {
  std::string_view recorded, afterwards;
  Reserve reserve = Reserve::none;
};
constexpr std::array kReasons = {
    Reason{"explored: no frontier can be reached", "nothing was left to explore"},
    Reason{"explored: no frontier left that can be accepted", "nothing was left to explore"},
    Reason{"explored: ", "nothing was left to explore"},
    Reason{"what is left is too far for the battery", "what was left was too far for the battery",
           Reserve::kept},
    Reason{"what is left is too far for the time allowed", "what was left was too far for the time allowed",
           Reserve::kept},
    Reason{"the battery only just suffices for the way home",
           "the battery only just sufficed for the way home", Reserve::kept},
    Reason{"the time allowed only just suffices for the way home",
           "the time allowed only just sufficed for the way home", Reserve::kept},
    Reason{"the policy asked for it: an error of the core: ", "the core failed"},
    Reason{"the policy asked for it: ", "the policy asked for it"},
    Reason{"the state estimate is lost: ", "the pose was lost"},
    Reason{"the state estimate stays degraded", "the state estimate stayed degraded"},
    Reason{"no sensor sees the cave any more", "no sensor saw the cave any more"},
    Reason{"the run directory cannot be written any more (disk full?)",
           "the run directory could not be written any more (disk full?)"},
    Reason{"the battery ends", "the battery was nearly empty"},
    Reason{"no way home, and waiting does not help", "there was no way home, and waiting did not help"},
    Reason{"supervision does not come any more", "the supervision did not come any more"},
    Reason{"control does not come any more", "the control did not come any more"},
    Reason{"it cannot find its place in the earlier map: ", "it could not find its place in the earlier map"},
    Reason{"it does not lift off: ", "it did not lift off"},
};
constexpr std::string_view kOutOfContact = "out of contact, but there is no time for another place";
constexpr std::string_view kInContact = "in contact";
constexpr std::string_view kPolicyFailed = "the policy failed: ";

std::string afterwards(const std::string& reason, std::optional<double> home_reserve_s = {}) {
  for (const Reason& known : kReasons) {
    if (!reason.starts_with(known.recorded)) continue;
    const std::string detail = reason.substr(known.recorded.size());
    const bool reserve = known.reserve == Reserve::kept && home_reserve_s;
    if (detail.empty())
      return std::string(known.afterwards) +
             (reserve ? format_text(", with %.0f s in reserve", *home_reserve_s) : "");
    if (known.recorded.ends_with(": ")) return std::string(known.afterwards) + " (" + detail + ")";
  }
  return reason;
}

/// The begin of a phase that ended something.
struct Turn {
  double time_s = 0;
  core::Phase phase{};
  std::string why;  // afterwards; may be empty
};

/// What the events tell of a flight.
struct Course {
  std::optional<double> takeoff_s;
  std::optional<Turn> turned_back;  // the first time that it went home, or down before that
  std::optional<Turn> came_down;    // the last time that it went down for a reason of its own
  std::optional<core::Phase> last;  // before it was over
  bool out_of_contact = false;      // it landed as a relay so
  bool as_relay = false;
  bool to_its_end = false;  // it explored to its end
};

Course course_of(const RunRecord& run, std::optional<double> home_reserve_s) {
  Course c;
  for (const nlohmann::json& e : run.events) {
    const auto phase = event::as<event::Phase>(e);
    if (!phase || phase->phase == core::Phase::done) continue;
    const double time_s = e["t"].get<double>();
    c.last = phase->phase;
    if (!core::traits_of(phase->phase).airborne) continue;
    if (!c.takeoff_s) c.takeoff_s = time_s;
    const bool down = phase->phase == core::Phase::land;
    if (!down && phase->phase != core::Phase::home) continue;
    const Turn turn{time_s, phase->phase, afterwards(phase->reason, home_reserve_s)};
    if (!c.turned_back) c.turned_back = turn;
    c.out_of_contact = down && phase->reason == kOutOfContact;
    if (down && !phase->reason.empty() && phase->reason != kInContact && !c.out_of_contact)
      c.came_down = turn;
  }
  const auto landing = run.last<event::Landing>();
  c.as_relay = landing && landing->state == event::LandingState::claimed;
  c.to_its_end = explored_to_its_end(run);
  return c;
}

/// " after 64 s" of flight; "" if it did not take off.
std::string after(const Course& c, double time_s) {
  return c.takeoff_s ? format_text(" after %.0f s", time_s - *c.takeoff_s) : "";
}

/// Why exploration ended, behind "home" and the like.
std::string cause(const Course& c) {
  if (!c.turned_back) return "";
  const Turn& turn = *c.turned_back;
  if (turn.why.empty()) return after(c, turn.time_s);
  return c.to_its_end ? " because " + turn.why : after(c, turn.time_s) + ": " + turn.why;
}

bool had_turned_back(const Course& c) { return c.turned_back && c.turned_back->phase == core::Phase::home; }

/// Why exploration had ended before something else ended the flight.
std::string earlier_cause(const Course& c) {
  return had_turned_back(c) ? "; it had turned back" + cause(c) : "";
}

std::string doing(const Course& c) {
  switch (c.last.value_or(core::Phase::standby)) {  // without a default: the compiler names what is left out
    case core::Phase::takeoff:
      return " while taking off";
    case core::Phase::look:
    case core::Phase::explore:
      return " while exploring";
    case core::Phase::home:
      return " on the way home";
    case core::Phase::land:
      return " while landing";
    case core::Phase::manual:
      return " while another steered it";
    case core::Phase::standby:
    case core::Phase::done:
      return " before take-off";
    case core::Phase::replay:
      break;
  }
  return "";
}

std::string of_landing(const Course& c, const EndFigures& figures) {
  if (c.as_relay)
    return std::string("landed as a relay") + (c.out_of_contact ? ", out of contact with the base," : "") +
           cause(c);
  const double off_m = figures.landing_error_m.value_or(0);
  return "home" + cause(c) + (off_m > kAtStart_m ? format_text("; landed %.1f m from the start", off_m) : "");
}

/// `reason`: "on the ground 12.3 m from the start", or why it never left the ground.
std::string of_stuck(const Course& c, const std::string& reason) {
  if (!c.came_down) return afterwards(reason) + earlier_cause(c);
  return reason + (had_turned_back(c) ? "" : after(c, c.came_down->time_s)) + ": " + c.came_down->why +
         earlier_cause(c);
}

std::string of_outcome(const Course& c, const event::Outcome& end, double end_s, const EndFigures& figures) {
  const std::string because = end.reason.empty() ? "" : ": " + end.reason;
  switch (end.outcome) {  // without a default: the compiler names what is left out
    case MissionOutcome::landed:
      return of_landing(c, figures);
    case MissionOutcome::stuck:
      return of_stuck(c, end.reason);
    case MissionOutcome::aborted:
      return "given up" + after(c, c.came_down ? c.came_down->time_s : end_s) + because + earlier_cause(c);
    case MissionOutcome::battery:
      return "battery empty" + after(c, end_s) + doing(c) + earlier_cause(c);
    case MissionOutcome::contact:
    case MissionOutcome::lost:
      return core::name_of(end.outcome) + after(c, end_s) + doing(c) + because + earlier_cause(c);
    case MissionOutcome::replayed:
    case MissionOutcome::incomplete:
      break;
  }
  return core::name_of(end.outcome) + because;
}

/// When the outcome was recorded.
double outcome_time_s(const RunRecord& run) {
  for (auto e = run.events.rbegin(); e != run.events.rend(); ++e)
    if (event::is_kind(*e, event::Outcome::kKind)) return (*e)["t"].get<double>();
  return run.last_time_s();
}

std::optional<FailedPolicy> failed_policy(const RunRecord& run) {
  for (const nlohmann::json& e : run.events) {
    const auto safety = event::as<event::Safety>(e);
    if (!safety || safety->action != core::SafetyAction::fallback) continue;
    const bool known = safety->reason.starts_with(kPolicyFailed);
    return FailedPolicy{e["t"].get<double>(),
                        known ? safety->reason.substr(kPolicyFailed.size()) : safety->reason};
  }
  return std::nullopt;
}

LostDecisions lost_decisions(const RunRecord& run) {
  LostDecisions lost;
  for (const nlohmann::json& e : run.events) {
    const auto decision = event::as<event::Decision>(e);
    if (!decision) continue;
    const std::string failed = decision->policy + " failed: ";
    if (!decision->reason.starts_with(failed)) continue;
    ++lost.count;
    lost.last = decision->reason.substr(failed.size());
  }
  return lost;
}

/// "; the policy crashed and was started once more"; "" if nothing happened to it.
std::string trouble_text(const Ending& ending) {
  if (ending.failed_policy) return "; the policy failed, and the fallback took over";
  if (ending.restart) return "; the policy " + ending.restart->what + " and was started once more";
  return ending.lost_decisions.count == 0
             ? ""
             : "; the policy failed in " + core::counted(ending.lost_decisions.count, "decision");
}

}  // namespace

Ending ending_of(const RunRecord& run, const EndFigures& figures) {
  if (run.events.empty()) return {};
  const Course course = course_of(run, figures.home_reserve_s);
  const auto end = run.last<event::Outcome>();
  Ending ending;
  ending.failed_policy = failed_policy(run);
  ending.restart = policy_restart(run);
  ending.lost_decisions = lost_decisions(run);
  ending.as_meant = (end && end->outcome == MissionOutcome::replayed) ||
                    completed(run, course.as_relay ? std::nullopt : figures.landing_error_m);
  ending.sentence = end ? of_outcome(course, *end, outcome_time_s(run), figures)
                        : "the record ends" + after(course, run.last_time_s()) + doing(course);
  const bool empty = end && end->outcome == MissionOutcome::battery;
  if (figures.battery_left && std::isfinite(*figures.battery_left) && !empty)
    ending.sentence += format_text("; %.0f %% battery left", 100 * *figures.battery_left);
  ending.sentence += trouble_text(ending);
  return ending;
}

Ending ending_of(const RunRecord& run) {
  return ending_of(run, {landed_off_m(run), last_finite(run.telemetry.column("battery_fraction")),
                         run.number(kHomeReserveKey)});
}

Ending joint_ending(const std::vector<Ending>& robots) {
  if (robots.size() == 1) return robots.front();
  const auto silent = [](const Ending& e) { return e.sentence.empty(); };
  if (std::all_of(robots.begin(), robots.end(), silent)) return {};
  Ending joint{.as_meant = true, .sentence = ""};
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (robots[i].as_meant) continue;
    joint.as_meant = false;
    joint.sentence += (joint.sentence.empty() ? "robot " : ". Robot ") + std::to_string(i + 1) + ": " +
                      (silent(robots[i]) ? "nothing recorded" : robots[i].sentence);
  }
  if (joint.as_meant) joint.sentence = "all " + std::to_string(robots.size()) + " robots flew as planned";
  for (std::size_t i = 0; i < robots.size(); ++i)
    if (const std::string trouble = trouble_text(robots[i]); robots[i].as_meant && !trouble.empty())
      joint.sentence += "; robot " + std::to_string(i + 1) + ":" + trouble.substr(1);
  return joint;
}

}  // namespace karst::evaluation
