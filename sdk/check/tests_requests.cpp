// requests: everything the host may ask, including requests that are unlikely in flight.
#include <limits>

#include "sdk/check/flight.h"
#include "sdk/check/tests.h"

namespace karst::check {
namespace {

using Of = Test::Of;

const CaveShape kSmall{.volume_m3 = 120, .radius_m = 1.6, .branches = 2, .resolution_m = 0.2};

/// Asks several times, each time after applying `change(request, i)`.
template <class Change>
void ask_changed(Context& c, Flight& flight, int count, Change&& change) {
  const auto session = new_session(c);
  const auto object = started(c, *session);
  for (int i = 0; i < count; ++i) {
    flight.request();
    change(flight.edit(), i);
    const Answer answer = object->decide(flight.edit());
    require(answer.failure);
    for (const karst_event_t& e : flight.react(answer)) require(object->event(e));
  }
}

void no_frontier(Context& c) {
  Flight flight(c.seed, kSmall);
  ask_changed(c, flight, 20, [](core::DecisionRequest& r, int) { r.frontiers.clear(); });
}

void one_frontier(Context& c) {
  Flight flight(c.seed, kSmall);
  ask_changed(c, flight, 10, [](core::DecisionRequest& r, int i) {
    if (r.frontiers.empty()) return;
    r.frontiers = {r.frontiers[static_cast<std::size_t>(i) % r.frontiers.size()]};
  });
}

void thousands(Context& c) {
  constexpr std::uint32_t count = 5000;
  Flight flight(c.seed, kSmall, 1.0);
  std::vector<core::Vec3> free;
  flight.cave().map().for_each_known([&](const core::CellKey& k, core::Cell cell, float) {
    if (cell == core::Cell::free) free.push_back(flight.cave().map().center_of(k));
  });
  std::vector<core::FrontierCluster> clusters(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    core::FrontierCluster& f = clusters[i];
    f.id = i + 1;
    f.cells.resize(8 + i % 40);
    f.centroid = f.low = f.high = free[(i * 7919u) % free.size()];
    f.normal = core::Vec3::UnitX();
    f.unknown_cells = i % 100;
    f.free_cells = i % 300;
  }
  ask_changed(c, flight, 3, [&](core::DecisionRequest& r, int) {
    r.frontiers.clear();
    for (const core::FrontierCluster& f : clusters)
      r.frontiers.push_back({&f, f.centroid, 0.1 * f.id, (f.centroid - r.state.position).norm()});
  });
  c.figures["frontiers"] = count;
}

void empty_map(Context& c) {
  const core::VoxelMap nothing(core::MapOptions{});
  const core::Roadmap nowhere{core::PlanningOptions{}};
  Flight flight(c.seed, kSmall);
  ask_changed(c, flight, 10, [&](core::DecisionRequest& r, int) {
    r.map = &nothing;
    r.roadmap = &nowhere;
    r.frontiers.clear();
  });
}

/// Valid, but at the limits of the ABI: finite where the ABI requires finite values, infinite or NaN where it
/// allows them.
void extremes(Context& c) {
  constexpr double inf = std::numeric_limits<double>::infinity(),
                   nan = std::numeric_limits<double>::quiet_NaN();
  Flight flight(c.seed, kSmall);
  core::VehicleDescription blind;
  core::FrontierCluster far, speck;
  far.id = 0xfffffffeu;
  far.centroid = far.low = far.high = {6000, -6000, 300};
  far.normal = {0, 0, 1};
  speck.id = 0xffffffffu;
  speck.cells.resize(1);
  const std::vector<std::function<void(core::DecisionRequest&)>> changes = {
      [](core::DecisionRequest& r) { r.seconds_before_homing = 0; },
      [](core::DecisionRequest& r) { r.seconds_before_homing = -1e6; },
      [](core::DecisionRequest& r) { r.seconds_before_homing = inf; },
      [](core::DecisionRequest& r) { r.battery_fraction = r.battery_seconds_left = 0; },
      [](core::DecisionRequest& r) { r.mission_seconds_left = -1e6; },
      [](core::DecisionRequest& r) { r.mission_seconds_left = inf; },
      [](core::DecisionRequest& r) { r.max_speed_mps = 1e-6; },
      [](core::DecisionRequest& r) {
        r.max_speed_mps = 1e3;
        r.clearance_m = 50;
      },
      [](core::DecisionRequest& r) {
        r.clearance_m = 0;
        r.vehicle_radius_m = 0;
      },
      [](core::DecisionRequest& r) {
        r.state.position = {6500, -6500, 6500};
      },
      [](core::DecisionRequest& r) {
        r.state.velocity_mps = {300, 0, -300};
        r.state.body_rate_radps = {50, 50, 50};
      },
      [](core::DecisionRequest& r) {
        r.direction_of_flight = {0, 0, 1};
      },
      [](core::DecisionRequest& r) {
        r.direction_of_flight = {0, 0, -1};
      },
      [](core::DecisionRequest& r) {
        r.T_world_start.position = {-6500, 6500, 0};
      },
      [](core::DecisionRequest& r) {
        r.last_goal = {6500, 6500, 6500};
        r.last_fate = core::GoalFate::rejected;
      },
      [](core::DecisionRequest& r) { r.deadline = r.stamp; },
      [](core::DecisionRequest& r) { r.sequence = 0xfffffff0u; },
      [](core::DecisionRequest& r) { r.stamp = r.deadline = std::int64_t{1} << 60; },
      [&](core::DecisionRequest& r) { r.vehicle = &blind; },
      [&](core::DecisionRequest& r) {
        r.vehicle = &flight.vehicle();
        r.frontiers = {{&far, far.centroid, 3.0, 1e6}, {&speck, core::Vec3::Constant(nan), 0, inf}};
      },
      [&](core::DecisionRequest& r) {
        r.frontiers = {{&speck, speck.centroid, -1e3, 0.0}};
      },
      [&](core::DecisionRequest& r) {
        for (core::FrontierOffer& f : r.frontiers) f.path_length_m = inf;
      },
      [&](core::DecisionRequest& r) {
        r.teammates = {{1, -r.stamp, r.state.position, {0, 0, 0}, {}, 0},
                       {2, r.stamp, core::Vec3::Constant(6500), {40, 0, 0}, core::Vec3::Constant(nan), nan}};
      },
  };
  ask_changed(c, flight, static_cast<int>(changes.size()),
              [&](core::DecisionRequest& r, int i) { changes[static_cast<std::size_t>(i)](r); });
  c.figures["kinds"] = changes.size();
}

void fuzzed(Context& c) {
  const int flights = c.level == Level::basic ? 3 : 6;
  core::Random random = core::Random::stream(c.seed, "fuzzed requests");
  int asked = 0;
  for (int i = 0; i < flights; ++i) {
    Flight flight(random.bits(), any_shape(random), random.uniform());
    ask_changed(c, flight, 12, [&](core::DecisionRequest& r, int) {
      ++asked;
      if (random.uniform() < 0.1)
        r.frontiers.resize(static_cast<std::size_t>(random.uniform() * 3) % (r.frontiers.size() + 1));
      if (random.uniform() < 0.1) r.seconds_before_homing = random.uniform(-100, 100);
      if (random.uniform() < 0.1) r.state.velocity_mps = {random.normal(), random.normal(), random.normal()};
      if (random.uniform() < 0.1) r.clearance_m = random.uniform(0.3, 2);
      if (random.uniform() < 0.1)
        r.last_fate = static_cast<core::GoalFate>(static_cast<int>(random.uniform() * 7));
    });
  }
  c.figures["requests"] = asked;
}

}  // namespace

std::vector<Test> request_tests() {
  return {
      {"requests.no_frontier", Level::basic, Of::policy,
       "Asked again and again without a frontier it answers.", no_frontier},
      {"requests.one_frontier", Level::basic, Of::policy, "Offered a single frontier it answers.",
       one_frontier},
      {"requests.thousands", Level::basic, Of::policy, "Offered 5000 frontiers it answers.", thousands},
      {"requests.empty_map", Level::basic, Of::policy, "With nothing known at all it answers.", empty_map},
      {"requests.extremes", Level::basic, Of::policy,
       "Numbers at the ends of what the ABI allows do not make it fail: no time left, no sensor, kilometres "
       "away.",
       extremes},
      {"requests.fuzzed", Level::basic, Of::policy,
       "In caves and flights drawn by chance from the seed, no decision and no event makes it fail.", fuzzed},
  };
}

}  // namespace karst::check
