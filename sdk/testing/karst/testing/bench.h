// A test bench for a policy: calls it through its C tables, as the host does, with requests from the test.
//
//   Bench bench(karst_plugin_entry(), map, {{"min_cells", "4"}});
//   bench.position = map.place('a');
//   bench.offer(1, map.place('b'), map.place('c'));
//   const karst::Decision d = bench.decide();
//
// The test is linked with the policy's own source, which defines karst_plugin_entry. Any test framework can
// be used.
#pragma once
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <karst/testing/drawn_frontiers.h>
#include <karst/testing/drawn_host.h>
#include <karst/testing/sensors.h>

namespace karst::testing {

class Bench {
 public:
  using Values = std::vector<std::pair<std::string, std::string>>;  // in SI units, without the unit

  Bench(const karst_plugin_t* plugin, DrawnMap map, Values values = {}, std::uint32_t index = 0)
      : host_(std::move(map)), policy_(plugin->policy(index)), values_(std::move(values)) {
    if (policy_ == nullptr) throw Error("the plugin has no such policy");
    create({});
  }
  ~Bench() { end(); }
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  // The content of the next request; change it as the test needs. World frame, metres, radians, seconds.
  Vec3 position;
  Vec3 start;  // position of T_world_start
  Vec3 direction_of_flight{1, 0, 0};
  double heading_rad = 0;
  double time_s = 0, seconds_before_homing = 600;
  double battery_fraction = 0.8, battery_seconds_left = 1200, mission_seconds_left = 3600;
  karst_goal_fate_t last_fate = KARST_FATE_NONE;
  Vec3 last_goal;
  std::vector<Sensor> sensors{lidar()};
  std::vector<Frontier> frontiers;
  std::vector<Teammate> teammates;
  std::optional<DrawnSurvey> survey;  // of the mission

  const DrawnHost& host() const { return host_; }

  /// Adds a frontier (world, m). Its path is measured in the map, its cells are counted in a 4 m cube.
  Frontier& offer(std::uint32_t id, const Vec3& viewpoint, const Vec3& centroid, std::uint32_t cells = 20) {
    Frontier f;
    f.id = id;
    f.cells = cells;
    f.centroid = f.low = f.high = centroid;
    f.viewpoint = viewpoint;
    f.path_length_m = host_.map().path_length_m(position, viewpoint);
    const Box box = box_around(centroid, 2.0);
    const karst_box_t in{box.low, box.high};
    karst_cell_counts_t counts{};
    host_.host()->map->count_in_boxes(host_.host(), host_.map_handle(), &in, 1, &counts, nullptr);
    f.unknown_cells = static_cast<std::uint32_t>(counts.unknown);
    f.free_cells = static_cast<std::uint32_t>(counts.free);
    frontiers.push_back(f);
    return frontiers.back();
  }

  /// Replaces the offered frontiers by those of the drawing; ids from 1.
  void offer_drawn(std::uint32_t min_cells = 1) {
    frontiers.clear();
    for (const Frontier& f : find_frontiers(host_.map(), position, min_cells)) {
      Frontier& mine = offer(f.id, f.viewpoint, f.centroid, f.cells);
      mine.low = f.low;
      mine.high = f.high;
      mine.normal = f.normal;
      mine.viewpoint_heading_rad = f.viewpoint_heading_rad;
    }
  }

  /// The first goal of the last answer is reached: moves the vehicle there, notifies the policy and measures
  /// all paths from there.
  void arrive() {
    const Goal goal = first_goal();
    position = goal.position;
    close_goal(KARST_EVENT_GOAL_REACHED, KARST_FATE_REACHED, goal, "reached");
    for (Frontier& f : frontiers) f.path_length_m = host_.map().path_length_m(position, f.viewpoint);
  }
  /// That goal failed. `kind`: KARST_EVENT_GOAL_REJECTED, _UNREACHABLE, _ABANDONED or _SUPERSEDED.
  void fail(karst_event_kind_t kind, const std::string& reason = "as the test wants it") {
    const karst_goal_fate_t fate = kind == KARST_EVENT_GOAL_REJECTED      ? KARST_FATE_REJECTED
                                   : kind == KARST_EVENT_GOAL_UNREACHABLE ? KARST_FATE_UNREACHABLE
                                   : kind == KARST_EVENT_GOAL_ABANDONED   ? KARST_FATE_ABANDONED
                                                                          : KARST_FATE_SUPERSEDED;
    close_goal(kind, fate, first_goal(), reason);
  }

  /// Requests one decision. Throws Error if the policy fails.
  Decision decide() {
    std::vector<karst_frontier_cluster_t> clusters;
    for (const Frontier& f : frontiers) clusters.push_back(to_abi(f));
    host_.now_ns = static_cast<std::int64_t>(time_s * 1e9);
    host_.start = start;
    host_.survey = survey;
    karst_request_t r{};
    r.size = sizeof r;
    r.sequence = ++sequence_;
    r.stamp_ns = r.deadline_ns = r.state.stamp_ns = host_.now_ns;
    r.state.position = position;
    r.state.orientation = {std::cos(heading_rad / 2), 0, 0, std::sin(heading_rad / 2)};
    r.T_world_start.position = start;
    r.T_world_start.orientation.w = 1;
    r.direction_of_flight = direction_of_flight;
    r.seconds_before_homing = seconds_before_homing;
    r.battery_fraction = battery_fraction;
    r.battery_seconds_left = battery_seconds_left;
    r.mission_seconds_left = mission_seconds_left;
    r.max_speed_mps = host_.max_speed_mps;
    r.clearance_m = 0.5;
    r.vehicle_radius_m = 0.3;
    r.last_goal = last_goal;
    r.last_fate = last_fate;
    r.sensor_count = static_cast<std::uint32_t>(sensors.size());
    r.sensors = sensors.data();
    r.map = host_.map_handle();
    r.frontiers = clusters.data();
    r.frontier_count = clusters.size();
    r.teammates = teammates.data();
    r.teammate_count = teammates.size();
    Decision answer;
    karst_decision_sink_t sink{sizeof(karst_decision_sink_t), max_goals, &answer, &add_goals, &set_outcome};
    karst_error_t e{};
    check(policy_->decide(self_, &r, &sink, &e), e);
    last_answer_ = answer;
    return answer;
  }

