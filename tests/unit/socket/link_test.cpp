// Core and vehicle over a real socket: the order of what happens, and what each side does when the other is
// bad.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <unistd.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <thread>

#include "core_stack/common/error.h"
#include "plugins/socket/lockstep_vehicle.h"
#include "plugins/socket/real_time_vehicle.h"
#include "plugins/socket/vehicle_server.h"

namespace karst::socket {
namespace {

using core::kMillisecond;
using core::kSecond;
using core::TimeNs;

const std::atomic<bool> kGoOn{false};

/// A folder for sockets, and a thread that plays the other side.
class Peer {
 public:
  using Play = std::function<void(Listener&)>;
  explicit Peer(Play play)
      : folder_("/tmp/karst_link_" + std::to_string(getpid()) + "_" + std::to_string(++count)),
        listener_(parse_address("unix:" + folder_)),
        thread_([this, play = std::move(play)] { play(listener_); }) {}
  const Address& address() const { return listener_.address(); }

 private:
  static inline int count = 0;
  std::string folder_;
  Listener listener_;
  std::jthread thread_;
};

/// Writes down what it is told, with the time.
class Log final : public core::VehicleSink {
 public:
  std::vector<std::string> lines;
  core::Executive* executive = nullptr;
  std::function<void()> on_each = [] {};
  std::vector<TimeNs> imu_stamps, imu_ages;

  void note(const std::string& what) {
    lines.push_back(std::to_string(executive->now()) + " " + what);
    on_each();
  }
  void on_lidar(std::shared_ptr<const core::LidarScan> s) override {
    note("lidar " + std::to_string(s->stamp));
  }
  void on_depth(std::shared_ptr<const core::DepthImage> s) override {
    note("depth of " + s->model->name + " " + std::to_string(s->stamp));
  }
  void on_imu(const core::ImuSample& s) override {
    imu_stamps.push_back(s.stamp);
    imu_ages.push_back(executive->now() - s.stamp);
    note("imu " + std::to_string(s.stamp));
  }
  void on_magnetometer(const core::MagnetometerSample&) override { note("magnetometer"); }
  void on_pose(const core::PoseSample&) override { note("pose"); }
  void on_battery(const core::BatteryStatus& s) override { note("battery " + std::to_string(s.power_w)); }
  void on_ground(TimeNs) override { note("ground"); }
  void on_lift_off(TimeNs) override { note("lift-off"); }
  void on_authority(TimeNs, core::Authority who, const std::string& reason) override {
    note(std::string("authority ") + core::name_of(who) + ": " + reason);
  }
  void on_lost(TimeNs, core::MissionOutcome outcome, const std::string& reason) override {
    note(std::string(core::name_of(outcome)) + ": " + reason);
  }
  bool says(const std::string& part) const {
    return std::any_of(lines.begin(), lines.end(),
                       [&](const std::string& line) { return line.find(part) != std::string::npos; });
  }
};

core::VehicleDescription description() {
  core::VehicleDescription v;
  v.name = "fake";
  core::LidarModel lidar;
  lidar.columns = 2;
  lidar.elevation_rad = {0};
  v.lidar = std::make_shared<const core::LidarModel>(lidar);
  return v;
}

/// A vehicle that does what a seed says: periodic steps, single ones and jobs, some due at the same time. It
/// lands and lifts off, and writes down when commands reached it.
class FakeVehicle final : public core::Vehicle {
 public:
  enum class LiftsOff { at_random, when_armed };
  explicit FakeVehicle(std::uint64_t seed, std::vector<std::string>* heard = nullptr,
                       LiftsOff lifts_off = LiftsOff::at_random)
      : random_(seed), heard_(heard), lifts_off_(lifts_off), description_(socket::description()) {}
  core::VehicleDescription description() const override { return description_; }
  void start(core::Executive& e, core::VehicleSink& sink) override {
    executive_ = &e;
    sink_ = &sink;
    e.at(e.now(), [this] { sink_->on_ground(executive_->now()); });
    for (const TimeNs period : {5 * kMillisecond, 15 * kMillisecond})
      e.every("fake", period, period, [this] { tick(); });
  }
  void command(const core::Command& c) override {
    commanded_at_ = executive_->now();
    const bool arms = c.rates.armed && !armed_;
    armed_ = c.rates.armed;
    if (heard_) heard_->push_back(std::to_string(executive_->now()) + " " + std::to_string(c.rates.thrust_n));
    if (arms && lifts_off_ == LiftsOff::when_armed) sink_->on_lift_off(executive_->now());
  }
  void finish() override {
    if (heard_) heard_->push_back("finished");
  }

