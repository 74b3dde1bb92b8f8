// A room of 10 x 10 x 10 free cells of 1 m with walls, one window into the unknown, and a request in it.
#pragma once
#include <boost/property_tree/ptree.hpp>
#include <string>

#include "core_stack/mission/policy/policy_port.h"
#include "sdk/host/load_policy.h"

namespace karst::test {

struct Room {
  core::VoxelMap map{core::MapOptions{.resolution_m = 1.0}};
  core::Roadmap roadmap{core::PlanningOptions{}};
  core::VehicleDescription vehicle;
  core::FrontierCluster window;
  core::DecisionRequest request;

  Room() {
    constexpr float free = -2.0f, occupied = 2.0f;
    for (int x = -1; x <= 10; ++x)
      for (int y = -1; y <= 10; ++y)
        for (int z = -1; z <= 10; ++z) {
          const bool inside = x >= 0 && x < 10 && y >= 0 && y < 10 && z >= 0 && z < 10;
          const bool opening = x == 10 && (y == 4 || y == 5) && (z == 4 || z == 5);
          if (!opening) map.assign({x, y, z}, 1, inside ? free : occupied);
        }
    std::vector<core::CellChange> changes;
    map.for_each_known([&](const core::CellKey& k, core::Cell c, float) {
      changes.push_back({k, core::Cell::unknown, c});
    });
    roadmap.update(map, changes);
    core::LidarModel lidar;
    lidar.name = "lidar";
    lidar.columns = 64;
    lidar.elevation_rad = {0.4f, 0.0f, -0.4f};
    lidar.max_range_m = 12.0f;
    vehicle.lidar = std::make_shared<core::LidarModel>(lidar);
    window.id = 7;
    for (int y = 4; y <= 5; ++y)
      for (int z = 4; z <= 5; ++z) window.cells.push_back({9, y, z});
    window.centroid = {9.5, 5.0, 5.0};
    window.low = {9.0, 4.0, 4.0};
    window.high = {10.0, 6.0, 6.0};
    window.normal = {1, 0, 0};
    window.unknown_cells = 4;
    window.free_cells = 20;
    request.stamp = 5 * core::kSecond;
    request.deadline = request.stamp + 100 * core::kMillisecond;
    request.sequence = 1;
    request.state.position = {5.5, 5.5, 5.5};
    request.seconds_before_homing = 300;
    request.battery_fraction = 0.5;
    request.battery_seconds_left = 400;
    request.mission_seconds_left = 1800;
    request.max_speed_mps = 2;
    request.map = &map;
    request.roadmap = &roadmap;
    request.vehicle = &vehicle;
    request.frontiers = {{&window, {8.5, 5.5, 5.5}, 0.0, 3.0}};
  }
};

inline std::string plugin_file(const std::string& name) {
  return std::string(KARST_BINARY_DIR) + "/tests/plugins/" + name + ".so";
}
inline host::PolicyChoice choice_of(const std::string& policy) {
  host::PolicyChoice c;
  c.name = policy;
  c.source = "test.info";
  c.hang_limit_s = 60.0;  // far above anything a loaded machine needs
  return c;
}
/// Loads `policy` from one file of the drawer.
inline std::unique_ptr<host::HostedPolicy> load(const std::string& file, const host::PolicyChoice& choice) {
  return host::load_policy(choice, {{plugin_file(file)}, {}});
}
inline std::unique_ptr<host::HostedPolicy> load(const std::string& file,
                                                const std::string& policy = "plain") {
  return load(file, choice_of(policy));
}
/// What decide() throws; "" if it returns.
inline std::string failure_of(core::PolicyPort& policy, const core::DecisionRequest& request) {
  try {
    policy.decide(request);
  } catch (const core::PolicyFailure& e) {
    return e.what();
  }
  return "";
}
/// What load says when it fails; "" if it does not.
inline std::string load_error(const std::string& file, const std::string& policy = "plain") {
  try {
    load(file, policy);
  } catch (const std::exception& e) {
    return e.what();
  }
  return "";
}

}  // namespace karst::test
