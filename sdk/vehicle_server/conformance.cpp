#include "sdk/vehicle_server/conformance.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "core_stack/common/error.h"
#include "core_stack/common/printable.h"
#include "plugins/socket/clock_offset.h"
#include "plugins/socket/plausible.h"
#include "sdk/vehicle_server/conformance_client.h"

namespace karst::vehicle_server {
namespace {

using core::kMillisecond;
using core::kSecond;
using core::TimeNs;
using socket::FlightClock;
using socket::implausible;
using socket::LinkError;
using socket::Wait;

constexpr double kGravity_mps2 = 9.81;
constexpr TimeNs kComesDownWithin = 20 * kSecond;
constexpr double kLeastImuRate_hz = 50;

template <class... Values>
std::string words(const char* format, Values... values) {
  char text[200];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

/// Messages of one type, with their stamps.
template <class M>
std::vector<const M*> all_of(const std::vector<Heard>& heard) {
  std::vector<const M*> all;
  for (const Heard& h : heard)
    if (const M* m = std::get_if<M>(&h.message)) all.push_back(m);
  return all;
}
TimeNs stamp_of(const socket::Depth& m) { return m.image.stamp; }
template <class M>
requires requires(const M& m) { m.stamp; }
TimeNs stamp_of(const M& m) { return m.stamp; }

/// "" if the stamps grow from one message to the next.
template <class M>
std::string disorder(const std::vector<const M*>& all, const char* name) {
  for (std::size_t i = 1; i < all.size(); ++i)
    if (stamp_of(*all[i]) <= stamp_of(*all[i - 1]))
      return words("%s: the stamp %.6f s follows %.6f s", name, core::seconds(stamp_of(*all[i])),
                   core::seconds(stamp_of(*all[i - 1])));
  return "";
}

template <class M>
double rate_hz(const std::vector<const M*>& all) {
  if (all.size() < 2) return 0;
  return static_cast<double>(all.size() - 1) / core::seconds(stamp_of(*all.back()) - stamp_of(*all.front()));
}

class Examination {
 public:
  Examination(const socket::Address& address, const ConformanceOptions& options,
              const std::function<void(const Finding&)>& report)
      : address_(address), options_(options), report_(report) {}

  std::vector<Finding> run() {
    { const ConformanceClient probe(address_); }  // throws if nothing answers there
    if (!greeting()) return std::move(findings_);
    examine("a second client is refused", [this] { return second_client(); });
    examine("another version is refused", [this] { return other_version(); });
    examine("garbage ends the connection only", [this] { return garbage(); });
    if (welcome_.lockstep) fly(FlightClock::lockstep);
    if (welcome_.real_time) fly(FlightClock::real_time);
    return std::move(findings_);
  }

 private:
  void note(const std::string& name, Verdict verdict, const std::string& detail) {
    findings_.push_back({name, verdict, core::printable(detail)});
    report_(findings_.back());
  }
  /// `what` returns a detail, or throws LinkError with what is wrong.
  template <class What>
  bool examine(const std::string& name, What what) {
    try {
      note(name, Verdict::passed, what());
      return true;
    } catch (const LinkError& e) {
      note(name, Verdict::failed, e.what());
    } catch (const core::InputError& e) {
      note(name, Verdict::failed, e.what());
    }
    return false;
  }

  bool greeting() {
    const bool good = examine("greeting", [&] {
      try {
        welcome_ = ConformanceClient(address_).greet(FlightClock::lockstep);
      } catch (const LinkError&) {  // perhaps it flies in real time only
        welcome_ = ConformanceClient(address_).greet(FlightClock::real_time);
      }
      if (welcome_.magic != socket::kMagic || welcome_.version != socket::kVersion)
        throw LinkError(words("version %d, expected %d", welcome_.version, socket::kVersion));
      if (!welcome_.lockstep && !welcome_.real_time)
        throw LinkError("flies neither in lockstep nor in real time");
      return welcome_.description.name + (welcome_.lockstep ? ", lockstep" : "") +
             (welcome_.real_time ? ", real time" : "");
    });
    if (good)
      examine("description", [this] {
        if (const std::string why = implausible(welcome_.description); !why.empty()) throw LinkError(why);
        if (!welcome_.description.lidar && welcome_.description.cameras.empty())
          throw LinkError("neither a LiDAR nor a depth camera: the core cannot map");
        return words("%.2f kg, %.1f N, radius %.2f m, %zu depth cameras%s", welcome_.description.mass_kg,
                     welcome_.description.max_thrust_n, welcome_.description.radius_m,
                     welcome_.description.cameras.size(), welcome_.description.lidar ? ", LiDAR" : "");
      });
    return good;
  }

  FlightClock usual_clock() const {
    return welcome_.lockstep ? FlightClock::lockstep : FlightClock::real_time;
  }

  std::string second_client() {
    ConformanceClient first(address_);
    first.greet(usual_clock());
    ConformanceClient second(address_);
    std::string refusal;
    try {
      second.greet(usual_clock());
    } catch (const LinkError& e) {
      refusal = e.what();
    }
    if (refusal.empty()) throw LinkError("a second client was welcome");
    return refusal;
  }

  std::string other_version() {
    ConformanceClient client(address_);
    socket::Hello hello;
    hello.version = 0xfffe;
    client.say(hello);
    const auto answer = client.hear(Wait(10'000));
    const auto* refuse = answer ? std::get_if<socket::Refuse>(&*answer) : nullptr;
    if (!refuse) throw LinkError("a greeting of version 65534 is not refused");
    return refuse->reason;
  }

  std::string garbage() {
    {
      ConformanceClient client(address_);
      client.say_bytes(std::string(64, '\xff'));
      try {
        for (int i = 0; i < 10; ++i)
          if (!client.hear(Wait(10'000)))
            throw core::InputError(address_.text(), "", "64 bytes of 255 are taken");
      } catch (const LinkError&) {  // so it should
      }
    }
    ConformanceClient client(address_);
    client.greet(usual_clock());
    return "and the next client is welcome";
  }

  void fly(FlightClock clock) {
    const std::string mode = clock == FlightClock::lockstep ? "lockstep: " : "real time: ";
    const auto length = core::from_seconds(options_.seconds);
    std::vector<Heard> heard;
    std::optional<ConformanceClient> client;
    const bool flew = examine(mode + "starts and stands", [&] {
      client.emplace(address_);
      client->greet(clock);
      core::Command off;  // not armed
      if (clock == FlightClock::lockstep) {
        client->start();
        client->fly(length, off, heard);
      } else {
        client->say(socket::Start{});
        client->fly_real_time(length, off, heard);
      }
      if (all_of<socket::Ground>(heard).empty()) throw LinkError("says not that it stands on the ground");
      if (!all_of<socket::LiftOff>(heard).empty()) throw LinkError("lifts off while it is not armed");
      return words("%zu messages in %g s", heard.size(), options_.seconds);
    });
    if (!flew) return;
    examine(mode + "numbers", [&] { return numbers(heard); });
    examine(mode + "order of stamps", [&] { return order(heard); });
    examine(mode + "rates", [&] { return rates(heard); });
    examine(mode + "at rest", [&] { return at_rest(heard); });
    if (clock == FlightClock::lockstep)
      examine(mode + "stamps are not of the future", [&] { return not_of_the_future(heard); });
    else
      examine(mode + "clock", [&] { return clock_of(heard); });
    if (options_.takes_off)
      examine(mode + "comes down when commands stop", [&] { return silence(*client, clock); });
    else
      note(mode + "comes down when commands stop", Verdict::skipped, "not flown; --fly takes off");
  }

  std::string numbers(const std::vector<Heard>& heard) const {
    for (const Heard& h : heard)
      if (const std::string why = implausible(h.message, welcome_.description); !why.empty())
        throw LinkError(words("message at %.3f s: ", core::seconds(h.at)) + why);
    return words("%zu messages, all plausible", heard.size());
  }

  std::string order(const std::vector<Heard>& heard) const {
    std::string wrong = disorder(all_of<core::ImuSample>(heard), "imu");
    if (wrong.empty()) wrong = disorder(all_of<core::MagnetometerSample>(heard), "magnetometer");
    if (wrong.empty()) wrong = disorder(all_of<core::BarometerSample>(heard), "barometer");
    if (wrong.empty()) wrong = disorder(all_of<core::PoseSample>(heard), "pose");
    if (wrong.empty()) wrong = disorder(all_of<core::LidarScan>(heard), "lidar");
    for (std::size_t i = 0; wrong.empty() && i < welcome_.description.cameras.size(); ++i)
      wrong = disorder(of_camera(heard, i), "depth");
    if (!wrong.empty()) throw LinkError(wrong);
    return "grow from message to message";
  }

  static std::vector<const socket::Depth*> of_camera(const std::vector<Heard>& heard, std::size_t camera) {
    std::vector<const socket::Depth*> all = all_of<socket::Depth>(heard);
    std::erase_if(all, [camera](const socket::Depth* d) { return d->camera != camera; });
    return all;
  }

  std::string rates(const std::vector<Heard>& heard) const {
    const double imu_hz = rate_hz(all_of<core::ImuSample>(heard));
    if (imu_hz < kLeastImuRate_hz)
      throw LinkError(words("imu: %.1f Hz; the core needs 50 Hz or more", imu_hz));
    std::string said = words("imu %.0f Hz", imu_hz);
    if (all_of<core::BatteryStatus>(heard).empty()) throw LinkError("battery: nothing");
    if (const auto& lidar = welcome_.description.lidar)
      said += check_rate("lidar", rate_hz(all_of<core::LidarScan>(heard)), lidar->period);
    for (std::size_t i = 0; i < welcome_.description.cameras.size(); ++i)
      said += check_rate("camera", rate_hz(of_camera(heard, i)), welcome_.description.cameras[i]->period);
    if (welcome_.description.pose_sensor) {
      const double pose_hz = rate_hz(all_of<core::PoseSample>(heard));
      if (pose_hz < 5) throw LinkError(words("pose: %.1f Hz; the description has a pose sensor", pose_hz));
      said += words(", pose %.0f Hz", pose_hz);
    }
    return said;
  }

  static std::string check_rate(const char* name, double hz, TimeNs period) {
    const double described_hz = 1 / core::seconds(period);
    if (std::abs(hz - described_hz) > 0.2 * described_hz)
      throw LinkError(words("%s: %.1f Hz; its description says %.1f Hz", name, hz, described_hz));
    return words(", %s %.0f Hz", name, hz);
  }

  std::string at_rest(const std::vector<Heard>& heard) const {
    core::Vec3 force = core::Vec3::Zero(), rate = core::Vec3::Zero();
    const auto imu = all_of<core::ImuSample>(heard);
    for (const core::ImuSample* s : imu) {
      force += s->specific_force_mps2 / static_cast<double>(imu.size());
      rate += s->body_rate_radps / static_cast<double>(imu.size());
    }
    const core::Vec3 up =
        welcome_.description.T_world_start.orientation.conjugate() * core::Vec3(0, 0, kGravity_mps2);
    if ((force - up).norm() > 1.5)
      throw LinkError(
          words("imu: specific force (%.2f %.2f %.2f) m/s^2; standing it is about (%.2f %.2f %.2f)",
                force.x(), force.y(), force.z(), up.x(), up.y(), up.z()));
    if (rate.norm() > 0.1) throw LinkError(words("imu: turns by %.2f rad/s while it stands", rate.norm()));
    return words("specific force %.2f m/s^2, rate %.3f rad/s", force.norm(), rate.norm());
  }

  static std::string not_of_the_future(const std::vector<Heard>& heard) {
    TimeNs oldest = 0;
    for (const Heard& h : heard)
      if (const TimeNs* stamp = socket::stamp_of(h.message)) {
        if (*stamp > h.at)
          throw LinkError(words("a stamp of %.3f s at %.3f s", core::seconds(*stamp), core::seconds(h.at)));
        oldest = std::max(oldest, h.at - *stamp);
      }
    return words("the oldest came after %.0f ms", 1e3 * core::seconds(oldest));
  }

  std::string clock_of(const std::vector<Heard>& heard) const {
    socket::ClockOffset offset;
    TimeNs last = 0;
    for (const Heard& h : heard) {
      last = h.at;
      if (const auto* p = std::get_if<socket::Pong>(&h.message))
        offset.add({p->ping_sent, h.at, p->received, p->sent});
    }
    if (!offset.known()) throw LinkError("fewer than eight pings were answered");
    const TimeNs bound = offset.error_bound(last);
    if (bound > 20 * kMillisecond)
      throw LinkError(words("the offset is known to %.1f ms only: pings must be answered at once",
                            1e3 * core::seconds(bound)));
    const TimeNs ahead = offset.offset(last);
    for (const Heard& h : heard)
      if (const auto* s = std::get_if<core::ImuSample>(&h.message))
        if (const TimeNs late = h.at - (s->stamp - ahead);
            late < -2 * bound - 5 * kMillisecond || late > kSecond)
          throw LinkError(words("imu: its stamp differs by %.3f s from when it came", core::seconds(late)));
    return words("offset known to %.2f ms", 1e3 * core::seconds(bound));
  }

  /// Climbs for 0.6 s with a sixth more thrust than it weighs, and is then silent.
  std::string silence(ConformanceClient& client, FlightClock clock) const {
    core::Command climb;
    climb.rates = {core::Vec3::Zero(), welcome_.description.mass_kg * kGravity_mps2 * 1.17, true};
    std::vector<Heard> heard;
    const auto fly_on = [&](TimeNs time, const std::optional<core::Command>& command) {
      if (clock == FlightClock::lockstep)
        client.fly(client.now() + time, command, heard);
      else
        client.fly_real_time(time, command, heard);
    };
    for (int i = 0; i < 30 && all_of<socket::LiftOff>(heard).empty(); ++i) fly_on(kSecond / 10, climb);
    if (all_of<socket::LiftOff>(heard).empty())
      throw LinkError("does not lift off within 3 s with 1.17 of its weight as thrust");
    fly_on(6 * kSecond / 10, climb);
    heard.clear();
    for (TimeNs silent = 0; silent < kComesDownWithin; silent += kSecond / 2) {
      fly_on(kSecond / 2, std::nullopt);
      if (!all_of<socket::Lost>(heard).empty())
        throw LinkError("it was lost: " + all_of<socket::Lost>(heard)[0]->reason);
      if (!all_of<socket::Ground>(heard).empty())
        return words("stands %.1f s after the last command", core::seconds(silent + kSecond / 2));
    }
    throw LinkError(words("does not stand %.0f s after the last command", core::seconds(kComesDownWithin)));
  }

  socket::Address address_;
  ConformanceOptions options_;
  std::function<void(const Finding&)> report_;
  socket::Welcome welcome_;
  std::vector<Finding> findings_;
};

}  // namespace

std::vector<Finding> check_vehicle(const socket::Address& address, const ConformanceOptions& options,
                                   const std::function<void(const Finding&)>& report) {
  return Examination(address, options, report).run();
}

}  // namespace karst::vehicle_server
