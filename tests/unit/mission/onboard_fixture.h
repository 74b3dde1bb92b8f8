// What the parts of a mission work with, for tests of one part: a vehicle that is always where its reference
// says, in an empty map.
#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "core_stack/mission/onboard/onboard.h"
#include "core_stack/mission/phases/endurance.h"
#include "core_stack/mission/phases/flown_path.h"
#include "core_stack/mission/phases/goal_tracker.h"
#include "core_stack/mission/phases/path_execution.h"
#include "tests/unit/mission/lidar_vehicle.h"
#include "tests/unit/mission/scripted_policy.h"

namespace karst::core {

class OnboardTest : public ::testing::Test {
 protected:
  explicit OnboardTest(const VehicleDescription& vehicle = with_lidar(),
                       const CoreOptions& options = by_pose_sensor())
      : onboard(options, vehicle, executive, recorder, policy) {}

  static std::filesystem::path fresh_run() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    const auto dir = std::filesystem::path(KARST_BINARY_DIR) / "test_runs" /
                     (std::string("onboard_") + test->test_suite_name() + "_" + test->name());
    std::filesystem::remove_all(dir);
    return dir;
  }
  static CoreOptions by_pose_sensor() {
    CoreOptions o;
    o.localization.source = PoseSource::pose_sensor;
    o.team.robots = 3;
    return o;
  }

  /// Runs all that is due in the next `s` seconds, with a control cycle every 10 ms.
  void advance(double s) {
    for (const TimeNs end = executive.now() + from_seconds(s); executive.now() < end;) {
      executive.run_until(executive.now() + 10 * kMillisecond, [] { return false; });
      onboard.flight.control(executive.now());
      const Reference& r = onboard.flight.reference();
      onboard.flight.on_imu({executive.now(), r.acceleration_mps2 + Vec3(0, 0, 9.81), Vec3::Zero()},
                            executive.now());
      PoseSample pose;
      pose.stamp = executive.now();
      pose.T_world_body.position = r.position;
      onboard.flight.on_pose(pose);
    }
  }
  TimeNs now() const { return executive.now(); }
  /// Hovers `height_m` up.
  void hover(double height_m = 1) {
    onboard.flight.climb(now(), height_m, 0.5);
    advance(2 * height_m + 3);
    flown_path.begin(onboard.flight.reference().position);
  }
  /// Flies straight ahead, for that far.
  void fly_ahead(double metres) {
    const Vec3 from = onboard.flight.reference().position;
    onboard.flight.follow({.points = {from, from + Vec3(metres, 0, 0)}, .start = now()});
  }
  std::string events() {
    recorder.flush();
    std::ifstream in(run / "events.jsonl");
    std::ostringstream all;
    all << in.rdbuf();
    return all.str();
  }
  std::size_t told(const std::string& part) {
    const std::string all = events();
    std::size_t n = 0;
    for (std::size_t at = all.find(part); at != std::string::npos; at = all.find(part, at + 1)) ++n;
    return n;
  }

  std::filesystem::path run = fresh_run();
  Recorder recorder{run};
  Executive executive{1};
  ScriptedPolicy policy;
  Onboard onboard;
  PhaseMachine phases;
  GoalTracker goals{recorder};
  PathExecution path{onboard};
  FlownPath flown_path;
  Endurance endurance{300};
};

}  // namespace karst::core
