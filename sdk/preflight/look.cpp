#include "sdk/preflight/look.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "core_stack/common/error.h"
#include "core_stack/common/options.h"
#include "core_stack/mission/decision/visibility.h"
#include "plugins/simulator/cave/boundary_loops.h"
#include "plugins/simulator/cave/cave.h"
#include "sdk/campaign/plan/mesh_hash.h"
#include "sdk/evaluation/metrics/metric_definitions.h"
#include "sdk/evaluation/reachable/reachable.h"
#include "sdk/flight/auto_policy.h"
#include "sdk/flight/cave_check.h"
#include "sdk/flight/flight_setup.h"
#include "sdk/flight/loaded_policies.h"
#include "sdk/preflight/far_places.h"
#include "sdk/selection/describe.h"
#include "sdk/selection/experience.h"
#include "sdk/selection/forecast.h"
#include "sdk/selection/load_experience.h"
#include "sdk/selection/select_words.h"

namespace karst::preflight {
namespace {

using core::InputError;
using flight::Mission;
using selection::Experience;

constexpr const char* kFallbackPolicy = "nearest_frontier";
constexpr double kLeastHole_m2 = 0.01;  // smaller ones are slits between triangles

bool is_auto(const Mission& m) { return m.policy == flight::kAutoPolicy; }

/// Every parameter of the mission's policy with the value in force. Throws what `karst fly` would: an unknown
/// policy, or a parameter that it does not have.
boost::property_tree::ptree parameters_in_force(const Mission& mission, const LookOptions& options) {
  flight::FlightRequest request;
  request.plugins = options.plugins;
  request.notes = false;
  return flight::load_policies({mission}, request).policies.front()->parameters();
}

std::optional<core::VehicleDescription> vehicle_of(const Mission& m, Preflight& p) {
  try {
    const flight::Vehicles vehicles = flight::make_vehicles(m, flight::missions_of_members(m), "");
    return vehicles[0].description();
  } catch (const InputError& e) {
    p.refusals.push_back({Subject::start, e.what()});
    return std::nullopt;
  }
}

VehicleFacts facts_of(const core::VehicleDescription& vehicle, const core::CoreOptions& o) {
  const core::SteepestView view = core::steepest_view(vehicle);
  VehicleFacts v;
  v.name = vehicle.name;
  v.radius_m = vehicle.radius_m;
  v.clearance_m = o.planning.narrow_margin_m > 0 ? vehicle.radius_m + o.planning.narrow_margin_m
                                                 : core::min_clearance_m(o.planning, o.map.resolution_m);
  v.looks_up_rad = view.up_rad;
  v.looks_down_rad = view.down_rad;
  return v;
}

std::vector<Hole> holes_of(const cave::RayScene& scene, const core::Vec3& start) {
  std::vector<Hole> holes;
  for (const cave::BoundaryLoop& loop : cave::boundary_loops(scene.mesh())) {
    if (loop.area_m2 < kLeastHole_m2) continue;
    const double edge_m = (loop.centre - start).norm() - loop.diameter_m / 2;
    holes.push_back({loop.centre, loop.diameter_m, std::max(0.0, edge_m)});
  }
  std::stable_sort(holes.begin(), holes.end(),
                   [](const Hole& a, const Hole& b) { return a.distance_m < b.distance_m; });
  return holes;
}

/// The cave as this vehicle finds it. Throws InputError if nothing can be flown in.
CaveFacts cave_facts(const cave::Cave& rock, const selection::FreeSpace& space, const VehicleFacts& vehicle,
                     double hull_clearance_m, const FarPlaces& far) {
  const core::Vec3& start = rock.description.start.position;
  const auto reachable = [&](std::optional<double> clearance_m) {
    evaluation::ReachableOptions options;
    if (clearance_m) options.clearance_m = *clearance_m;
    return evaluation::find_reachable(rock.scene.mesh(), start, options, rock.description.mesh_path);
  };
  const evaluation::Reachable own = reachable(vehicle.clearance_m);
  CaveFacts c;
  c.figures = selection::describe(space);
  c.passages = selection::passage_facts(rock.scene, own);
  c.start = start;
  c.start_clearance_m = rock.scene.distance_to_rock(start, 100);
  c.explorable_m3 = reachable(std::nullopt).volume_m3();
  c.reachable_m3 = own.volume_m3();
  c.hull_reachable_m3 = hull_clearance_m < vehicle.clearance_m
                            ? std::max(c.reachable_m3, reachable(hull_clearance_m).volume_m3())
                            : c.reachable_m3;
  c.blind_climb_fraction = far.blind_fraction;
  c.blind_climb = far.blind_climb;
  c.holes = holes_of(rock.scene, start);
  c.plan = plan_view(own.reachable, own.options.resolution_m, start);
  return c;
}

/// The hovering time of a full battery, which vehicles state as an option of their own.
std::optional<double> battery_s(const Mission& m) {
  const std::string key = m.vehicle + ".battery_minutes";
  const auto text = m.resolved.get_optional<std::string>(key);
  if (!text) return std::nullopt;
  double s = 0;
  core::OptionTable table;
  table.add(key, s, "s", 0, 1e9, "");
  table.set(m.file, key, *text);
  return s;
}

TimeLimits time_limits(const Mission& m) {
  const core::MissionOptions& o = m.core.mission;
  TimeLimits l;
  l.battery_s = battery_s(m);
  l.max_flight_time_s = o.max_flight_time_s;
  l.home_margin = o.home_margin;
  l.home_reserve_s = o.home_reserve_s;
  l.decision_period_s = o.decision_period_s;
  l.takeoff_height_m = o.takeoff_height_m;
  l.landing_speed_mps = o.landing_speed_mps;
  l.motion = m.core.motion;
  return l;
}

std::optional<Experience> experience_of(const LookOptions& options) {
  std::vector<std::string> files = options.results;
  if (files.empty() && !selection::installed_experience().empty())
    files = {selection::installed_experience()};
  if (files.empty()) return std::nullopt;
  return selection::load_experience(files, options.tell);
}

void add_ranking(const Experience& e, const selection::Selected& s, PolicyFacts& f) {
  for (const selection::Expected& x : s.ranking) {
    const selection::Preset& preset = e.contestants[x.contestant];
    f.ranking.push_back({preset.name, x.value, x.low, x.high});
    const bool is_own = f.selected ? f.ranking.size() == 1 : preset.policy == f.policy;
    if (is_own && !f.own) f.own = f.ranking.size() - 1;
  }
  f.confidence = s.confidence;
  f.confidence_words = selection::confidence_in_words(e, s);
  double weight = 0;
  for (std::size_t site = 0; site < e.sites.size(); ++site)
    if (s.weights.level[site] > weight) {
      weight = s.weights.level[site];
      f.horizon_s = selection::horizon_s(e, site);
    }
}

selection::FlightTime flight_time(const TimeBudget& t) {
  return {t.endurance_s, t.turn_back_s, t.return_s,
          2 * t.limits.takeoff_height_m / t.limits.landing_speed_mps, t.limits.motion.max_speed_mps};
}

/// Figures of which the length of the flight decides are scaled to it; the others are means over the caves.
void add_expected(const Experience& e, const CaveFacts& cave, const TimeBudget& time,
                  const selection::Selected& s, PolicyFacts& f) {
  const std::size_t contestant = s.ranking[*f.own].contestant;
  const selection::Forecast forecast = selection::forecast(e, cave.figures, s, contestant, flight_time(time));
  const auto add = [&f](const std::string& name, double value) {
    if (std::isnan(value)) return;
    const int metric = evaluation::metric_index(name);
    const std::string_view unit =
        metric < 0 ? "" : evaluation::metric_definitions()[static_cast<std::size_t>(metric)].unit;
    f.expected.push_back({name, std::string(unit), value});
  };
  add("coverage", forecast.coverage);
  add("explored_volume_m3", forecast.coverage * cave.explorable_m3);
  add("flight_time_s", forecast.flight_s);
  add("path_length_m", forecast.path_m);
  add("energy_wh", forecast.energy_wh);
  const std::vector<double> means = selection::expected_figures(e, cave.figures, s, contestant);
  for (std::size_t i = 0; i < means.size(); ++i)
    for (const char* name : {"completed", "contacts"})
      if (e.metrics[i] == name) add(name, means[i]);
}

/// Refused without enough experience, with the reason.
selection::Selected selected_for(const std::optional<Experience>& e, const Mission& m,
                                 const LookOptions& options, const selection::CaveFigures& figures,
                                 const std::string& mesh_hash) {
  selection::Selected none;
  none.refused = true;
  none.reason = "no experience is installed, and --results gives none";
  if (!e) return none;
  selection::SelectOptions select = options.select;
  select.conditions = flight::conditions_of(m);
  // What a flight of another length does is forecast below.
  if (!selection::why_other_conditions(*e, select.conditions).empty())
    select.conditions.endurance_s = selection::kUnknown;
  try {
    return selection::select(*e, figures, select, m.cave, mesh_hash);
  } catch (const InputError& error) {
    none.reason = error.what();
    return none;
  }
}

PolicyFacts policy_facts(const Mission& m, const LookOptions& options, const CaveFacts& cave,
                         const TimeBudget& time, const std::string& mesh_hash) {
  const std::optional<Experience> e = experience_of(options);
  const selection::Selected s = selected_for(e, m, options, cave.figures, mesh_hash);
  PolicyFacts f;
  f.fallback = is_auto(m) && s.refused;
  f.policy = f.fallback ? kFallbackPolicy : m.policy;
  f.selected = is_auto(m) && !s.refused;
  f.metric = options.select.metric;
  f.level = options.select.level;
  f.reason = s.reason;
  boost::property_tree::ptree parameters = m.policy_parameters;
  if (e && !s.refused) {
    if (f.selected) {
      const selection::Preset& first = e->contestants[s.ranking.front().contestant];
      f.policy = first.policy;
      for (const auto& [key, value] : first.parameters)  // the mission's own parameters take precedence
        if (parameters.count(key) == 0) parameters.push_back({key, value});
    }
    add_ranking(*e, s, f);
    if (f.own) add_expected(*e, cave, time, s, f);
  }
  for (const auto& [key, value] : parameters) f.parameters.emplace_back(key, value.data());
  if (is_auto(m)) {
    Mission flown = m;
    flown.policy = f.policy;
    const boost::property_tree::ptree unselected = parameters_in_force(flown, options);
    flown.policy_parameters = parameters;
    parameters_in_force(flown, options);  // throws what is wrong
    for (const auto& [key, value] : f.parameters)
      if (unselected.get<std::string>(key, "") != value) f.changed.emplace_back(key, value);
  }
  return f;
}

/// Throws what keeps the mission from being judged at all.
void refuse_unclear(const Mission& m) {
  if (flight::is_team(m))
    throw InputError(m.file, "team.robots", "a preflight is for one vehicle, not for a team");
  if (!m.auto_policy.empty())
    throw InputError(m.file, "policy.auto", "has no effect here: the cave itself is what is known of it");
  if (m.start.empty() && !cave::has_start(m.cave))
    flight::check_cave(m.cave, m.start, m.mesh);  // throws, with a start that suits
}

}  // namespace

Preflight look_at(const Mission& m, const LookOptions& options) {
  refuse_unclear(m);
  if (!is_auto(m)) parameters_in_force(m, options);  // throws what is wrong
  const cave::Cave rock = cave::load_cave(m.cave, m.start, m.mesh);
  Preflight p;
  p.cave_file = m.cave;
  options.tell("checking the cave");
  try {
    p.mesh_notes = flight::check_cave(m.cave, m.start, m.mesh);
  } catch (const InputError& e) {
    p.refusals.push_back({Subject::cave, e.what()});
    return p;
  }
  const std::optional<core::VehicleDescription> vehicle = vehicle_of(m, p);
  if (!vehicle) return p;
  p.vehicle = facts_of(*vehicle, m.core);
  options.tell("describing the cave");
  const core::Vec3& start = rock.description.start.position;
  const selection::FreeSpace space = selection::free_space_of(rock.scene, start, {}, m.cave);
  const FarPlaces far = far_places(space, start, core::steepest_view(*vehicle));
  p.time = time_budget(time_limits(m), far.farthest_m);
  try {
    p.cave = cave_facts(rock, space, *p.vehicle, vehicle->radius_m + m.core.map.resolution_m / 2, far);
  } catch (const InputError& e) {
    p.refusals.push_back({Subject::passages, e.what()});
    return p;
  }
  options.tell("choosing the policy");
  p.policy = policy_facts(m, options, *p.cave, *p.time, campaign::mesh_hash(cave::mesh_of(rock.description)));
  return p;
}

}  // namespace karst::preflight
