// What a vehicle in another process costs a step: a vehicle that computes nothing, with an IMU at 200 Hz, a
// sweep of 128 x 1024 beams and an image of 320 x 240 at 10 Hz, flown in lockstep in this process, over a
// Unix socket and over TCP, in turns.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <vector>

#include "plugins/socket/lockstep_vehicle.h"
#include "plugins/socket/vehicle_server.h"

namespace {

using namespace karst;
using core::kMillisecond;
using core::kSecond;

constexpr core::TimeNs kLength = 10 * kSecond;
constexpr int kRounds = 9;

core::VehicleDescription description() {
  core::VehicleDescription v;
  v.name = "idle";
  core::LidarModel lidar;
  lidar.columns = 1024;
  for (int i = 0; i < 128; ++i) lidar.elevation_rad.push_back(0.7f - 0.01f * static_cast<float>(i));
  v.lidar = std::make_shared<const core::LidarModel>(lidar);
  core::CameraModel camera;
  camera.width = 320;
  camera.height = 240;
  camera.horizontal_fov_rad = camera.vertical_fov_rad = 1;
  v.cameras = {std::make_shared<const core::CameraModel>(camera)};
  return v;
}

class IdleVehicle final : public core::Vehicle {
 public:
  core::VehicleDescription description() const override { return description_; }
  void start(core::Executive& executive, core::VehicleSink& sink) override {
    auto scan = std::make_shared<core::LidarScan>();
    scan->model = description_.lidar;
    scan->range_m.assign(128 * 1024, 5.0f);
    scan->intensity.assign(128 * 1024, 0.5f);
    auto image = std::make_shared<core::DepthImage>();
    image->model = description_.cameras[0];
    image->range_m.assign(320 * 240, 2.0f);
    executive.every("idle", 5 * kMillisecond, 5 * kMillisecond, [&executive, &sink, scan, image] {
      core::ImuSample imu;
      imu.stamp = executive.now();
      sink.on_imu(imu);
      if (executive.now() % (100 * kMillisecond) != 0) return;
      sink.on_lidar(scan);
      sink.on_depth(image);
    });
  }
  void command(const core::Command&) override {}

 private:
  core::VehicleDescription description_ = ::description();
};

struct Nothing final : core::VehicleSink {
  void on_lidar(std::shared_ptr<const core::LidarScan>) override {}
  void on_depth(std::shared_ptr<const core::DepthImage>) override {}
  void on_imu(const core::ImuSample&) override {}
  void on_magnetometer(const core::MagnetometerSample&) override {}
  void on_pose(const core::PoseSample&) override {}
  void on_battery(const core::BatteryStatus&) override {}
  void on_ground(core::TimeNs) override {}
  void on_lift_off(core::TimeNs) override {}
  void on_lost(core::TimeNs, core::MissionOutcome, const std::string& reason) override {
    std::fprintf(stderr, "lost: %s\n", reason.c_str());
    std::exit(1);
  }
};

/// Microseconds a step of 5 ms: without a sweep, and with one.
struct StepCost {
  double plain_us = 0, with_sweep_us = 0;
};

double median(std::vector<double> all) {
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2), all.end());
  return all[all.size() / 2];
}

StepCost fly(core::Vehicle& vehicle) {
  core::Executive executive(1);
  Nothing sink;
  vehicle.start(executive, sink);
  executive.every("control", 10 * kMillisecond, 10 * kMillisecond, [&] { vehicle.command({}); });
  std::vector<double> plain, sweeps;
  for (core::TimeNs t = 5 * kMillisecond; t <= kLength; t += 5 * kMillisecond) {
    const auto begin = std::chrono::steady_clock::now();
    executive.run_until(t, [] { return false; });
    const double us =
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count();
    (t % (100 * kMillisecond) == 0 ? sweeps : plain).push_back(us);
  }
  vehicle.finish();
  return {median(plain), median(sweeps)};
}

StepCost fly_by(const std::string& address) {
  std::optional<socket::Listener> listener(socket::parse_address(address));
  const socket::Address where = listener->address();
  const pid_t child = fork();
  if (child == 0) {
    static const std::atomic<bool> go_on{false};
    auto client = listener->accept(socket::Wait(10'000));
    socket::serve_client(
        *client, [](const socket::Hello&) { return std::make_unique<IdleVehicle>(); }, {}, go_on);
    _exit(0);
  }
  socket::LockstepVehicle vehicle(
      std::make_unique<socket::VehicleLink>(where, socket::Hello{}, socket::Wait(10'000)),
      socket::Wait(10'000));
  const StepCost cost = fly(vehicle);
  waitpid(child, nullptr, 0);
  return cost;
}

}  // namespace

int main() {
  std::map<std::string, std::vector<StepCost>> all;
  for (int i = 0; i < kRounds; ++i) {
    IdleVehicle here;
    all["in process"].push_back(fly(here));
    all["unix"].push_back(fly_by("unix:/tmp/karst_socket_bench"));
    all["tcp"].push_back(fly_by("tcp:0"));
  }
  std::printf("us a step of 5 ms, median of %d rounds of %.0f s each (least and most)\n", kRounds,
              core::seconds(kLength));
  for (const auto& [name, costs] : all) {
    std::vector<double> plain, sweep;
    for (const StepCost& c : costs) {
      plain.push_back(c.plain_us);
      sweep.push_back(c.with_sweep_us);
    }
    const auto [plain_least, plain_most] = std::minmax_element(plain.begin(), plain.end());
    const auto [sweep_least, sweep_most] = std::minmax_element(sweep.begin(), sweep.end());
    std::printf("%-12s imu %7.1f (%.1f to %.1f)   with sweep and image %7.0f (%.0f to %.0f)\n", name.c_str(),
                median(plain), *plain_least, *plain_most, median(sweep), *sweep_least, *sweep_most);
  }
  return 0;
}
