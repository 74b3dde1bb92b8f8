#include <cmath>
#include <cstdio>
#include <numbers>

#include "core_stack/common/error.h"
#include "core_stack/common/geometry.h"
#include "core_stack/common/opened_by_key.h"
#include "plugins/lidar_drivers/lidar_driver_options.h"
#include "plugins/mavlink/lidar_scans.h"
#include "plugins/mavlink/link/open_link.h"
#include "plugins/mavlink/mavlink_vehicle.h"

namespace {

using namespace karst;

class MavlinkPlugin final : public core::VehiclePlugin {
 public:
  void describe_options(core::OptionTable& t) override {
    options_ = {};  // drops the options of a mission read before
    body_ = {};
    lidar_ = {};
    describe(t, options_);
    t.section("body", body_);
    t.section("lidar", lidar_);
  }

  std::unique_ptr<core::Vehicle> create(const core::VehicleSetup& setup) override {
    if (setup.clock == core::Clock::lockstep)
      throw core::InputError(
          "vehicle mavlink", "",
          "flies by the machine's clock only: add --real-time, or fly simulated_autopilot");
    if (lidar_.unit == lidar::LidarUnit::none)
      throw core::InputError("vehicle mavlink", "mavlink.lidar.unit",
                             "is none: without a LiDAR the core cannot tell where it is");
    if (lidar_.imu)
      throw core::InputError("vehicle mavlink", "mavlink.lidar.imu",
                             "is not used: the IMU is the autopilot's");
    mavlink::MavlinkVehicle::Parts parts;
    parts.description.name = "mavlink";
    parts.description.radius_m = body_.radius_m;
    parts.description.mass_kg = body_.mass_kg;
    parts.description.max_thrust_n = body_.max_thrust_n;
    parts.description.max_body_rate_radps = body_.max_body_rate_radps;
    parts.description.T_world_start = start_of(setup.start);
    parts.link = core::opened_by_key("vehicle mavlink", "mavlink.link", [this] {
      return mavlink::open_link(options_.link, mavlink::autopilot_of(options_.system));
    });
    parts.scans =
        std::make_unique<mavlink::LidarScans>(lidar::open_lidar(lidar_, "vehicle mavlink", "mavlink.lidar"));
    parts.climb_m = setup.climb_m;
    parts.run_dir = setup.run_dir;
    parts.address = options_.link;
    return std::make_unique<mavlink::MavlinkVehicle>(options_, std::move(parts));
  }

 private:
  /// Where it stands is the origin, unless the mission says otherwise.
  static core::Pose start_of(const std::string& text);

  mavlink::MavlinkOptions options_;
  mavlink::BodyOptions body_;
  lidar::LidarDriverOptions lidar_;
};

core::Pose MavlinkPlugin::start_of(const std::string& text) {
  if (text.empty()) return {};
  double x = 0, y = 0, z = 0, heading_deg = 0;
  int read = 0;
  const int n = std::sscanf(text.c_str(), "%lf %lf %lf %n%lf %n", &x, &y, &z, &read, &heading_deg, &read);
  const core::Vec3 position(x, y, z);
  if (n < 3 || text.c_str()[read] != '\0' || !position.allFinite() || !std::isfinite(heading_deg))
    throw core::InputError("vehicle mavlink", "cave.start",
                           "expected \"x y z [heading_deg]\", got \"" + text + "\"");
  return {position, core::from_heading(heading_deg * std::numbers::pi / 180)};
}

}  // namespace

KARST_VEHICLE_PLUGIN(MavlinkPlugin)