 private:
  std::size_t one_of(std::size_t n) { return random_() % n; }
  void tick() {
    const TimeNs now = executive_->now();
    core::ImuSample imu;
    imu.stamp = now;
    sink_->on_imu(imu);
    if (armed_ && now - commanded_at_ > core::kCommandTimeout) {
      armed_ = false;
      if (heard_) heard_->push_back("came down");
      sink_->on_ground(now);
    }
    switch (one_of(6)) {
      case 0:
        return executive_->at(now + static_cast<TimeNs>(one_of(4)) * 5 * kMillisecond, [this] {
          core::BatteryStatus b;
          b.power_w = static_cast<double>(one_of(100));
          sink_->on_battery(b);
        });
      case 1:
        return executive_->job(
            "fake", core::Lane::sensing, 10 * kMillisecond, [] {},
            [this, now] {
              auto scan = std::make_shared<core::LidarScan>();
              scan->stamp = now;
              scan->range_m = {1, 2};
              scan->intensity = {0, 1};
              sink_->on_lidar(scan);
            });
      case 2:
        return sink_->on_lift_off(now);
      default:
        return;
    }
  }
  std::mt19937_64 random_;
  std::vector<std::string>* heard_;
  LiftsOff lifts_off_;
  core::VehicleDescription description_;
  core::Executive* executive_ = nullptr;
  core::VehicleSink* sink_ = nullptr;
  TimeNs commanded_at_ = 0;
  bool armed_ = false;
};

/// A core that commands at 100 Hz and at each lift-off, and schedules much at the same times as the vehicle.
std::vector<std::string> fly(core::Vehicle& vehicle, TimeNs length) {
  core::Executive executive(1);
  Log log;
  log.executive = &executive;
  double thrust = 0;
  const auto command = [&] {
    core::Command c;
    c.rates.thrust_n = ++thrust;
    vehicle.command(c);
  };
  log.on_each = [&] {
    if (log.lines.back().ends_with("lift-off")) command();
    if (log.lines.size() % 3 == 0)
      executive.at(executive.now() + 10 * kMillisecond, [&log] { log.lines.push_back("core's own"); });
  };
  vehicle.start(executive, log);
  executive.every("control", 10 * kMillisecond, 10 * kMillisecond, [&] {
    log.lines.push_back(std::to_string(executive.now()) + " control");
    command();
  });
  executive.run_until(length, [] { return false; });
  vehicle.finish();
  return log.lines;
}

std::unique_ptr<VehicleLink> link_to(const Address& address, FlightClock clock = FlightClock::lockstep) {
  Hello hello;
  hello.clock = clock;
  return std::make_unique<VehicleLink>(address, hello, Wait(5000));
}

TEST(Lockstep, IsInTheOrderOfOneProcess) {
  rc::check([] {
    const auto seed = *rc::gen::arbitrary<std::uint64_t>();
    const TimeNs length = *rc::gen::inRange<TimeNs>(1, 500) * kMillisecond;
    std::vector<std::string> heard, heard_by_socket;
    FakeVehicle in_process(seed, &heard);
    const auto expected = fly(in_process, length);
    std::vector<std::string> got;
    {
      const Peer peer([&](Listener& listener) {
        auto client = listener.accept(Wait(5000));
        serve_client(
            *client, [&](const Hello&) { return std::make_unique<FakeVehicle>(seed, &heard_by_socket); }, {},
            kGoOn);
      });
      LockstepVehicle vehicle(link_to(peer.address()), Wait(5000));
      got = fly(vehicle, length);
    }
    RC_ASSERT(got == expected);
    RC_ASSERT(heard_by_socket == heard);
  });
}

/// What `play` sends instead of a greeting makes the core refuse to fly.
std::string refusal(std::function<void(Stream&)> play) {
  const Peer peer([&play](Listener& listener) {
    auto client = listener.accept(Wait(5000));
    play(*client);
    try {
      for (;;) client->receive(Wait(5000));
    } catch (const LinkError&) {
    }
  });
  try {
    Hello hello;
    const VehicleLink link(peer.address(), hello, Wait(300));
    return "";
  } catch (const core::InputError& e) {
    const std::string words = e.what();
    EXPECT_TRUE(words.starts_with(peer.address().text() + ": ")) << words;
    return words.substr(peer.address().text().size() + 2);
  }
}

template <class M>
void say(Stream& stream, const M& message) {
  stream.queue(message);
  stream.flush(Wait(1000));
}
void say_bytes(Stream& stream, const std::string& bytes) {
  stream.queue_bytes(bytes);
  stream.flush(Wait(1000));
}
Welcome welcome() {
  Welcome w;
  w.lockstep = w.real_time = true;
  w.description = description();
  return w;
}

TEST(BadVehicle, IsRefusedBeforeTakeOffWithTheReason) {
  EXPECT_EQ(refusal([](Stream& s) { say_bytes(s, std::string(40, 'G')); }),
            "this is no message of the protocol: type 18247 with 1195853639 bytes");
  EXPECT_EQ(refusal([](Stream& s) { say_bytes(s, std::string("\x05\0\0\0\x20\0\0\0ab", 10)); }),
            "connected, but it does not greet");
  EXPECT_EQ(refusal([](Stream& s) { say(s, Done{}); }), "what answers there is no vehicle of karst");
  EXPECT_EQ(refusal([](Stream& s) { say(s, Refuse{"rotors are off\x1b[2J"}); }),
            "the vehicle refuses: rotors are off?[2J");
  EXPECT_EQ(refusal([](Stream& s) {
              Welcome w = welcome();
              w.version = 7;
              say(s, w);
            }),
            "it speaks version 7 of the protocol, and this karst 1");
  EXPECT_EQ(refusal([](Stream& s) {
              Welcome w = welcome();
              w.lockstep = false;
              say(s, w);
            }),
            "this vehicle flies in real time only: fly with --real-time");
  EXPECT_EQ(
      refusal([](Stream& s) {
        Welcome w = welcome();
        core::LidarModel lidar = *w.description.lidar;
        lidar.columns = 0;
        w.description.lidar = std::make_shared<const core::LidarModel>(lidar);
        say(s, w);
      }),
      "its description is wrong: lidar: elevation_rad: expected two without rings, of the highest and the "
      "lowest beam");
  EXPECT_EQ(refusal([](Stream&) {}), "connected, but it does not greet");
}

TEST(BadVehicle, ThatIsNotThereIsAnError) {
  Hello hello;
  try {
    const VehicleLink link(parse_address("unix:/tmp/karst_nobody_listens_here"), hello, Wait(1));
    FAIL();
  } catch (const core::InputError& e) {
    EXPECT_STREQ(e.what(),
                 "unix:/tmp/karst_nobody_listens_here: no vehicle answers there: No such file or directory");
  }
}

/// A vehicle that greets well, and then does `play` after start. Returns what the core was told.
std::vector<std::string> flown_with(std::function<void(Stream&)> play, Wait patience = Wait(5000)) {
  const Peer peer([&play](Listener& listener) {
    auto client = listener.accept(Wait(5000));
    say(*client, welcome());
    play(*client);
    try {
      for (;;)
        if (!client->receive(Wait(2000))) return;
    } catch (const LinkError&) {
    }
  });
  LockstepVehicle vehicle(link_to(peer.address()), patience);
  auto lines = fly(vehicle, 50 * kMillisecond);
  std::erase_if(lines, [&](std::string& line) {
    if (const auto at = line.find(peer.address().text() + ": "); at != std::string::npos)
      line.erase(at, peer.address().text().size() + 2);
    return line.find("control") != std::string::npos || line == "core's own";
  });
  return lines;
}

TEST(BadVehicle, InFlightIsLostWithTheReason) {
  using Lines = std::vector<std::string>;
  const auto begins = [](Stream& s) {
    say(s, Schedule{0, 20 * kMillisecond, 20 * kMillisecond});
    say(s, Done{});
  };
  EXPECT_EQ(flown_with([](Stream&) {}, Wait(100)), Lines{"0 lost: the vehicle has not answered for 0 s"});
  EXPECT_EQ(flown_with([&](Stream& s) {
              begins(s);
              say_bytes(s, std::string(16, '\xff'));
            }),
            Lines{"20000000 lost: this is no message of the protocol: type 65535 with 4294967295 bytes"});
  EXPECT_EQ(flown_with([&](Stream& s) {
              begins(s);
              say_bytes(s, std::string("\x03\0\0\0\x30\0\0\0abc", 11));
            }),
            Lines{"20000000 lost: it sent what is no message: imu: stamp is cut off or not valid"});
  EXPECT_EQ(flown_with([&](Stream& s) {
              begins(s);
              say(s, Bye{"no fuel"});
            }),
            Lines{"20000000 lost: the vehicle left: no fuel"});
  EXPECT_EQ(flown_with([&](Stream& s) {
              begins(s);
              say(s, Schedule{1, 10 * kMillisecond, 0});
            }),
            Lines{"20000000 lost: the vehicle schedules what cannot be: a time that is past, or a period "
                  "below 1 ms"});
}

TEST(BadVehicle, WhoseNumbersCannotBeLosesTheMessageOnly) {
  const Peer peer([](Listener& listener) {
    auto client = listener.accept(Wait(5000));
    say(*client, welcome());
    say(*client, Schedule{0, 20 * kMillisecond, 0});
    say(*client, Checks{{{"rotors", "four", "four", true}}});
    say(*client, Done{});
    core::ImuSample imu;
    say(*client, imu);
    imu.specific_force_mps2.x() = std::nan("");
    say(*client, imu);
    say(*client, Done{20 * kMillisecond});
    try {
      while (client->receive(Wait(2000))) {
      }
    } catch (const LinkError&) {
    }
  });
  LockstepVehicle vehicle(link_to(peer.address()), Wait(5000));
  auto lines = fly(vehicle, 50 * kMillisecond);
  std::erase_if(lines, [](const std::string& line) { return line.find("imu") == std::string::npos; });
  EXPECT_EQ(lines, std::vector<std::string>{"20000000 imu 0"});
  const auto checks = vehicle.checks();
  ASSERT_EQ(checks.size(), 2u);
  EXPECT_EQ(checks[0].name, "rotors");
  EXPECT_EQ(checks[1].found, "1 dropped, the first: message 48: is no number");
  EXPECT_FALSE(checks[1].holds);
}

TEST(BadVehicle, ThatNeverLetsTimePassIsLost) {
  const auto lines = flown_with([](Stream& s) {
    say(s, Schedule{0, 0, 0});
    say(s, Done{});
    for (int i = 0; i < 2000; ++i) {
      s.queue(Schedule{0, 0, 0});
      s.queue(Done{});
    }
    s.flush(Wait(2000));
  });
  EXPECT_EQ(lines,
            std::vector<std::string>{"0 lost: the vehicle schedules without end, so that no time passes"});
}

/// What the vehicle's side does of a client that says `play`: its ending, and what the vehicle heard.
struct ServedClient {
  Served served;
  std::vector<std::string> vehicle;
  bool came_down() const { return std::find(vehicle.begin(), vehicle.end(), "came down") != vehicle.end(); }
};
ServedClient serve(std::function<void(Stream&)> play, const ServeOptions& options = {}) {
  ServedClient all;
  {
    const Peer peer([&](Listener& listener) {
      auto client = listener.accept(Wait(5000));
      all.served = serve_client(
          *client,
          [&](const Hello&) {
            return std::make_unique<FakeVehicle>(1, &all.vehicle, FakeVehicle::LiftsOff::when_armed);
          },
          options, kGoOn);
    });
    Stream stream = connect_to(peer.address(), Wait(5000), kMaxToCoreBytes);
    try {
      play(stream);
    } catch (const LinkError&) {  // the vehicle's side has closed
    }
  }
  return all;
}
/// Waits for a message of type M; the vehicle goes on meanwhile.
template <class M>
void wait_for(Stream& stream) {
  for (;;) {
    while (const auto frame = stream.next()) {
      if (frame->type == kType<Pause>.id) say(stream, Resume{});
      if (frame->type == kType<M>.id) return;
    }
    if (!stream.receive(Wait(5000))) throw LinkError("the vehicle has not answered");
  }
}
void greet_and_lift_off(Stream& stream) {
  say(stream, Hello{});
  say(stream, Start{});
  wait_for<Done>(stream);
  say(stream, socket::Run{0, 0});
  wait_for<Done>(stream);
  core::Command c;
  c.rates.armed = true;
  say(stream, c);
  wait_for<Pause>(stream);  // by which the vehicle says that it has lifted off
}

TEST(BadClient, IsRefusedWithTheReason) {
  EXPECT_EQ(serve([](Stream& s) { say_bytes(s, std::string(64, 'x')); }).served.ending,
            "this is no message of the protocol: type 30840 with 2021161080 bytes");
  EXPECT_EQ(serve([](Stream& s) { say(s, socket::Run{}); }).served.ending,
            "expected a greeting of the protocol of karst vehicles");
  EXPECT_EQ(serve([](Stream& s) {
              Hello hello;
              hello.version = 2;
              say(s, hello);
            }).served.ending,
            "this vehicle speaks version 1 of the protocol, and the client 2");
  ServeOptions hasty;
  hasty.greeting_patience = Wait(50);
  EXPECT_EQ(serve([](Stream&) { std::this_thread::sleep_for(Wait(400)); }, hasty).served.ending,
            "the client has sent nothing for 0 s");
  EXPECT_EQ(serve([](Stream& s) {
              say(s, Hello{});
              say(s, core::Command{});
              while (s.receive(Wait(300))) {
              }
            }).served.ending,
            "the client sent a message that has no place there");
}

TEST(BadClient, InFlightLeavesAVehicleThatComesDown) {
  const auto leaves = serve([](Stream& s) { greet_and_lift_off(s); });
  EXPECT_TRUE(leaves.served.flew);
  EXPECT_EQ(leaves.served.ending, "the other side closed the connection");
  EXPECT_TRUE(leaves.came_down());
  EXPECT_EQ(leaves.vehicle.back(), "finished");

  const auto garbage = serve([](Stream& s) {
    greet_and_lift_off(s);
    say_bytes(s, std::string(64, '\xff'));
  });
  EXPECT_EQ(garbage.served.ending, "this is no message of the protocol: type 65535 with 4294967295 bytes");
  EXPECT_TRUE(garbage.came_down());

  const auto cut = serve([](Stream& s) {
    greet_and_lift_off(s);
    say_bytes(s, std::string("\x0c\0\0\0\x03\0\0\0\x01", 9));
  });
  EXPECT_EQ(cut.served.ending, "the other side closed the connection within a message");
  EXPECT_TRUE(cut.came_down());

  const auto out_of_order = serve([](Stream& s) {
    greet_and_lift_off(s);
    say(s, socket::Run{77, kMillisecond});
    while (s.receive(Wait(300))) {
    }
  });
  EXPECT_EQ(out_of_order.served.ending, "the client asked for a slot that is not due next");
  EXPECT_TRUE(out_of_order.came_down());

  ServeOptions hasty;
  hasty.lockstep_patience = Wait(50);
  const auto silent = serve(
      [](Stream& s) {
        greet_and_lift_off(s);
        std::this_thread::sleep_for(Wait(400));
      },
      hasty);
  EXPECT_EQ(silent.served.ending, "the client has sent nothing for 0 s");
  EXPECT_TRUE(silent.came_down());
}

TEST(BadClient, WhoseCommandIsNoNumberIsNotObeyed) {
  const auto all = serve([](Stream& s) {
    greet_and_lift_off(s);
    core::Command c;
    c.rates.thrust_n = std::nan("");
    say(s, c);
    say(s, Bye{"done"});
  });
  EXPECT_EQ(all.vehicle.front(), "0 0.000000");
  EXPECT_EQ(std::count_if(all.vehicle.begin(), all.vehicle.end(),
                          [](const std::string& line) { return line.find("nan") != std::string::npos; }),
            0);
}

TEST(Server, RefusesASecondClientMeanwhile) {
  const Peer peer([&](Listener& listener) {
    auto client = listener.accept(Wait(5000));
    const Doorkeeper doorkeeper(listener);
    serve_client(
        *client, [](const Hello&) { return std::make_unique<FakeVehicle>(1); }, {}, kGoOn);
  });
  auto first = link_to(peer.address());
  try {
    link_to(peer.address());
    FAIL();
  } catch (const core::InputError& e) {
    EXPECT_EQ(std::string(e.what()),
              peer.address().text() + ": the vehicle refuses: another client flies this vehicle");
  }
  first->leave("done");
}

/// The vehicle's clock is a second ahead or behind: stamps are those of the core.
TEST(RealTime, StampsAreOfTheCoresClock) {
  for (const TimeNs ahead : {kSecond, -kSecond}) {
    const Peer peer([ahead](Listener& listener) {
      auto client = listener.accept(Wait(5000));
      const auto begin = std::chrono::steady_clock::now();
      const auto now = [&] {
        return ahead +
               std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - begin)
                   .count();
      };
      try {
        say(*client, welcome());
        for (;;) {
          client->receive(Wait(1));
          while (const auto frame = client->next()) {
            std::string problem;
            const auto message = read_message<ToVehicle>(*frame, problem);
            if (const auto* ping = std::get_if<Ping>(&*message)) say(*client, Pong{ping->sent, now(), now()});
            if (std::holds_alternative<Bye>(*message)) return;
          }
          core::ImuSample imu;
          imu.stamp = now();
          say(*client, imu);
        }
      } catch (const LinkError&) {
      }
    });
    RealTimeVehicle vehicle(link_to(peer.address(), FlightClock::real_time), Wait(5000), {});
    core::Executive executive(1, core::Clock::real_time);
    Log log;
    log.executive = &executive;
    vehicle.start(executive, log);
    executive.run_until(60 * kSecond, [&] { return log.imu_stamps.size() > 150; });
    vehicle.finish();
    ASSERT_GT(log.imu_stamps.size(), 150u);
    for (const TimeNs age : log.imu_ages) EXPECT_GE(age, 0) << "a stamp of the future";
    auto ages = log.imu_ages;
    std::nth_element(ages.begin(), ages.begin() + 75, ages.end());
    EXPECT_LT(ages[75], kSecond / 2) << "a clock that is not converted would be a second off";
    EXPECT_TRUE(std::is_sorted(log.imu_stamps.begin(), log.imu_stamps.end()));
  }
}

/// Silent for longer than `silence`: the autopilot steers; heard again: the core does; silent for good: lost.
TEST(RealTime, ASilentVehicleIsGivenToItsAutopilotAndThenLost) {
  const Peer peer([](Listener& listener) {
    auto client = listener.accept(Wait(5000));
    try {
      say(*client, welcome());
      std::this_thread::sleep_for(Wait(700));
      for (int answered = 0; answered < 8;) {
        while (const auto frame = client->next()) {
          std::string problem;
          const auto message = read_message<ToVehicle>(*frame, problem);
          const auto* ping = std::get_if<Ping>(&*message);
          if (ping && answered++ < 8) say(*client, Pong{ping->sent, 0, 0});
        }
        client->receive(Wait(5000));
      }
      for (;;)
        if (!client->receive(Wait(5000))) return;
    } catch (const LinkError&) {
    }
  });
  RealTimeVehicle vehicle(link_to(peer.address(), FlightClock::real_time), Wait(5000),
                          {kSecond / 10, 3 * kSecond / 2});
  core::Executive executive(1, core::Clock::real_time);
  Log log;
  log.executive = &executive;
  vehicle.start(executive, log);
  core::Command command;
  command.state_is_known = true;
  executive.every("control", 10 * kMillisecond, 10 * kMillisecond, [&] { vehicle.command(command); });
  executive.run_until(60 * kSecond, [&] { return log.says("lost"); });
  ASSERT_GE(log.lines.size(), 4u);
  EXPECT_NE(log.lines[0].find("authority autopilot: no message from the vehicle for 0.1 s"),
            std::string::npos);
  EXPECT_NE(log.lines[1].find("authority core: the vehicle and the core hear each other again"),
            std::string::npos);
  EXPECT_NE(log.lines[2].find("authority autopilot"), std::string::npos);
  EXPECT_NE(log.lines[3].find("no message from the vehicle for 1.5 s"), std::string::npos);
}

/// A core that stood still for longer than kCommandTimeout says so before it takes what came meanwhile, sends
/// nothing of what was due then, and does not take its own silence for the vehicle's.
TEST(RealTime, ACoreThatStoodStillGivesTheVehicleToItsAutopilotFirst) {
  std::atomic<int> late_commands = 0;
  std::atomic<bool> stands_still = false;
  const Peer peer([&](Listener& listener) {
    auto client = listener.accept(Wait(5000));
    try {
      say(*client, welcome());
      for (;;) {
        client->receive(Wait(5));
        while (const auto frame = client->next()) {
          std::string problem;
          const auto message = read_message<ToVehicle>(*frame, problem);
          if (const auto* ping = std::get_if<Ping>(&*message)) say(*client, Pong{ping->sent, 1, 1});
          if (std::holds_alternative<core::Command>(*message) && stands_still) ++late_commands;
          if (std::holds_alternative<Bye>(*message)) return;
        }
        say(*client, core::BatteryStatus{});
      }
    } catch (const LinkError&) {
    }
  });
  RealTimeVehicle vehicle(link_to(peer.address(), FlightClock::real_time), Wait(5000),
                          {600 * kMillisecond, 800 * kMillisecond});
  core::Executive executive(1, core::Clock::real_time);
  Log log;
  log.executive = &executive;
  vehicle.start(executive, log);
  executive.every("control", 10 * kMillisecond, 10 * kMillisecond, [&] { vehicle.command({}); });
  executive.at(kSecond / 5, [&] {
    std::this_thread::sleep_for(Wait(200));  // until what was sent before has come
    stands_still = true;
    std::this_thread::sleep_for(Wait(700));  // in all longer than a vehicle may be silent
  });
  executive.at(900 * kMillisecond, [&] { stands_still = false; });
  executive.run_until(30 * kSecond, [&] { return !stands_still && log.says("authority autopilot: "); });
  vehicle.finish();
  EXPECT_FALSE(log.says("lost"));
  const auto given = std::find_if(log.lines.begin(), log.lines.end(), [](const std::string& line) {
    return line.find("authority autopilot: the core was 0.5 s late") != std::string::npos;
  });
  ASSERT_NE(given, log.lines.end());
  EXPECT_EQ(late_commands, 0);
}

/// In real time the vehicle hears nothing for longer than kCommandTimeout, and comes down.
TEST(RealTime, AVehicleWhoseClientIsGoneComesDown) {
  const auto all = serve([](Stream& s) {
    Hello hello;
    hello.clock = FlightClock::real_time;
    say(s, hello);
    say(s, Start{});
    wait_for<Done>(s);
    core::Command c;
    c.rates.armed = true;
    say(s, c);
    s.receive(Wait(100));
  });
  EXPECT_TRUE(all.served.flew);
  EXPECT_EQ(all.vehicle.back(), "finished");
}

/// Time that passes only when the executive waits, or a step of the test says so.
class FakeClock final : public core::WallClock {
 public:
  TimeNs now() const override { return now_; }
  void sleep_until(TimeNs time) const override { now_ = std::max(now_, time); }
  void pass(TimeNs duration) { now_ += duration; }

