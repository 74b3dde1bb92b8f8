#include "tests/robustness/trial.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "core_stack/common/random.h"
#include "plugins/simulator/cave_generator/recipe.h"

namespace karst::robustness {
namespace {

using core::Random;

constexpr double kSharedCaves = 0.2;  // their share of the trials
constexpr int kCaveSeeds = 20;        // generated caves of a kind

template <class List>
const auto& one_of(Random& r, const List& list) {
  return list[r.bits() % list.size()];
}

double log_uniform(Random& r, double low, double high) { return low * std::pow(high / low, r.uniform()); }

/// One of the sensors that the vehicle locates itself or sees by, and what becomes of its messages.
std::string draw_sensor_gap(Random& r, const std::string& vehicle) {
  static const std::vector<std::string> lidar{"lidar lost",         "lidar lost",       "lidar nan",
                                              "lidar three_points", "lidar stamp_back", "lidar stamp_ahead",
                                              "magnetometer lost",  "barometer lost"},
      camera{"pose lost", "camera lost", "barometer lost"};
  if (vehicle == "camera_uav") return one_of(r, camera);
  const bool looks_up = vehicle == "lidar_uav" && r.uniform() < 0.15;
  return looks_up ? "camera lost" : one_of(r, lidar);
}

void draw_fault(Random& r, Trial& t) {
  t.fault_at_s = r.uniform(3, 0.8 * t.flight_s);
  switch (t.fault) {
    case Fault::sensor_gap:
      t.what = draw_sensor_gap(r, t.vehicle);
      t.fault_for_s = log_uniform(r, 0.2, 15);
      break;
    case Fault::imu_dropout:
      t.what = "imu lost";
      t.fault_for_s = log_uniform(r, 0.02, 1);
      break;
    case Fault::weak_motor:
      t.motor = 1 + static_cast<int>(r.bits() % 4);
      break;
    case Fault::policy_crash:
      t.own_process = r.uniform() < 0.5;
      t.what = t.own_process ? "crashes" : "throws";  // a signal in process is the vehicle's end
      break;
    case Fault::policy_hang:
      t.own_process = r.uniform() < 0.5;
      t.what = r.uniform() < 0.5 ? "spins" : "sleeps";
      break;
    case Fault::radio_silence:
      t.robots = r.uniform() < 0.7 ? 2 : 3;
      t.fault_for_s = log_uniform(r, 5, 200);
      break;
    case Fault::disk_full:
      t.disk_bytes = static_cast<int>(log_uniform(r, 2e4, 1e6));
      break;
    case Fault::none:
    case Fault::rockfall:
    case Fault::sigterm:
      break;
  }
}

CaveChoice draw_cave(Random& r, const std::vector<CaveChoice>& caves) {
  std::vector<CaveChoice> generated, shared;
  for (const CaveChoice& c : caves) (c.mesh.empty() ? generated : shared).push_back(c);
  const bool a_shared_one = r.uniform() < kSharedCaves && !shared.empty();
  return one_of(r, a_shared_one ? shared : generated);
}

}  // namespace

const char* name_of(Fault fault) {
  constexpr std::array kNames{"none",         "sensor_gap",  "imu_dropout",   "weak_motor", "rockfall",
                              "policy_crash", "policy_hang", "radio_silence", "sigterm",    "disk_full"};
  return kNames[static_cast<std::size_t>(fault)];
}

std::vector<CaveChoice> cave_choices(const std::string& shared_caves) {
  std::vector<CaveChoice> choices;
  for (const std::string& preset : cave::cave_presets()) choices.push_back({preset, "", ""});
  // Places in the air of their first chambers.
  static const std::vector<CaveChoice> kShared{{"rough_tunnel", "rough_tunnel.stl", "11.1 -0.5 2.1"},
                                               {"indian_tunnel", "indian_tunnel.stl", "-2.2 87.5 -5.8"},
                                               {"jean_bernard", "jean_bernard.ply", "97.5 51.8 108.8"},
                                               {"darpa_cave_01", "darpa_cave_01.ply", "14.0 0.1 1.3"},
                                               {"darpa_cave_02", "darpa_cave_02.ply", "16.0 -0.1 1.4"}};
  for (const CaveChoice& c : kShared) {
    const auto mesh = std::filesystem::path(shared_caves) / c.mesh;
    if (!shared_caves.empty() && std::filesystem::exists(mesh))
      choices.push_back({c.kind, mesh.string(), c.start});
  }
  return choices;
}

std::string Trial::cave_name() const {
  return cave.mesh.empty() ? cave.kind + "-" + std::to_string(cave_seed) : cave.kind;
}

std::string Trial::fault_text() const {
  char text[120];
  const char* detail = what.c_str();
  switch (fault) {
    case Fault::none:
      return "none";
    case Fault::sensor_gap:
    case Fault::imu_dropout:
      std::snprintf(text, sizeof text, "%s at %.1f s for %.2f s", detail, fault_at_s, fault_for_s);
      break;
    case Fault::weak_motor:
      std::snprintf(text, sizeof text, "motor %d at 90 %% from %.1f s on", motor, fault_at_s);
      break;
    case Fault::rockfall:
      return "a boulder falls before the vehicle";
    case Fault::policy_crash:
    case Fault::policy_hang:
      std::snprintf(text, sizeof text, "policy %s %s from %.1f s on",
                    own_process ? "of a process" : "in process", detail, fault_at_s);
      break;
    case Fault::radio_silence:
      std::snprintf(text, sizeof text, "%d robots, radio silent at %.1f s for %.1f s", robots, fault_at_s,
                    fault_for_s);
      break;
    case Fault::sigterm:
      std::snprintf(text, sizeof text, "SIGTERM at %.1f s", fault_at_s);
      break;
    case Fault::disk_full:
      std::snprintf(text, sizeof text, "no file may exceed %d bytes", disk_bytes);
      break;
  }
  return text;
}

Trial draw_trial(int number, const std::vector<CaveChoice>& caves) {
  static const std::vector<std::string> policies{"nearest_frontier", "lateral_frontier", "highest_frontier",
                                                 "unknown_ratio",    "information_gain", "viewpoint_tour",
                                                 "deep_cave",        "surface_coverage"},
      // Most carry a LiDAR and fly by LOAM; camera_uav has only its pose sensor.
      vehicles{"lidar_uav", "lidar_uav", "lidar_uav", "lidar_only_uav", "camera_uav"};
  Random r = Random::stream(static_cast<std::uint64_t>(number), "trial of faults");
  Trial t;
  t.number = number;
  t.fault = kFaults[static_cast<std::size_t>(number) % kFaults.size()];
  t.cave = draw_cave(r, caves);
  t.cave_seed = 1 + static_cast<int>(r.bits() % kCaveSeeds);
  Random of_cave = Random::stream(static_cast<std::uint64_t>(t.cave_seed), "volume of " + t.cave.kind);
  t.cave_volume_m3 = std::round(log_uniform(of_cave, 800, 2500));
  t.policy = one_of(r, policies);
  t.vehicle = one_of(r, vehicles);
  t.flight_s = std::round(r.uniform(30, 90));
  if (r.uniform() < 0.5) t.haze_1pm = log_uniform(r, 0.005, 0.1);
  if (r.uniform() < 0.5) t.stirred_1pm = log_uniform(r, 0.05, 0.5);
  draw_fault(r, t);
  if (!t.cave.mesh.empty())
    t.robots = std::min(t.robots, 2);  // around some of their starts there is no more room
  return t;
}

}  // namespace karst::robustness
