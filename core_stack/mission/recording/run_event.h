// What happens in a run: the lines of events.jsonl, a struct for each kind, with its fields by the names they
// have in the file. Mission control and replays write them, the evaluation reads them; docs/run_directory.md
// says what each field is.
//
// A number that is not known is NaN, and null in the file. What a line may lack is a std::optional. Lines of
// other versions are read as well: a field that is absent keeps its default, unless it is an enumeration,
// without which the line says nothing; kinds and fields that are unknown are passed over.
#pragma once
#include <cstdint>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "core_stack/common/geometry.h"
#include "core_stack/common/time.h"
#include "core_stack/localization/hypothesis.h"
#include "core_stack/mission/policy/decision.h"
#include "core_stack/mission/state/load_shedding.h"
#include "core_stack/mission/state/phase.h"
#include "core_stack/mission/state/safety_action.h"
#include "core_stack/objects/object_state.h"
#include "core_stack/planning/trajectory/speed_by_trust.h"
#include "core_stack/planning/trajectory/trajectory_kind.h"
#include "core_stack/vehicle/authority.h"
#include "core_stack/vehicle/mission_outcome.h"
#include "core_stack/vehicle/object_detection.h"

namespace karst::core::event {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

template <class Event, class T>
struct Field {
  const char* name;
  T Event::*member;
};
template <class Event, class T>
Field(const char*, T Event::*) -> Field<Event, T>;

struct Phase {
  static constexpr const char* kKind = "phase";
  core::Phase phase{};
  std::string reason;
  static constexpr auto fields() {
    return std::make_tuple(Field{"phase", &Phase::phase}, Field{"reason", &Phase::reason});
  }
};

struct Selection {
  static constexpr const char* kKind = "selection";
  std::string policy, reason;
  static constexpr auto fields() {
    return std::make_tuple(Field{"policy", &Selection::policy}, Field{"reason", &Selection::reason});
  }
};

struct Decision {
  static constexpr const char* kKind = "decision";
  core::Outcome outcome{};
  std::string policy, reason;
  std::uint64_t goals = 0, frontiers = 0;
  bool appending = false;
  static constexpr auto fields() {
    return std::make_tuple(Field{"outcome", &Decision::outcome}, Field{"policy", &Decision::policy},
                           Field{"reason", &Decision::reason}, Field{"goals", &Decision::goals},
                           Field{"frontiers", &Decision::frontiers},
                           Field{"appending", &Decision::appending});
  }
};

/// A cluster as offered with a decision: [id, x, y, z, cells].
struct Cluster {
  std::uint32_t id = 0;
  Vec3 centroid = Vec3::Zero();
  std::uint32_t unknown_cells = 0;
  bool operator==(const Cluster&) const = default;
};
struct Frontiers {
  static constexpr const char* kKind = "frontiers";
  std::vector<Cluster> clusters;
  static constexpr auto fields() { return std::make_tuple(Field{"clusters", &Frontiers::clusters}); }
};

enum class FrontierState { refused };
constexpr auto names_of(FrontierState) {
  return std::to_array<Named<FrontierState>>({{FrontierState::refused, "refused"}});
}
struct Frontier {
  static constexpr const char* kKind = "frontier";
  FrontierState state{};
  std::uint32_t id = 0;
  Vec3 position = Vec3::Constant(kUnknown);
  std::string reason;
  static constexpr auto fields() {
    return std::make_tuple(Field{"state", &Frontier::state}, Field{"id", &Frontier::id},
                           Field{"position", &Frontier::position}, Field{"reason", &Frontier::reason});
  }
};

struct Drawing {
  static constexpr const char* kKind = "drawing";
  core::Drawing::Kind shape{};
  std::vector<Vec3> points;
  std::uint32_t rgb = 0xffffff;
  std::string text;
  static constexpr auto fields() {
    return std::make_tuple(Field{"shape", &Drawing::shape}, Field{"points", &Drawing::points},
                           Field{"rgb", &Drawing::rgb}, Field{"text", &Drawing::text});
  }
};

enum class GoalState { accepted, rejected, reached, unreachable, abandoned, superseded };
constexpr auto names_of(GoalState) {
  using enum GoalState;
  return std::to_array<Named<GoalState>>({{accepted, "accepted"},
                                          {rejected, "rejected"},
                                          {reached, "reached"},
                                          {unreachable, "unreachable"},
                                          {abandoned, "abandoned"},
                                          {superseded, "superseded"}});
}
struct Goal {
  static constexpr const char* kKind = "goal";
  GoalState state{};
  Vec3 position = Vec3::Constant(kUnknown);
  double heading_rad = kUnknown, score = kUnknown;
  std::uint32_t frontier = 0;
  std::string why, reason;
  static constexpr auto fields() {
    return std::make_tuple(Field{"state", &Goal::state}, Field{"position", &Goal::position},
                           Field{"heading", &Goal::heading_rad}, Field{"score", &Goal::score},
                           Field{"frontier", &Goal::frontier}, Field{"why", &Goal::why},
                           Field{"reason", &Goal::reason});
  }
};

struct Plan {
  static constexpr const char* kKind = "plan";
  std::vector<Vec3> points;
  Vec3 from = Vec3::Constant(kUnknown), to = Vec3::Constant(kUnknown);
  double length_m = kUnknown, length_bound = kUnknown;
  bool narrow = false;
  std::optional<TrajectoryKind> trajectory = {};  // where the mission asks for polynomials, as the next two
  std::optional<int> rounds = {};
  std::optional<std::string> fell_back = {};
  static constexpr auto fields() {
    return std::make_tuple(Field{"points", &Plan::points}, Field{"from", &Plan::from}, Field{"to", &Plan::to},
                           Field{"length", &Plan::length_m}, Field{"length_bound", &Plan::length_bound},
                           Field{"narrow", &Plan::narrow}, Field{"trajectory", &Plan::trajectory},
                           Field{"rounds", &Plan::rounds}, Field{"fell_back", &Plan::fell_back});
  }
};

struct Object {
  static constexpr const char* kKind = "object";
  ObjectState state{};
  std::uint32_t number = 0;
  std::optional<ObjectKind> what = {};  // what follows is not said again where it is reported
  std::optional<Vec3> position = {};
  std::optional<double> deviation_m = {};
  std::optional<std::uint32_t> sightings = {};
  static constexpr auto fields() {
    return std::make_tuple(Field{"state", &Object::state}, Field{"number", &Object::number},
                           Field{"what", &Object::what}, Field{"position", &Object::position},
                           Field{"deviation", &Object::deviation_m}, Field{"sightings", &Object::sightings});
  }
};

struct Log {
  static constexpr const char* kKind = "log";
  std::string text;
  std::optional<double> correction_s = {};  // of the LiDAR's stamps
  static constexpr auto fields() {
    return std::make_tuple(Field{"text", &Log::text}, Field{"correction", &Log::correction_s});
  }
};

struct Homing {
  static constexpr const char* kKind = "homing";
  std::string reason;
  double distance_m = kUnknown, seconds_left = kUnknown, seconds_needed = kUnknown;
  static constexpr auto fields() {
    return std::make_tuple(Field{"reason", &Homing::reason}, Field{"distance", &Homing::distance_m},
                           Field{"seconds_left", &Homing::seconds_left},
                           Field{"seconds_needed", &Homing::seconds_needed});
  }
};

struct Safety {
  static constexpr const char* kKind = "safety";
  SafetyAction action{};
  std::string reason;
  std::optional<double> after_m = {};  // to where the map closes the path
  static constexpr auto fields() {
    return std::make_tuple(Field{"action", &Safety::action}, Field{"reason", &Safety::reason},
                           Field{"after_m", &Safety::after_m});
  }
};

/// From then on, and only where motion.max_speed is above what is flown whatever the sensors see.
struct SpeedLimit {
  static constexpr const char* kKind = "speed_limit";
  core::SpeedLimit by{};
  double speed_mps = kUnknown;  // of the reference
  static constexpr auto fields() {
    return std::make_tuple(Field{"by", &SpeedLimit::by}, Field{"speed", &SpeedLimit::speed_mps});
  }
};

struct Authority {
  static constexpr const char* kKind = "authority";
  core::Authority who{};
  std::string reason;
  static constexpr auto fields() {
    return std::make_tuple(Field{"who", &Authority::who}, Field{"reason", &Authority::reason});
  }
};

struct Overrun {
  static constexpr const char* kKind = "overrun";
  int count = 0;
  static constexpr auto fields() { return std::make_tuple(Field{"count", &Overrun::count}); }
};

enum class DegradedState { begins, over };
constexpr auto names_of(DegradedState) {
  using enum DegradedState;
  return std::to_array<Named<DegradedState>>({{begins, "begins"}, {over, "over"}});
}
struct Degraded {
  static constexpr const char* kKind = "degraded";
  Relief what{};
  DegradedState state{};
  std::string reason;
  double since_s = kUnknown;
  static constexpr auto fields() {
    return std::make_tuple(Field{"what", &Degraded::what}, Field{"state", &Degraded::state},
                           Field{"reason", &Degraded::reason}, Field{"since", &Degraded::since_s});
  }
};

enum class LocalizationState { lost, found };
constexpr auto names_of(LocalizationState) {
  using enum LocalizationState;
  return std::to_array<Named<LocalizationState>>({{lost, "lost"}, {found, "found"}});
}
struct Localization {
  static constexpr const char* kKind = "localization";
  std::string reason;
  std::optional<bool> valid = {}, accepted = {};  // of a flight, as the next two
  std::optional<int> free_directions = {};
  std::optional<Hypothesis> believed = {};
  std::optional<LocalizationState> state = {};  // of a replay
  static constexpr auto fields() {
    return std::make_tuple(Field{"reason", &Localization::reason}, Field{"valid", &Localization::valid},
                           Field{"accepted", &Localization::accepted},
                           Field{"free_directions", &Localization::free_directions},
                           Field{"believed", &Localization::believed}, Field{"state", &Localization::state});
  }
};

enum class LandingState { claimed, given_up, start };
constexpr auto names_of(LandingState) {
  using enum LandingState;
  return std::to_array<Named<LandingState>>({{claimed, "claimed"}, {given_up, "given up"}, {start, "start"}});
}
struct Landing {
  static constexpr const char* kKind = "landing";
  LandingState state{};
  std::optional<std::string> reason = {};  // unless a place is claimed, of which all that follows is said
  std::optional<Vec3> ground = {}, hover = {};
  std::optional<std::uint32_t> node = {};
  std::optional<bool> node_claimed = {};
  std::optional<double> distance_m = {}, seconds_needed = {}, seconds_left = {};
  static constexpr auto fields() {
    return std::make_tuple(
        Field{"state", &Landing::state}, Field{"reason", &Landing::reason}, Field{"ground", &Landing::ground},
        Field{"hover", &Landing::hover}, Field{"node", &Landing::node},
        Field{"node_claimed", &Landing::node_claimed}, Field{"distance", &Landing::distance_m},
        Field{"seconds_needed", &Landing::seconds_needed}, Field{"seconds_left", &Landing::seconds_left});
  }
};

struct Drop {
  static constexpr const char* kKind = "drop";
  Vec3 ground = Vec3::Constant(kUnknown);
  std::int64_t left = 0;
  static constexpr auto fields() {
    return std::make_tuple(Field{"ground", &Drop::ground}, Field{"left", &Drop::left});
  }
};

enum class TeamAction { give_way, make_room, wait, no_room, stop, go_on };
constexpr auto names_of(TeamAction) {
  using enum TeamAction;
  return std::to_array<Named<TeamAction>>({{give_way, "give way"},
                                           {make_room, "make room"},
                                           {wait, "wait"},
                                           {no_room, "no room"},
                                           {stop, "stop"},
                                           {go_on, "go on"}});
}
struct Team {
  static constexpr const char* kKind = "team";
  TeamAction action{};
  std::optional<std::uint32_t> robot = {};
  std::optional<Vec3> to = {};
  std::optional<bool> keeps_passage_open = {};
  static constexpr auto fields() {
    return std::make_tuple(Field{"action", &Team::action}, Field{"robot", &Team::robot},
                           Field{"to", &Team::to}, Field{"others_get_by", &Team::keeps_passage_open});
  }
};

/// Of the map of an earlier flight: whether the vehicle found its place in it.
enum class EarlierMapState { found, not_found, given_up };
constexpr auto names_of(EarlierMapState) {
  using enum EarlierMapState;
  return std::to_array<Named<EarlierMapState>>(
      {{found, "found"}, {not_found, "not found"}, {given_up, "given up"}});
}
struct EarlierMap {
  static constexpr const char* kKind = "earlier_map";
  EarlierMapState state{};
  std::string reason;  // "" if it was found
  int attempt = 0;
  std::optional<Vec3> position = {};  // of the earlier map's origin in the flight, as the next
  std::optional<double> heading_rad = {};
  std::optional<double> overlap = {}, agreement = {}, residual_m = {}, surface_residual_m = {}, hold = {},
                        rival = {};
  std::optional<double> free_m3 = {};  // of the earlier map, if it was found
  static constexpr auto fields() {
    return std::make_tuple(
        Field{"state", &EarlierMap::state}, Field{"reason", &EarlierMap::reason},
        Field{"attempt", &EarlierMap::attempt}, Field{"position", &EarlierMap::position},
        Field{"heading", &EarlierMap::heading_rad}, Field{"overlap", &EarlierMap::overlap},
        Field{"agreement", &EarlierMap::agreement}, Field{"residual", &EarlierMap::residual_m},
        Field{"surface_residual", &EarlierMap::surface_residual_m}, Field{"hold", &EarlierMap::hold},
        Field{"rival", &EarlierMap::rival}, Field{"free_m3", &EarlierMap::free_m3});
  }
};

struct Outcome {
  static constexpr const char* kKind = "outcome";
  MissionOutcome outcome{};
  std::string reason;
  std::optional<double> mass_kg = {};  // of a flight
  static constexpr auto fields() {
    return std::make_tuple(Field{"outcome", &Outcome::outcome}, Field{"reason", &Outcome::reason},
                           Field{"mass_kg", &Outcome::mass_kg});
  }
};

using Event = std::variant<Phase, Selection, Decision, Frontiers, Frontier, Drawing, Goal, Plan, Object, Log,
                           Homing, Safety, SpeedLimit, Authority, Overrun, Degraded, Localization, Landing,
                           Drop, Team, EarlierMap, Outcome>;

/// The line without its end: {"t": ..., "kind": ..., and the fields by name}.
std::string line_of(TimeNs t, const Event& event);
/// The same in two steps: the fields of an event with many, where there is time for it, and the line later.
std::string fields_text(const Event& event);
std::string line_of(TimeNs t, const char* kind, const std::string& fields);

/// A line that is not what its kind promises: what() names kind, field and what was expected.
struct Malformed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A parsed line; none if it is of an unknown kind. Throws Malformed.
std::optional<Event> read(const nlohmann::json& line);
bool is_kind(const nlohmann::json& line, const char* kind);

/// A parsed line as an event of this kind, if it is one. Throws Malformed.
template <class E>
std::optional<E> as(const nlohmann::json& line) {
  if (!is_kind(line, E::kKind)) return std::nullopt;
  return std::get<E>(*read(line));
}

}  // namespace karst::core::event
