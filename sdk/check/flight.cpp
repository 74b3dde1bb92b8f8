#include "sdk/check/flight.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sdk/host/boundary/text.h"
#include "sdk/host/services/snapshot.h"

namespace karst::check {
namespace {

using core::GoalFate;
using core::Vec3;

core::VehicleDescription a_vehicle() {
  core::VehicleDescription v;
  core::LidarModel lidar;
  lidar.name = "lidar";
  lidar.columns = 64;
  lidar.elevation_rad = {0.4f, 0.2f, 0.0f, -0.2f, -0.4f};
  lidar.max_range_m = 20.0f;
  v.lidar = std::make_shared<core::LidarModel>(lidar);
  core::CameraModel camera;
  camera.name = "down";
  camera.width = 80;
  camera.height = 60;
  camera.horizontal_fov_rad = 1.4;
  camera.vertical_fov_rad = 1.1;
  camera.T_body_camera.orientation = core::Quat(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitY()));
  v.cameras.push_back(std::make_shared<core::CameraModel>(camera));
  return v;
}

struct Happening {
  karst_event_kind_t kind;
  GoalFate fate;
  const char* reason;
};
/// An entry that occurs n times is n times as likely.
constexpr Happening kHappenings[] = {
    {KARST_EVENT_GOAL_REACHED, GoalFate::reached, "reached"},
    {KARST_EVENT_GOAL_REACHED, GoalFate::reached, "reached"},
    {KARST_EVENT_GOAL_REACHED, GoalFate::reached, "reached"},
    {0, GoalFate::under_way, ""},
    {KARST_EVENT_GOAL_SUPERSEDED, GoalFate::superseded, "the policy chose another"},
    {KARST_EVENT_GOAL_REJECTED, GoalFate::rejected, "it is too near to rock or unknown space"},
    {KARST_EVENT_GOAL_UNREACHABLE, GoalFate::unreachable, "no path is left"},
    {KARST_EVENT_GOAL_ABANDONED, GoalFate::abandoned, "no progress"},
};

}  // namespace

Flight::Flight(std::uint64_t seed, const CaveShape& shape, double known_fraction)
    : random_(core::Random::stream(seed, "flight of a check")),
      cave_(seed, shape),
      known_m_(known_fraction * cave_.length_m()),
      vehicle_(a_vehicle()) {
  cave_.reveal(known_m_);
  core::DecisionRequest& r = request_;
  r.state.position = cave_.start();
  r.stamp = 10 * core::kSecond;
  r.T_world_start.position = cave_.start();
  r.seconds_before_homing = 600;
  r.battery_fraction = 0.8;
  r.battery_seconds_left = 1200;
  r.mission_seconds_left = 3600;
  r.max_speed_mps = 2;
  r.clearance_m = cave_.clearance_m();
  r.vehicle_radius_m = vehicle_.radius_m;
  r.map = &cave_.map();
  r.roadmap = &cave_.roadmap();
  r.vehicle = &vehicle_;
}

const core::DecisionRequest& Flight::request() {
  core::DecisionRequest& r = request_;
  ++r.sequence;
  r.deadline = r.stamp + 300 * core::kMillisecond;
  r.state.stamp = r.deadline;
  r.frontiers = cave_.offers(vehicle_, r.state.position);
  return r;
}

void Flight::fly_to(const Vec3& place) {
  const Vec3 offset = place - request_.state.position;
  if (offset.norm() > 1e-6) request_.direction_of_flight = offset.normalized();
  request_.state.position = place;
  if (!map_grows) return;
  known_m_ += random_.uniform(0, 0.04) * cave_.length_m();  // the cave is never fully known within a test
  cave_.reveal(known_m_);
}

karst_event_t Flight::event_of(const core::Goal& g) {
  karst_event_t e{};
  e.size = sizeof e;
  e.stamp_ns = request_.stamp;
  texts_.push_back(g.why);
  e.goal = {
      host::to_abi(g.position), g.heading_rad, g.tolerance_m, g.max_speed_mps, g.frontier_id, 0, g.score, {}};
  return e;
}

std::vector<karst_event_t> Flight::react(const Answer& answer) {
  texts_.clear();
  texts_.reserve(host::kMaxGoals + 1);  // events hold views of them
  std::vector<karst_event_t> events;
  const core::TimeNs pause = core::from_seconds(random_.uniform(0.5, 5));
  request_.stamp += pause;
  request_.seconds_before_homing -= core::seconds(pause);
  request_.battery_seconds_left -= core::seconds(pause);
  request_.mission_seconds_left -= core::seconds(pause);
  const core::Decision d = answer.good() ? answer.box.decision() : core::Decision{};
  if (d.goals.empty()) {  // it looks around while it waits
    fly_to(cave_.map().at(cave_.front()) == core::Cell::free ? cave_.front() : request_.state.position);
    return events;
  }
  const auto chance = static_cast<std::size_t>(random_.uniform() * std::size(kHappenings));
  const Happening& h = kHappenings[chance];
  const core::Goal& goal = d.goals.front();
  request_.last_goal = goal.position;
  request_.last_fate = h.fate;
  if (h.kind != 0) {
    events.push_back(event_of(goal));
    events.back().kind = h.kind;
    events.back().reason = host::view_of(h.reason);
    events.back().goal.why = host::view_of(texts_.back());
  }
  if (h.fate == GoalFate::reached && cave_.map().at(goal.position) == core::Cell::free) fly_to(goal.position);
  return events;
}

CaveShape any_shape(core::Random& random) {
  CaveShape s;
  s.radius_m = random.uniform(0.9, 2.2);
  s.volume_m3 = random.uniform(60, 500);
  s.branches = static_cast<int>(random.uniform(0, 6));
  s.resolution_m = random.uniform() < 0.5 ? 0.2 : 0.3;
  return s;
}

std::vector<Answer> fly(Object& object, Flight& flight, int count) {
  std::vector<Answer> answers;
  for (int i = 0; i < count; ++i) {
    answers.push_back(object.decide(flight.request()));
    require(answers.back().failure);
    for (const karst_event_t& e : flight.react(answers.back())) require(object.event(e));
  }
  return answers;
}

std::string text_of(const std::vector<Answer>& answers) {
  std::string out;
  for (std::size_t i = 0; i < answers.size(); ++i)
    out += "request " + std::to_string(i + 1) + "\n" + answers[i].text();
  return out;
}

}  // namespace karst::check