  /// The policy's saved state, through the extension "karst.state/1". Throws Error if it offers none.
  std::vector<unsigned char> saved() {
    std::vector<unsigned char> bytes;
    const karst_state_sink_t sink{sizeof(karst_state_sink_t), 0, 16u << 20, &bytes, &keep};
    karst_error_t e{};
    check(state().save(self_, &sink, &e), e);
    return bytes;
  }
  /// As after a crash: replaces the policy by a new object with the same parameters, and restores its state
  /// from `bytes` unless they are empty.
  void restart(const std::vector<unsigned char>& bytes) {
    end();
    create(bytes);
  }

  void tell(karst_event_kind_t kind, const Goal& goal, const std::string& reason = "") {
    karst_event_t event{sizeof(karst_event_t), kind, static_cast<std::int64_t>(time_s * 1e9), to_abi(goal),
                        to_abi(reason)};
    karst_error_t e{};
    check(policy_->on_event(self_, &event, &e), e);
  }

 private:
  Goal first_goal() const {
    if (last_answer_.goals.empty()) throw Error("the last answer had no goal");
    return last_answer_.goals.front();
  }
  void close_goal(karst_event_kind_t kind, karst_goal_fate_t fate, const Goal& goal,
                  const std::string& reason) {
    last_goal = goal.position;
    last_fate = fate;
    tell(kind, goal, reason);
  }
  void create(const std::vector<unsigned char>& bytes) {
    karst_error_t e{};
    self_ = policy_->create(host_.host(), &e);
    if (self_ == nullptr) throw Error(e.text, e.code);
    try {
      std::vector<karst_parameter_value_t> resolved = defaults();
      for (const auto& [id, text] : values_) set(resolved, id, text);
      check(policy_->init(self_, resolved.data(), resolved.size(), &e), e);
      if (!bytes.empty()) check(state().restore(self_, bytes.data(), bytes.size(), &e), e);
      check(policy_->activate(self_, &e), e);
      active_ = true;
    } catch (...) {
      end();
      throw;
    }
  }
  void end() {
    if (self_ == nullptr) return;
    if (active_) policy_->deactivate(self_);
    policy_->destroy(self_);
    self_ = nullptr;
    active_ = false;
  }
  const karst_state_extension_t& state() {
    const void* table = nullptr;
    if (KARST_HAS(karst_policy_t, policy_, extension))
      table = policy_->extension(self_, {KARST_STATE_EXTENSION, sizeof KARST_STATE_EXTENSION - 1});
    if (table == nullptr) throw Error("the policy does not offer " KARST_STATE_EXTENSION);
    return *static_cast<const karst_state_extension_t*>(table);
  }
  static std::int32_t keep(const karst_state_sink_t* sink, const void* bytes, std::uint64_t count,
                           karst_error_t*) noexcept {
    const auto* from = static_cast<const unsigned char*>(bytes);
    auto& to = *static_cast<std::vector<unsigned char>*>(sink->context);
    to.insert(to.end(), from, from + count);
    return KARST_OK;
  }
  static constexpr std::uint32_t max_goals = 64;  // as the host
  static std::int32_t add_goals(const karst_decision_sink_t* sink, const karst_goal_t* goals,
                                std::uint64_t count, karst_error_t* error) noexcept {
    std::vector<Goal>& all = static_cast<Decision*>(sink->context)->goals;
    if (count > max_goals || all.size() + count > max_goals)
      return refuse(error, KARST_ERROR_LIMIT, "more goals than the host accepts in one decision");
    for (std::uint64_t i = 0; i < count; ++i) all.push_back(from_abi(goals[i]));
    return KARST_OK;
  }
  static std::int32_t set_outcome(const karst_decision_sink_t* sink, karst_outcome_t outcome,
                                  std::uint32_t flags, karst_text_t reason, karst_error_t*) noexcept {
    Decision& d = *static_cast<Decision*>(sink->context);
    d.outcome = outcome;
    d.in_order = (flags & KARST_DECISION_TOUR) != 0;
    d.reason = from_abi(reason);
    return KARST_OK;
  }

  std::vector<karst_parameter_value_t> defaults() const {
    std::vector<karst_parameter_value_t> out;
    const karst_policy_descriptor_t& d = *policy_->descriptor;
    for (std::uint32_t i = 0; i < d.parameter_count; ++i) {
      const karst_parameter_t& p = d.parameters[i];
      out.push_back({p.id, p.default_text, p.default_number, p.type, 0});
    }
    return out;
  }
  static void set(std::vector<karst_parameter_value_t>& all, const std::string& id, const std::string& text) {
    for (karst_parameter_value_t& v : all) {
      if (from_abi(v.id) != id) continue;
      if (v.type == KARST_PARAMETER_TEXT)
        v.text = to_abi(text);
      else
        v.number = text == "true" ? 1.0 : text == "false" ? 0.0 : std::strtod(text.c_str(), nullptr);
      return;
    }
    throw Error("the policy declares no parameter " + id);
  }

  DrawnHost host_;
  const karst_policy_t* policy_;
  Values values_;
  Decision last_answer_;
  void* self_ = nullptr;
  bool active_ = false;
  std::uint32_t sequence_ = 0;
};

}  // namespace karst::testing
