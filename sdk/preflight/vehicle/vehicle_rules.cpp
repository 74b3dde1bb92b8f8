#include "sdk/preflight/vehicle/vehicle_rules.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core_stack/common/format_text.h"
#include "sdk/preflight/vehicle/median.h"

namespace karst::preflight {
namespace {

using core::format_text;

constexpr double kDegree = std::numbers::pi / 180;

class Judge {
 public:
  void add(Part part, std::string what, std::string measured, std::string required, Outcome outcome,
           std::string remedy) {
    if (outcome == Outcome::pass) remedy.clear();
    checks_.push_back(
        {part, std::move(what), std::move(measured), std::move(required), outcome, std::move(remedy)});
  }
  std::vector<Check> take() { return std::move(checks_); }

 private:
  std::vector<Check> checks_;
};

/// Above `no_go` it is no-go, above `watch` to be watched. What is not a number is no-go.
Outcome at_most(double value, double watch, double no_go) {
  if (!(value <= no_go)) return Outcome::no_go;
  return value <= watch ? Outcome::pass : Outcome::watch;
}
Outcome at_least(double value, double watch, double no_go) { return at_most(-value, -watch, -no_go); }
Outcome no_go_if(bool wrong) { return wrong ? Outcome::no_go : Outcome::pass; }
Outcome watch_if(bool wrong) { return wrong ? Outcome::watch : Outcome::pass; }

/// What a sensor's messages may be like.
struct TimelineLimits {
  Part part = Part::vehicle;
  bool needed = true;                   // to fly
  double least_rate = 0.8;              // of the required one; below it no-go
  double gap_s = 1, longest_gap_s = 3;  // watch, no-go
  double latency_s = 0.3, longest_latency_s = 1;
};

TimelineLimits limits_of(Sensor sensor) {
  switch (sensor) {
    case Sensor::imu:
      return {Part::imu, true, 0.45, 0.05, 0.2, 0.05, 0.1};
    case Sensor::lidar:
      return {Part::lidar, true, 0.8, 0.35, 1, 0.15, 0.25};
    case Sensor::camera:
      return {Part::camera, true, 0.7, 1, 3, 0.3, 1};
    case Sensor::pose:
      return {Part::pose, true, 0.5, 0.2, 0.5, 0.1, 0.2};
    case Sensor::magnetometer:
      return {Part::compass, false, 0, 0.5, 1e9, 0.2, 1e9};
    case Sensor::barometer:
      return {Part::barometer, false, 0, 1, 1e9, 0.3, 1e9};
    case Sensor::battery:
      return {Part::battery, true, 0.3, 5, 15, 2, 10};
  }
  return {};
}

constexpr double kFuture_s = 0.005, kJump_s = 0.1, kJitter = 0.4;  // jitter: of the period
constexpr double kFirstAfter_s = 3;
constexpr int kFewMessages = 3;

void judge_timeline(const SensorTimeline& s, core::Clock clock, Judge& judge) {
  const TimelineLimits limits = limits_of(s.sensor);
  const Timeline& t = s.timeline;
  const std::string of = s.name.empty() ? "" : " (" + s.name + ")";
  if (t.messages == 0) {
    judge.add(
        limits.part, "messages" + of, "none", "at least " + format_text("%.3g Hz", s.required_hz),
        limits.needed ? Outcome::no_go : Outcome::watch,
        std::string("check its power, its cable and its address") +
            (clock == core::Clock::lockstep ? "; a vehicle that is not simulated needs --real-time" : ""));
    return;
  }
  const double worst_rate = limits.least_rate * s.required_hz;
  judge.add(limits.part, "rate" + of, format_text("%.1f Hz", t.rate_hz),
            format_text("%.3g Hz, at least %.3g Hz", s.required_hz, 0.9 * s.required_hz),
            at_least(t.rate_hz, 0.9 * s.required_hz, worst_rate),
            "set the rate in the sensor or the autopilot, and look for a link that is too slow");
  judge.add(limits.part, "longest gap" + of, format_text("%.3f s", t.longest_gap_s),
            format_text("at most %.2f s", limits.gap_s),
            at_most(t.longest_gap_s, limits.gap_s, limits.longest_gap_s),
            "look for a loose cable, a busy computer or a full link");
  if (t.first_after_s > kFirstAfter_s)
    judge.add(limits.part, "first message" + of, format_text("after %.1f s", t.first_after_s),
              format_text("after at most %.0f s", kFirstAfter_s), Outcome::watch,
              "wait for it before you hand over");
  if (t.messages < kFewMessages) return;
  judge.add(
      limits.part, "regularity of stamps" + of, format_text("%.1f ms off", 1000 * t.jitter_s),
      format_text("at most %.0f %% of the period", 100 * kJitter),
      watch_if(t.jitter_s * s.required_hz > kJitter && t.jitter_s > 0.002 && s.sensor != Sensor::battery),
      "have the sensor stamp its messages, and not the program that receives them");
  judge.add(limits.part, "order of stamps" + of, format_text("%d not after the one before", t.backward), "0",
            no_go_if(t.backward > 0),
            "look for two sources of the same messages, and for a clock that is set");
  judge.add(limits.part, "stamps in the future" + of, format_text("%.0f ms", 1000 * t.future_s),
            format_text("at most %.0f ms", 1000 * kFuture_s), no_go_if(t.future_s > kFuture_s),
            "synchronize the sensor's clock with the computer's (PTP, NTP)");
  judge.add(limits.part, "steadiness of the clock" + of, format_text("jumps by %.0f ms", 1000 * t.jump_s),
            format_text("at most %.0f ms", 1000 * kJump_s), no_go_if(std::abs(t.jump_s) > kJump_s),
            "find what sets this clock while it runs: it must be set before the flight, and then left alone");
  judge.add(s.sensor == Sensor::imu ? Part::link : limits.part,
            (s.sensor == Sensor::imu ? "latency of the IMU's messages" : "latency") + of,
            format_text("%.0f ms", 1000 * t.latency_s),
            format_text("at most %.0f ms", 1000 * limits.latency_s),
            at_most(t.latency_s, limits.latency_s, limits.longest_latency_s),
            "use a faster link (a serial line of 921600 baud, Ethernet), and send less over it");
}

constexpr double kGravity_mps2 = 9.81;  // 9.78 at the equator, 9.83 at the poles

void judge_imu(const VehicleMeasurements& m, Judge& judge) {
  const ImuAtRest& imu = m.imu;
  if (imu.samples == 0) return;
  judge.add(Part::imu, "values that are no numbers", format_text("%d", imu.invalid), "0",
            no_go_if(imu.invalid > 0), "look for a fault of the driver");
  const bool still = imu.rate_noise_radps < 0.05 && imu.force_noise_mps2 < 1 && imu.force_drift_mps2 < 0.3;
  judge.add(
      Part::imu, "standing still",
      format_text("%.3f rad/s, %.2f m/s² (standard deviation)", imu.rate_noise_radps, imu.force_noise_mps2),
      "less than 0.05 rad/s and 1 m/s²", no_go_if(!still),
      "let it stand on the pad, touch nothing, and repeat; if it stood, the IMU is broken");
  if (!still) return;
  const double error_mps2 = std::abs(imu.gravity_mps2() - kGravity_mps2);
  judge.add(Part::imu, "length of gravity", format_text("%.3f m/s²", imu.gravity_mps2()),
            format_text("%.2f m/s², within 0.30", kGravity_mps2), at_most(error_mps2, 0.2, 0.3),
            "calibrate the accelerometer; a scale in other units shows here too");
  judge.add(Part::imu, "direction of gravity",
            format_text("%.1f deg from the body's z axis (x %.2f, y %.2f, z %.2f)", imu.tilt_rad() / kDegree,
                        imu.mean_force_mps2.x(), imu.mean_force_mps2.y(), imu.mean_force_mps2.z()),
            "at most 10 deg", at_most(imu.tilt_rad() / kDegree, 10, 25),
            imu.tilt_rad() > 45 * kDegree
                ? "axes are swapped or turned: set the mounting of the IMU or of the "
                  "autopilot (x forward, y left, z up)"
                : "level the pad; if it is level, calibrate the accelerometer");
  const double bias_dps = imu.mean_rate_radps.norm() / kDegree;
  judge.add(Part::imu, "bias of the gyroscope", format_text("%.2f deg/s", bias_dps), "at most 1 deg/s",
            at_most(bias_dps, 1, 5), "let the vehicle stand while it starts, and calibrate the gyroscope");
  judge.add(Part::imu, "noise of the accelerometer", format_text("%.3f m/s²", imu.force_noise_mps2),
            "at most 0.3 m/s²", watch_if(imu.force_noise_mps2 > 0.3), "look for a fan or a loose mounting");
  judge.add(Part::imu, "noise of the gyroscope", format_text("%.4f rad/s", imu.rate_noise_radps),
            "at most 0.02 rad/s", watch_if(imu.rate_noise_radps > 0.02),
            "look for a fan or a loose mounting");
  judge.add(Part::imu, "repeated samples", format_text("%.0f %%", 100 * imu.repeated), "at most 5 %",
            at_most(imu.repeated, 0.05, 0.3), "have each sample sent once");
}

/// Whether the gyroscope's axes contradict the accelerometer's: then it is not the LiDAR that is wrong.
bool gyroscope_is_turned(const MotionFigures& motion) { return motion.gyroscope_axes.turned(); }

constexpr double kLeastRate_radps = 0.1;  // root mean square, about each axis

/// What it turned faster than for a quarter of the time. By the sensor that shows more: either may be dead.
/// A quantile, since scan matching goes wrong now and then. Nothing if neither sensor shows anything.
std::optional<double> turn_rate_radps(const MotionFigures& motion) {
  constexpr double kThreeQuarters = 0.75;
  std::optional<double> greatest;
  for (const auto* rates : {&motion.gyroscope_rates, &motion.lidar_rates}) {
    std::vector<double> radps;
    for (const TurnRate& r : *rates)
      if (std::isfinite(r.radps)) radps.push_back(r.radps);
    if (!radps.empty()) greatest = std::max(greatest.value_or(0), quantile(std::move(radps), kThreeQuarters));
  }
  return greatest;
}

bool hardly_turned(const MotionFigures& motion) {
  return turn_rate_radps(motion).value_or(kLeastRate_radps) < kLeastRate_radps;
}

void judge_mounting(const HandEye& h, const MotionFigures& motion, Judge& judge) {
  const Eigen::Matrix3d axes = nearest_axis_map(h.map);
  const double error_deg = h.error_rad.norm() / kDegree, sigma_deg = h.sigma_rad / kDegree;
  const std::string measured = format_text("%.2f deg (x %+.2f, y %+.2f, z %+.2f), uncertain by %.2f deg",
                                           error_deg, h.error_rad.x() / kDegree, h.error_rad.y() / kDegree,
                                           h.error_rad.z() / kDegree, 2 * sigma_deg);
  if (gyroscope_is_turned(motion)) return;  // said already
  if (!is_identity(axes)) {
    judge.add(Part::lidar, "axes of LiDAR and IMU",
              "seen from the LiDAR, the IMU's " + axis_words(axes.transpose()), "x is x, y is y, z is z",
              Outcome::no_go, "set the mounting of the LiDAR or of the IMU: they differ by right angles");
    return;
  }
  // A fault only if the uncertainty does not explain it, and a pass only if it could have been seen.
  Outcome outcome = at_most(error_deg, 1.0, 1.5);
  if (outcome == Outcome::no_go && error_deg < 2 * sigma_deg) outcome = Outcome::watch;
  if (outcome == Outcome::pass && 2 * sigma_deg > 1) outcome = Outcome::watch;
  judge.add(Part::lidar, "rotation of the mounting", measured, "at most 1.5 deg", outcome,
            "correct the rotation of the LiDAR in the mission by this, tighten its screws, and repeat");
  judge.add(Part::imu, "scale of the gyroscope", format_text("%.3f of the LiDAR's turns", 1 / h.scale),
            "1, within 0.03", at_most(std::abs(h.scale - 1), 0.03, 0.1),
            "set the gyroscope's range and unit (rad/s)");
}

void judge_motion(const VehicleMeasurements& m, Judge& judge) {
  if (!m.motion) {
    if (m.vehicle.lidar)
      judge.add(Part::lidar, "mounting and delay", "not measured", "measured by hand", Outcome::watch,
                "repeat with --motion after each change of the mounting");
    return;
  }
  const MotionFigures& motion = *m.motion;
  if (hardly_turned(motion)) {  // all else would compare noise with noise
    judge.add(
        m.vehicle.lidar ? Part::lidar : Part::imu, "turned by hand",
        format_text("hardly: %.1f deg/s", *turn_rate_radps(motion) / kDegree),
        format_text("at least %.1f deg/s about each axis", kLeastRate_radps / kDegree), Outcome::no_go,
        "repeat; when the terminal asks for it, take it into your hands, and roll it, nod it and turn it, "
        "each several times by 30 deg and more. Mounting, delays and axes were not judged");
    return;
  }
  judge.add(Part::imu, "samples at the limit of its range", format_text("%.1f %%", 100 * motion.clipped), "0",
            watch_if(motion.clipped > 0.001), "set a larger range, or turn it more gently");
  judge.add(Part::imu, "axes of the gyroscope, by gravity",
            gyroscope_is_turned(motion) ? axis_words(motion.gyroscope_axes.best) : "x is x, y is y, z is z",
            "x is x, y is y, z is z", no_go_if(gyroscope_is_turned(motion)),
            "set the axes of the gyroscope: they differ from the accelerometer's");
  if (!m.vehicle.lidar) return;
  judge.add(Part::lidar, "scans that can be matched", format_text("%d of %d", motion.matched, motion.scans),
            "90 %",
            at_least(motion.scans > 0 ? static_cast<double>(motion.matched) / motion.scans : 0, 0.9, 0.5),
            "turn it more gently, near structured walls");
  if (!motion.hand_eye) {
    judge.add(Part::lidar, "mounting and delay", "not measured: too few scans", "measured by hand",
              Outcome::no_go, "repeat the motion, for 20 s and more");
    return;
  }
  const HandEye& h = *motion.hand_eye;
  const bool enough = h.weakest_rate_radps >= kLeastRate_radps;
  judge.add(Part::lidar, "turned about all axes",
            format_text("%.1f deg/s (rms) about the least one", h.weakest_rate_radps / kDegree),
            format_text("at least %.1f deg/s", kLeastRate_radps / kDegree), watch_if(!enough),
            "repeat: nod, roll and turn it, each several times by 30 deg and more");
  judge.add(Part::lidar, "turns agree with the gyroscope's", format_text("%.1f %%", 100 * h.explained),
            "at least 95 %", at_least(h.explained, 0.95, 0.8),
            "look for stamps that vary and for a LiDAR that is loose, and turn it more gently");
  const double delay_ms = 1000 * h.delay_s;
  judge.add(Part::lidar, "delay of its stamps behind the IMU's",
            format_text("%+.0f ms, uncertain by %.0f ms", delay_ms, 2000 * h.delay_sigma_s), "within 20 ms",
            at_most(std::abs(delay_ms), 20, 40),
            "synchronize the clocks (PTP), or correct the stamps by this; the stamp is the end of the sweep");
  if (enough) judge_mounting(h, motion, judge);
}

std::string arc_text(const BlockedArc& arc) {
  const auto from = static_cast<int>(std::lround(arc.from_rad / kDegree));
  const auto to = static_cast<int>(std::lround((arc.from_rad + arc.width_rad) / kDegree));
  return format_text("%.0f deg, from %d to %d deg to the left of forward", arc.width_rad / kDegree, from, to);
}

void judge_lidar(const LidarView& v, Judge& judge) {
  judge.add(Part::lidar, "size of scans", format_text("%d do not fit the description", v.misshapen), "0",
            no_go_if(v.misshapen > 0), "set the model of the LiDAR in the mission: channels and columns");
  if (v.scans == 0) return;
  const double width_deg = v.blocked.width_rad / kDegree;
  judge.add(Part::lidar, "blocked sector", width_deg > 0 ? arc_text(v.blocked) : "none", "less than 10 deg",
            at_most(width_deg, 5, 15),
            v.blocked.hull
                ? "something of the vehicle is in front of it: move it, or leave the sector out"
                : "uncover and clean it; or the vehicle stands in the open, where nothing returns");
  judge.add(Part::lidar, "noise of ranges", format_text("%.3f m", v.noise_m), "at most 0.05 m",
            at_most(v.noise_m, 0.05, 0.15), "clean its window, and wait for dust to settle");
  judge.add(Part::lidar, "beams that come and go", format_text("%.1f %%", 100 * v.flicker), "at most 15 %",
            watch_if(v.flicker > 0.15), "clean its window, and wait for dust or fog to settle");
  judge.add(Part::lidar, "intensity of returns", format_text("%.3f (median)", v.intensity), "at least 0.02",
            watch_if(v.intensity < 0.02), "clean its window; wet or black rock is weak, too");
}

void judge_room(const VehicleMeasurements& m, Judge& judge) {
  if (!m.vehicle.lidar && m.vehicle.cameras.empty()) return;
  const PadRoom& r = m.room;
  if (!r.known) {
    judge.add(Part::pad, "room", "no returns", "known", Outcome::no_go, "see the sensors above");
    return;
  }
  const double least_m = m.climb_m + m.vehicle.radius_m + 0.2;
  const auto height = [](double free_m, double looked_m) {
    return format_text(free_m < looked_m ? "%.2f m" : "more than %.1f m", free_m);
  };
  judge.add(
      Part::pad, "room above",
      height(r.above_m, r.above_looked_m) + (r.seen_above ? "" : " as far as seen: no sensor looks there"),
      format_text("%.2f m above its centre (mission.takeoff_height %.1f m, the hull and 0.2 m)", least_m,
                  m.climb_m),
      no_go_if(r.above_m < least_m), "find another place, or lower mission.takeoff_height");
  judge.add(Part::pad, "room around", height(r.around_m, r.around_looked_m), "0.3 m beside the hull",
            at_most(-r.around_m, -0.3, -0.1), "move away from walls, people and gear");
}

void judge_compass(const CompassFigures& c, const std::optional<MotionFigures>& motion, Judge& judge) {
  judge.add(Part::compass, "field strength", format_text("%.1f uT", c.strength_ut), "22 to 67 uT",
            watch_if(c.strength_ut < 20 || c.strength_ut > 70),
            "move away from iron and cables, and calibrate the compass (unit: microtesla)");
  judge.add(Part::compass, "horizontal part",
            format_text("%.1f uT (dip %.0f deg)", c.strength_ut * std::cos(c.dip_rad), c.dip_rad / kDegree),
            "at least 5 uT", watch_if(c.strength_ut * std::cos(c.dip_rad) < 5),
            "near the poles there is no heading; elsewhere calibrate the compass");
  judge.add(Part::compass, "noise", format_text("%.2f uT", c.noise_ut), "at most 2 uT",
            watch_if(c.noise_ut > 2), "move it away from power cables");
  if (!motion || hardly_turned(*motion) || (!c.by_gyroscope && !c.by_lidar)) return;
  judge.add(Part::compass, "strength while turned", format_text("varies by %.1f %%", 100 * c.strength_spread),
            "at most 10 %", watch_if(c.strength_spread > 0.1),
            "calibrate the compass: the vehicle's iron shows");
  // Accused only if all that it is compared with agree. A gyroscope with wrong axes is no witness.
  const AxisTest* gyroscope = c.by_gyroscope && !gyroscope_is_turned(*motion) ? &*c.by_gyroscope : nullptr;
  const AxisTest* lidar = c.by_lidar ? &*c.by_lidar : nullptr;
  if (!gyroscope && !lidar) return;
  const AxisTest& witness = gyroscope ? *gyroscope : *lidar;
  const bool turned = (!gyroscope || gyroscope->turned()) && (!lidar || lidar->turned());
  if (turned) {
    judge.add(Part::compass, "axes, by turning", axis_words(witness.best), "x is x, y is y, z is z",
              Outcome::no_go, "set the mounting of the compass: it is turned by right angles");
    return;
  }
  double error_rad = 10;
  for (const AxisTest* w : {gyroscope, lidar})
    if (w && w->strength > 0) error_rad = std::min(error_rad, w->scatter_as_is / w->strength);
  judge.add(Part::compass, "direction while turned",
            format_text("off by %.1f deg (rms)", error_rad / kDegree), "at most 8 deg",
            watch_if(error_rad > 8 * kDegree),
            "calibrate the compass, and move it away from cables and iron");
}

void judge_barometer(const BarometerFigures& b, Judge& judge) {
  judge.add(Part::barometer, "noise at rest",
            b.frozen ? "none: always the same" : format_text("%.2f m", b.noise_m),
            "more than 0, at most 0.5 m", watch_if(b.frozen || !(b.noise_m <= 0.5)),
            "cover it with foam; if it never changes, its driver is stuck");
  judge.add(Part::barometer, "drift at rest", format_text("%+.2f m", b.drift_m), "within 1 m",
            watch_if(!(std::abs(b.drift_m) <= 1)), "let it warm up, out of wind and sun");
}

void judge_battery(const core::BatteryStatus& b, double home_reserve_s, Judge& judge) {
  judge.add(Part::battery, "charge", format_text("%.0f %%", 100 * b.fraction_left), "at least 90 %",
            at_least(b.fraction_left, 0.9, 0.5), "charge it, or take another");
  judge.add(Part::battery, "time left", format_text("%.0f s", b.seconds_left),
            format_text("at least %.0f s (three times mission.home_reserve)", 3 * home_reserve_s),
            no_go_if(!(b.seconds_left >= 3 * home_reserve_s)),
            "charge it; or set the capacity and the power of hovering in the autopilot or the mission");
}

void judge_machine(const MachineFacts& machine, Judge& judge) {
  constexpr double kGiB = 1024.0 * 1024 * 1024;
  const double free_gib = machine.free_bytes ? static_cast<double>(*machine.free_bytes) / kGiB : 0;
  const double scans_gib = machine.scans_bytes / kGiB;
  judge.add(
      Part::machine, "free space for " + machine.run_folder,
      machine.free_bytes ? format_text("%.1f GiB", free_gib) : "unknown",
      scans_gib > 0 ? format_text("at least 4 GiB, and %.1f GiB for the scans", scans_gib) : "at least 4 GiB",
      at_least(free_gib, 4 + scans_gib, 1 + scans_gib),
      scans_gib > 0 ? "delete or move old runs, write to another disk (--out), or fly shorter or "
                      "without record.scans"
                    : "delete or move old runs, or write to another disk (--out)");
  judge.add(Part::machine, "date", machine.clock_plausible ? "plausible" : "before karst was built",
            "the present", watch_if(!machine.clock_plausible), "set the computer's clock");
  if (!machine.policy.empty())
    judge.add(Part::policy, "loads: " + machine.policy,
              machine.policy_problem.empty() ? "yes" : machine.policy_problem, "yes",
              no_go_if(!machine.policy_problem.empty()), "install or name the policy (karst policy list)");
}

}  // namespace

std::vector<Check> checks_of(const VehicleMeasurements& m) {
  Judge judge;
  if (!m.lost.empty())
    judge.add(Part::vehicle, "stays", m.lost, "to the end", Outcome::no_go, "see its own log, and repeat");
  if (m.lifted_off)
    judge.add(Part::vehicle, "stands", "it left the ground", "on the pad", Outcome::no_go,
              "disarm it, take off its props, and find out who armed it");
  for (const core::VehicleCheck& c : m.checks)
    judge.add(Part::link, c.name, c.found.empty() ? "no answer" : c.found, c.required, no_go_if(!c.holds),
              c.found.empty() ? "the autopilot did not answer: see the link"
                              : "mend it on the autopilot, and restart it");
  for (const SensorTimeline& s : m.sensors) judge_timeline(s, m.clock, judge);
  judge_imu(m, judge);
  if (m.lidar) judge_lidar(*m.lidar, judge);
  judge_motion(m, judge);
  if (m.compass) judge_compass(*m.compass, m.motion, judge);
  if (m.barometer) judge_barometer(*m.barometer, judge);
  if (m.battery) judge_battery(*m.battery, m.home_reserve_s, judge);
  judge_room(m, judge);
  judge_machine(m.machine, judge);
  std::vector<Check> checks = judge.take();
  std::stable_sort(checks.begin(), checks.end(),
                   [](const Check& a, const Check& b) { return a.part < b.part; });
  return checks;
}

Outcome verdict_of(const std::vector<Check>& checks) {
  Outcome worst = Outcome::pass;
  for (const Check& c : checks) worst = std::max(worst, c.outcome);
  return worst;
}

std::vector<std::string> boxes_for_persons(const VehicleMeasurements& m) {
  std::vector<std::string> boxes = {
      "Props: undamaged, tight, each on its own motor and turning the right way",
      "Straps, plugs, antennas and the battery are tight; nothing hangs down",
      "Ropes, bolts, webs and people: none within the room that it may fly in",
      "The pilot's switch takes control back and disarms: tried, props off",
      "The pilot holds the transmitter, sees the vehicle and knows what it will do",
      "Everybody near wears a helmet and glasses, and knows where to step back to"};
  if ((m.vehicle.lidar || !m.vehicle.cameras.empty()) && !m.room.seen_above)
    boxes.push_back(format_text("Straight above, where no sensor looks: %.1f m and more are free (look up)",
                                m.climb_m + m.vehicle.radius_m + 0.2));
  return boxes;
}

}  // namespace karst::preflight
