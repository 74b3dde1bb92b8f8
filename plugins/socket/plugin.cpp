#include "core_stack/common/error.h"
#include "core_stack/common/opened_by_key.h"
#include "core_stack/vehicle/vehicle.h"
#include "plugins/socket/lockstep_vehicle.h"
#include "plugins/socket/real_time_vehicle.h"

namespace {

using namespace karst;

struct SocketOptions {
  std::string address;
  double connect_timeout_s = 30, answer_timeout_s = 60, silence_s = 0.5, lost_after_s = 10;
};

socket::Wait wait_of(double seconds) { return socket::Wait(static_cast<socket::Wait::rep>(1000 * seconds)); }

class SocketPlugin final : public core::VehiclePlugin {
 public:
  void describe_options(core::OptionTable& t) override {
    options_ = {};
    t.add("address", options_.address, {}, "where the vehicle listens: tcp:HOST:PORT, tcp:PORT or unix:PATH");
    t.add("connect_timeout", options_.connect_timeout_s, "s", 0.1, 3600,
          "to wait for the vehicle to listen, and for its description");
    t.add("answer_timeout", options_.answer_timeout_s, "s", 0.1, 3600,
          "in lockstep: a vehicle that has not answered for so long is lost");
    t.add("silence", options_.silence_s, "s", 0.1, 60,
          "in real time: without a message for so long, the autopilot is taken to steer");
    t.add("lost_after", options_.lost_after_s, "s", 0.2, 3600,
          "in real time: without a message for so long, the vehicle is lost");
  }

  std::unique_ptr<core::Vehicle> create(const core::VehicleSetup& setup) override {
    const bool lockstep = setup.clock == core::Clock::lockstep;
    socket::Hello hello;
    hello.clock = lockstep ? socket::FlightClock::lockstep : socket::FlightClock::real_time;
    hello.seed = setup.seed;
    hello.climb_m = setup.climb_m;
    hello.client = "karst";
    auto link = core::opened_by_key("vehicle socket", "socket.address", [&] {
      return std::make_unique<socket::VehicleLink>(socket::parse_address(options_.address), hello,
                                                   wait_of(options_.connect_timeout_s));
    });
    if (lockstep)
      return std::make_unique<socket::LockstepVehicle>(std::move(link), wait_of(options_.answer_timeout_s));
    return std::make_unique<socket::RealTimeVehicle>(
        std::move(link), wait_of(options_.answer_timeout_s),
        socket::SilenceLimits{core::from_seconds(options_.silence_s),
                              core::from_seconds(options_.lost_after_s)});
  }

 private:
  SocketOptions options_;
};

}  // namespace

KARST_VEHICLE_PLUGIN(SocketPlugin)
