// The test bench in C, over the one in C++. Compiled with each test that links karst::testing_c.
#include <karst/testing/bench_c.h>

#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <karst/policy.h>
#include <karst/testing/bench.h>

struct karst_bench {
  karst::testing::Bench bench;
  karst::Decision answer{0, false, {}, ""};
};

namespace {

using karst::border::guarded;
using karst::testing::Bench;
using karst::testing::DrawnMap;

/// Rows up to an empty line are a layer.
std::vector<std::string> layers_of(const char* drawing) {
  std::vector<std::string> layers;
  std::istringstream in(drawing);
  bool in_layer = false;
  for (std::string row; std::getline(in, row);) {
    const bool is_empty = row.find_first_not_of(" \t\r") == std::string::npos;
    if (!is_empty && !in_layer) layers.emplace_back();
    if (!is_empty) layers.back() += row + "\n";
    in_layer = !is_empty;
  }
  return layers;
}

Bench::Values values_of(const char* parameters) {
  Bench::Values values;
  std::istringstream in(parameters == nullptr ? "" : parameters);
  for (std::string word; in >> word;) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) throw karst::Error("expected id=value, got \"" + word + "\"");
    values.emplace_back(word.substr(0, equals), word.substr(equals + 1));
  }
  return values;
}

}  // namespace

karst_bench_t* karst_bench_create(const karst_plugin_t* plugin, const char* drawing, double resolution_m,
                                  const char* parameters, karst_error_t* error) noexcept {
  karst_bench_t* made = nullptr;
  guarded(error, [&] {
    if (!(resolution_m > 0)) throw karst::Error("the resolution is not greater than 0 m");
    made = new karst_bench_t{{plugin, DrawnMap(resolution_m, layers_of(drawing)), values_of(parameters)},
                             {0, false, {}, ""}};
  });
  return made;
}

void karst_bench_destroy(karst_bench_t* bench) noexcept { delete bench; }

karst_vec3_t karst_bench_place(const karst_bench_t* bench, char letter) noexcept {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  karst_vec3_t place{nan, nan, nan};
  guarded(nullptr, [&] { place = bench->bench.host().map().place(letter); });
  return place;
}

karst_bench_state_t karst_bench_get_state(const karst_bench_t* bench) noexcept {
  const Bench& b = bench->bench;
  return {b.position,
          b.start,
          b.direction_of_flight,
          b.heading_rad,
          b.time_s,
          b.seconds_before_homing,
          b.battery_fraction,
          b.battery_seconds_left,
          b.mission_seconds_left};
}

void karst_bench_set_state(karst_bench_t* bench, const karst_bench_state_t* state) noexcept {
  Bench& b = bench->bench;
  b.position = state->position;
  b.start = state->start;
  b.direction_of_flight = state->direction_of_flight;
  b.heading_rad = state->heading_rad;
  b.time_s = state->time_s;
  b.seconds_before_homing = state->seconds_before_homing;
  b.battery_fraction = state->battery_fraction;
  b.battery_seconds_left = state->battery_seconds_left;
  b.mission_seconds_left = state->mission_seconds_left;
}

void karst_bench_set_sensors(karst_bench_t* bench, const karst_sensor_t* sensors,
                             std::uint64_t count) noexcept {
  bench->bench.sensors.assign(sensors, sensors + count);
}

void karst_bench_offer(karst_bench_t* bench, std::uint32_t id, karst_vec3_t viewpoint, karst_vec3_t centroid,
                       std::uint32_t cells) noexcept {
  bench->bench.offer(id, viewpoint, centroid, cells);
}

void karst_bench_offer_drawn(karst_bench_t* bench, std::uint32_t min_cells) noexcept {
  bench->bench.offer_drawn(min_cells);
}

void karst_bench_clear_frontiers(karst_bench_t* bench) noexcept { bench->bench.frontiers.clear(); }

std::int32_t karst_bench_decide(karst_bench_t* bench, karst_error_t* error) noexcept {
  return guarded(error, [&] {
    bench->answer = {0, false, {}, ""};  // if it fails
    bench->answer = bench->bench.decide();
  });
}

karst_outcome_t karst_bench_outcome(const karst_bench_t* bench) noexcept { return bench->answer.outcome; }
int karst_bench_is_tour(const karst_bench_t* bench) noexcept { return bench->answer.in_order ? 1 : 0; }
const char* karst_bench_reason(const karst_bench_t* bench) noexcept { return bench->answer.reason.c_str(); }
std::uint64_t karst_bench_goal_count(const karst_bench_t* bench) noexcept {
  return bench->answer.goals.size();
}

karst_goal_t karst_bench_goal(const karst_bench_t* bench, std::uint64_t index) noexcept {
  const std::vector<karst::Goal>& goals = bench->answer.goals;
  return index < goals.size() ? karst::to_abi(goals[index]) : karst_goal_t{};
}

const char* karst_bench_why(const karst_bench_t* bench, std::uint64_t index) noexcept {
  const std::vector<karst::Goal>& goals = bench->answer.goals;
  return index < goals.size() ? goals[index].why.c_str() : "";
}

std::uint64_t karst_bench_log_count(const karst_bench_t* bench) noexcept {
  return bench->bench.host().log_lines.size();
}

const char* karst_bench_log(const karst_bench_t* bench, std::uint64_t index) noexcept {
  const std::vector<std::string>& lines = bench->bench.host().log_lines;
  return index < lines.size() ? lines[index].c_str() : "";
}

std::uint64_t karst_bench_drawing_count(const karst_bench_t* bench) noexcept {
  return bench->bench.host().drawings;
}

std::int32_t karst_bench_arrive(karst_bench_t* bench, karst_error_t* error) noexcept {
  return guarded(error, [&] { bench->bench.arrive(); });
}

std::int32_t karst_bench_fail(karst_bench_t* bench, karst_event_kind_t kind, const char* reason,
                              karst_error_t* error) noexcept {
  return guarded(error, [&] { bench->bench.fail(kind, reason == nullptr ? "" : reason); });
}