 private:
  mutable TimeNs now_ = 12345 * kSecond;
};

/// Of a core that knows where it is.
core::Command known() {
  core::Command command;
  command.state_is_known = true;
  return command;
}

/// Core and vehicle in real time on one thread, with a clock of the test. The vehicle's clock is a second
/// ahead; it answers pings at once, and says what it measures every 10 ms.
struct OneThread {
  FakeClock clock;
  core::Executive executive{1, core::Clock::real_time, {.clock = &clock}};
  Log log;
  std::optional<Stream> vehicle;  // its end
  std::unique_ptr<RealTimeVehicle> core;
  VehicleLink* link = nullptr;  // of `core`
  bool answers = true;
  int commands = 0;

  OneThread() {
    Peer greeter([this](Listener& listener) {
      vehicle = listener.accept(Wait(5000));
      say(*vehicle, welcome());
    });
    auto made = link_to(greeter.address(), FlightClock::real_time);
    link = made.get();
    core = std::make_unique<RealTimeVehicle>(std::move(made), Wait(5000), SilenceLimits{});
    log.executive = &executive;
  }
  void start() {
    core->start(executive, log);
    executive.every("control", 10 * kMillisecond, 10 * kMillisecond, [this] { core->command(known()); });
    executive.every("peer", kMillisecond, kMillisecond, [this] { answer(); });
    executive.every("peer measures", 10 * kMillisecond, 10 * kMillisecond, [this] { measure(); });
  }
  void run_until(TimeNs time) {
    executive.run_until(time, [] { return false; });
  }
  TimeNs vehicle_now() const { return clock.now() + kSecond; }
  void measure() {
    core::ImuSample imu;
    imu.stamp = vehicle_now();
    say(*vehicle, imu);
  }
  void answer() {
    while (vehicle->receive(Wait(0))) {
    }
    while (const auto frame = vehicle->next()) {
      std::string problem;
      const auto message = read_message<ToVehicle>(*frame, problem);
      if (const auto* ping = std::get_if<Ping>(&*message); ping && answers)
        say(*vehicle, Pong{ping->sent, vehicle_now(), vehicle_now()});
      if (std::holds_alternative<core::Command>(*message)) ++commands;
    }
  }
};

/// Executive::lost_time(): no step sees that it is late, and the clock is set back. Commands were not sent
/// for half an hour after that.
TEST(RealTime, ACoreWhoseClockWasSetBackSteersAgainAndStampsByTheNewClock) {
  OneThread t;
  t.start();
  t.executive.at(500 * kMillisecond, [&] {
    for (int i = 0; i < 150; ++i) {  // what the vehicle measures while the core stands still
      t.clock.pass(10 * kMillisecond);
      t.measure();
    }
  });
  t.run_until(499 * kMillisecond);
  EXPECT_GT(t.commands, 35);
  t.run_until(1500 * kMillisecond);  // it steers again once it has known its state for a while
  EXPECT_EQ(t.executive.lost_time(), 1500 * kMillisecond);
  EXPECT_TRUE(t.log.says("authority autopilot: the core stood still for 1.5 s")) << t.log.lines.size();
  EXPECT_TRUE(t.log.says("authority core: the vehicle and the core hear each other again"));
  t.commands = 0;
  t.run_until(2500 * kMillisecond);
  EXPECT_GE(t.commands, 99) << "a hundred a second";
  EXPECT_TRUE(std::is_sorted(t.log.imu_stamps.begin(), t.log.imu_stamps.end()));
  for (const TimeNs age : t.log.imu_ages) {
    EXPECT_GE(age, 0);
    EXPECT_LE(age, 5 * kMillisecond);
  }
  EXPECT_LE(t.log.imu_ages.size(), 251u) << "what was measured meanwhile is out of date";
  EXPECT_FALSE(t.log.says("lost"));
}

/// A vehicle cannot hold up a step, whatever it sends: the core reads 64 messages a step.
TEST(BadVehicle, WhosePongsFloodTheCoreHoldsUpNoStep) {
  OneThread t;
  t.start();
  t.run_until(100 * kMillisecond);
  for (int i = 0; i < 1000; ++i) say(*t.vehicle, Pong{i, i, i});
  say(*t.vehicle, Lost{});
  const TimeNs began = t.executive.now();
  t.executive.run_until(60 * kSecond, [&] { return t.log.says("lost: "); });
  EXPECT_GE(t.executive.now() - began, 1000 / 64 * 2 * kMillisecond);
  EXPECT_LE(t.executive.now() - began, 100 * kMillisecond);
}

TEST(BadVehicle, WhoseImplausibleMessagesFloodTheCoreHoldsUpNoStep) {
  OneThread t;
  t.start();
  t.run_until(100 * kMillisecond);
  core::ImuSample imu;
  imu.specific_force_mps2.x() = std::nan("");
  for (int i = 0; i < 1000; ++i) say(*t.vehicle, imu);
  t.run_until(t.executive.now() + 4 * kMillisecond);
  const std::string found = t.link->plausibility().found;
  EXPECT_GE(std::stoi(found), 64) << found;
  EXPECT_LE(std::stoi(found), 3 * 64) << found;
}

TEST(BadVehicle, WhoseMeasurementsFloodTheCoreBeforeItsFirstPongHoldsUpNoStep) {
  OneThread t;
  t.answers = false;
  t.start();
  for (int i = 0; i < 1000; ++i) t.measure();
  say(*t.vehicle, Lost{});
  t.executive.run_until(60 * kSecond, [&] { return t.log.says("lost: "); });
  EXPECT_GE(t.executive.now(), 1000 / 64 * 2 * kMillisecond);
  EXPECT_LE(t.executive.now(), 100 * kMillisecond);
  EXPECT_TRUE(t.log.imu_stamps.empty());
}

/// Times near the ends of 64 bits, and answers to pings that were never sent, are not believed.
TEST(BadVehicle, WhoseTimesCannotBeIsNotBelieved) {
  OneThread t;
  t.start();
  t.run_until(500 * kMillisecond);
  const TimeNs least = std::numeric_limits<TimeNs>::min(), most = std::numeric_limits<TimeNs>::max();
  for (const TimeNs wild : {least, least + 1, -kMaxTime, kMaxTime, most - 1, most}) {
    for (const TimeNs other : {least, TimeNs{0}, most}) say(*t.vehicle, Pong{wild, other, other});
    say(*t.vehicle, Pong{t.executive.now(), wild, wild});
    say(*t.vehicle, Pong{t.executive.now() - 10 * kMillisecond, 7 * kSecond, 7 * kSecond});
    core::ImuSample imu;
    imu.stamp = wild;
    say(*t.vehicle, imu);
  }
  t.run_until(kSecond);
  ASSERT_FALSE(t.log.imu_ages.empty());
  for (const TimeNs age : t.log.imu_ages) {
    EXPECT_GE(age, 0);
    EXPECT_LE(age, 5 * kMillisecond);
  }
}

TEST(OutstandingPings, AreAnsweredOnce) {
  OutstandingPings pings;
  EXPECT_FALSE(pings.answered(0));
  EXPECT_FALSE(pings.answered(-1)) << "none";
  for (TimeNs t = 0; t < 70; ++t) pings.note(t);
  EXPECT_FALSE(pings.answered(5)) << "given up";
  EXPECT_TRUE(pings.answered(6));
  EXPECT_FALSE(pings.answered(6));
  EXPECT_TRUE(pings.answered(69));
  EXPECT_FALSE(pings.answered(70));
  pings.clear();
  EXPECT_FALSE(pings.answered(50));
}

/// What is sent was kept until all was sent, which never is for a client that always lags.
TEST(Stream, ForAClientThatAlwaysLagsKeepsOnlyWhatIsNotSent) {
  std::optional<Stream> writer;
  std::optional<Stream> reader;
  {
    const Peer peer([&](Listener& listener) { writer = listener.accept(Wait(5000)); });
    reader = connect_to(peer.address(), Wait(5000), kMaxToCoreBytes);
  }
  const std::string piece = [] {
    std::string bytes;
    core::LidarScan scan;
    scan.range_m.assign(250'000, 1);
    append_message(bytes, scan);
    return bytes;
  }();
  std::size_t read = 0, written = 0;
  for (int i = 0; i < 12; ++i, ++written) writer->queue_bytes(piece);
  for (int round = 0; round < 60; ++round, ++written) {
    writer->queue_bytes(piece);
    for (const std::size_t before = read; read == before;) {
      EXPECT_FALSE(writer->flush(Wait(0))) << "it always lags";
      while (reader->next()) ++read;
      reader->receive(Wait(0));
    }
    EXPECT_LE(writer->held_bytes(), 2 * writer->backlog_bytes() + (1 << 20));
  }
  while (read < written) {
    writer->flush(Wait(0));
    while (reader->next()) ++read;
    reader->receive(Wait(0));
  }
  EXPECT_EQ(writer->held_bytes(), 0u);
}

/// Sends `scans` of 8 MB each at its first steps, 5 ms apart, and stands after 600 ms.
class LoudVehicle final : public core::Vehicle {
 public:
  LoudVehicle(int scans, std::atomic<int>& steps, TimeNs& longest_pause)
      : scans_(scans), steps_(steps), longest_pause_(longest_pause) {}
  core::VehicleDescription description() const override { return socket::description(); }
  void start(core::Executive& e, core::VehicleSink& sink) override {
    e.at(e.now(), [&] { sink.on_lift_off(e.now()); });
    e.at(600 * kMillisecond, [&] { sink.on_ground(e.now()); });
    e.every("loud", 5 * kMillisecond, 5 * kMillisecond, [&] {
      const TimeNs now = core::machine_clock().now();
      longest_pause_ = std::max(longest_pause_, now - std::exchange(before_, now));
      if (++steps_ > scans_) return;
      auto scan = std::make_shared<core::LidarScan>();
      scan->range_m.assign(2'000'000, 1);
      sink.on_lidar(scan);
    });
  }
  void command(const core::Command&) override {}

 private:
  int scans_;
  std::atomic<int>& steps_;
  TimeNs& longest_pause_;
  TimeNs before_ = core::machine_clock().now();
};

/// A client in real time that reads nothing for the first `scans` steps of a loud vehicle, and then does
/// `play`. Returns the longest time between two steps of the vehicle.
TimeNs longest_pause_with(int scans, std::function<void(Stream&)> play) {
  std::atomic<int> steps = 0;
  TimeNs longest_pause = 0;
  const Peer peer([&](Listener& listener) {
    auto client = listener.accept(Wait(5000));
    serve_client(
        *client, [&](const Hello&) { return std::make_unique<LoudVehicle>(scans, steps, longest_pause); }, {},
        kGoOn);
  });
  Stream stream = connect_to(peer.address(), Wait(5000), kMaxToCoreBytes);
  Hello hello;
  hello.clock = FlightClock::real_time;
  say(stream, hello);
  say(stream, Start{});
  while (steps < scans + 2) std::this_thread::sleep_for(Wait(5));
  play(stream);
  return longest_pause;
}

/// The goodbye to a client that reads nothing was waited for a second long, in a step of the vehicle.
TEST(BadClient, ThatReadsNothingHoldsUpNoStepWithTheGoodbye) {
  TimeNs pause = kSecond;
  for (int attempt = 0; attempt < 5 && pause > 800 * kMillisecond; ++attempt)  // the machine may pause, too
    pause = longest_pause_with(3, [](Stream& s) {
      say(s, Bye{"enough"});
      std::this_thread::sleep_for(Wait(1200));
    });
  EXPECT_LT(pause, 800 * kMillisecond);
}

/// Of a client whose 64 MiB are full, pings are not answered either; once it reads, they are.
TEST(BadClient, ThatReadsNothingFillsNoMemoryWithPongs) {
  int pongs_while_full = 0, pongs_later = 0;
  longest_pause_with(12, [&](Stream& s) {
    for (TimeNs t = 0; t < 1000; ++t) s.queue(Ping{t});
    say(s, Ping{1000});
    std::this_thread::sleep_for(Wait(100));
    bool asked = false;
    for (;;) {
      while (const auto frame = s.next())
        if (frame->type == kType<Pong>.id) ++(asked ? pongs_later : pongs_while_full);
      if (pongs_later > 0) break;
      if (!s.receive(Wait(200))) {  // all is read
        if (std::exchange(asked, true)) break;
        say(s, Ping{2000});
      }
    }
    say(s, Bye{"enough"});
  });
  EXPECT_LT(pongs_while_full, 900) << "those that were read before it was full may be answered";
  EXPECT_EQ(pongs_later, 1);
}

/// A vehicle that stands still for longer than a second sets its clock back: its answers to pings are by the
/// same clock as its stamps.
TEST(Server, StampsAndPongsAreOfOneClockAfterItsClockWasSetBack) {
  class Stands final : public core::Vehicle {
   public:
    core::VehicleDescription description() const override { return socket::description(); }
    void start(core::Executive& e, core::VehicleSink& sink) override {
      e.at(e.now(), [] { std::this_thread::sleep_for(Wait(1300)); });
      e.every("imu", 5 * kMillisecond, 5 * kMillisecond, [&] {
        core::ImuSample imu;
        imu.stamp = e.now();
        sink.on_imu(imu);
      });
    }
    void command(const core::Command&) override {}
  };
  const Peer peer([](Listener& listener) {
    auto client = listener.accept(Wait(5000));
    serve_client(
        *client, [](const Hello&) { return std::make_unique<Stands>(); }, {}, kGoOn);
  });
  Stream s = connect_to(peer.address(), Wait(5000), kMaxToCoreBytes);
  Hello hello;
  hello.clock = FlightClock::real_time;
  say(s, hello);
  say(s, Start{});
  // In order on the wire: no pong is earlier than the stamp before it, nor later than those after it.
  TimeNs before = -1;
  std::optional<TimeNs> pong;
  for (int checked = 0; checked < 10;) {
    while (const auto frame = s.next()) {
      std::string problem;
      const auto message = read_message<ToCore>(*frame, problem);
      if (const auto* answer = std::get_if<Pong>(&*message)) {
        EXPECT_GE(answer->received, before);
        pong = answer->received;
      } else if (const auto* imu = std::get_if<core::ImuSample>(&*message)) {
        before = imu->stamp;
        if (!pong || before <= *pong) {
          if (!pong) say(s, Ping{1});
          continue;
        }
        EXPECT_LE(before - *pong, kSecond / 2);
        pong.reset();
        ++checked;
      }
    }
    ASSERT_TRUE(s.receive(Wait(5000)));
  }
  say(s, Bye{"enough"});
}

}  // namespace
}  // namespace karst::socket
