#include "plugins/mavlink/mavlink_options.h"

namespace karst::mavlink {

void describe(core::OptionTable& t, MavlinkOptions& o) {
  t.add("link", o.link, {}, "udp:PORT, udp:ADDRESS:PORT or serial:DEVICE:BAUD");
  t.add("firmware", o.firmware, "of the autopilot");
  t.add(
      "control", o.control,
      "position: position, velocity, acceleration and yaw; rates: body rates and thrust, for links of little "
      "latency");
  t.add("engage", o.engage,
        "who selects offboard or guided: the pilot; or karst, once the pilot has armed it on the ground");
  t.add("resume", o.resume,
        "whether karst asks for offboard again that the autopilot left as it heard nothing from karst");
  t.add("system", o.system, 1, 255, "MAVLink system number of the autopilot; others are not heard");
  t.add("setpoint_rate", o.setpoint_rate_hz, "Hz", 5, 100, "of the targets sent");
  t.add("vision_rate", o.vision_rate_hz, "Hz", 10, 100, "of the poses sent as external vision");
  t.add("imu_rate", o.imu_rate_hz, "Hz", 50, 400, "asked of the autopilot");
  t.add("hover_thrust", o.hover_thrust, "", 0.05, 0.95, "normalized thrust that carries the vehicle");
  t.add("battery_energy", o.battery_wh, "", 1, 5000, "of a full battery, in Wh");
}

void describe(core::OptionTable& t, BodyOptions& o) {
  t.add("mass", o.mass_kg, "kg", 0.1, 50, "of the vehicle with all that it carries");
  t.add("radius", o.radius_m, "m", 0.05, 3, "of the sphere that holds the vehicle");
  t.add("max_thrust", o.max_thrust_n, "", 1, 5000, "of all motors together, in newtons");
  t.add("max_body_rate", o.max_body_rate_radps, "rad/s", 0.5, 30, "that the autopilot follows");
}

}  // namespace karst::mavlink
