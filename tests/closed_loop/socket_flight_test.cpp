// Missions whose vehicle is another process: the same bytes as in one process, and what becomes of a vehicle
// or a core that fails in flight.
#include <signal.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <thread>

#include "plugins/socket/stream.h"
#include "tests/closed_loop/command.h"

namespace karst {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// A program in the background; `text` of what it printed so far.
class Background {
 public:
  Background(const std::string& command, const fs::path& log) : log_(log) {
    pid_ = fork();
    if (pid_ == 0) {
      setpgid(0, 0);
      execl("/bin/sh", "sh", "-c", ("exec > " + log.string() + " 2>&1; " + command).c_str(), nullptr);
      _exit(127);
    }
    for (int i = 0; i < 600 && bytes_of(log_).find("listening") == std::string::npos; ++i) usleep(50'000);
  }
  ~Background() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
  }
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;
  void send(int signal) const { kill(pid_, signal); }
  /// Waits for its end; the exit code.
  int end() {
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string text() const { return bytes_of(log_); }

 private:
  fs::path log_;
  pid_t pid_ = -1;
};

const std::string kKarst = std::string(KARST_BINARY_DIR) + "/bin/karst ";

/// A socket's path must be short.
std::string address_of(const std::string& name) {
  return "unix:/tmp/karst_" + std::to_string(getpid()) + "_" + name;
}
std::string mission(const fs::path& folder, const std::string& cave, const std::string& more) {
  const std::string file = (folder / "mission.info").string();
  std::ofstream(file) << "seed 5\ncave { file " << cave << " }\n" << more;
  return file;
}
std::string serve(const std::string& mission_file, const std::string& address, const fs::path& folder) {
  return "exec " + kKarst + "vehicle serve " + mission_file + " --listen " + address + " --truth " +
         (folder / "truth").string();
}
std::string by_socket(const std::string& address) {
  return " --set vehicle=socket --set socket.address=" + address + " --quiet --no-report ";
}

/// The events of a kind, each as JSON.
std::vector<json> events(const fs::path& file, const char* key, const std::string& what) {
  std::vector<json> found;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (const json event = json::parse(line, nullptr, false);
        event.is_object() && event.value(key, "") == what)
      found.push_back(event);
  return found;
}
/// How the mission ended, by the run's own record.
json outcome(const fs::path& run) {
  const auto all = events(run / "events.jsonl", "kind", "outcome");
  return all.empty() ? json() : all.back();
}
bool truth_says(const fs::path& folder, const std::string& what) {
  return !events(folder / "truth" / "1" / "truth_events.jsonl", "event", what).empty();
}

struct Kind {
  const char* name;
  const char* preset;
  int cave_seed;
  const char* settings;
};
const Kind kKinds[] = {
    {"lidar_and_cameras_in_gusts", "small", 7,
     "mission { max_flight_time \"40 s\" }\nsimulator { gust \"3 m/s\" }\n"},
    {"cameras_only", "small", 3, "mission { max_flight_time \"40 s\" }\nsimulator { vehicle camera_uav }\n"},
    {"lidar_only_with_pictures_and_objects", "small", 11,
     "mission { max_flight_time \"40 s\" }\npolicy { name information_gain }\n"
     "simulator { vehicle lidar_only_uav rgb { fitted true } objects { count 3 } }\n"},
};

class SameBytes : public ::testing::TestWithParam<Kind> {};

/// All that a run holds but wall-clock times and the names of folders and vehicles.
TEST_P(SameBytes, AsInOneProcess) {
  const Kind& kind = GetParam();
  const fs::path folder = fresh_folder(std::string("socket_") + kind.name);
  const std::string file = mission(folder, generated_cave(kind.preset, kind.cave_seed), kind.settings);
  const Output alone =
      run_karst("fly " + file + " --quiet --no-report --threads 2 --out " + (folder / "alone").string());
  ASSERT_TRUE(alone.code == 0 || alone.code == 2) << alone.text;
  const std::string address = address_of("same");
  Background server(serve(file, address, folder) + " --threads 4", folder / "serve.log");
  int flight = 0;
  for (const char* threads : {"1", "4"}) {
    const fs::path run = folder / (std::string("socket_") + threads);
    const Output out =
        run_karst("fly " + file + by_socket(address) + "--threads " + threads + " --out " + run.string());
    EXPECT_EQ(out.code, alone.code) << out.text;
    for (int i = 0; i < 100 && server.text().find("truth/" + std::to_string(flight + 1)) == std::string::npos;
         ++i)
      usleep(50'000);
    const Output evaluated = run_karst("evaluate " + run.string() + " --truth " +
                                       (folder / "truth" / std::to_string(++flight)).string());
    EXPECT_EQ(evaluated.code, 0) << evaluated.text;
    int compared = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder / "alone")) {
      const fs::path name = fs::relative(entry.path(), folder / "alone");
      if (!entry.is_regular_file() || name == "timing.json" || name == "decisions.csv" ||
          name == "mission.info")
        continue;
      EXPECT_TRUE(bytes_of(entry.path()) == bytes_of(run / name))
          << name << " with " << threads << " threads";
      ++compared;
    }
    EXPECT_GT(compared, 8);
  }
  server.send(SIGINT);
  EXPECT_EQ(server.end(), 0);
}
INSTANTIATE_TEST_SUITE_P(Kinds, SameBytes, ::testing::ValuesIn(kKinds),
                         [](const auto& kind) { return std::string(kind.param.name); });

TEST(SocketFlight, FliesInRealTimeByTcp) {
  const fs::path folder = fresh_folder("socket_real_time");
  const std::string file =
      mission(folder, generated_cave("small", 7), "mission { max_flight_time \"20 s\" }\n");
  Background server(serve(file, "tcp:0", folder) + " --once", folder / "serve.log");
  std::smatch port;
  const std::string said = server.text();
  ASSERT_TRUE(std::regex_search(said, port, std::regex("listening at (tcp:127.0.0.1:\\d+)"))) << said;
  const Output out =
      run_karst("fly --real-time " + file + by_socket(port[1]) + "--out " + (folder / "run").string());
  EXPECT_TRUE(out.says("landed")) << out.text;
  EXPECT_EQ(server.end(), 0);
  EXPECT_TRUE(truth_says(folder, "landed"));
  EXPECT_FALSE(truth_says(folder, "contact"));
}

/// The vehicle's process is killed: the core ends the mission with the reason and keeps the record.
class VehicleDies : public ::testing::TestWithParam<const char*> {};

/// Waits until the run has entered a phase.
bool wait_for_phase(const fs::path& run, const std::string& phase) {
  for (int i = 0; i < 1200; ++i) {
    if (!events(run / "events.jsonl", "phase", phase).empty()) return true;
    usleep(25'000);
  }
  return false;
}
/// A mission that explores for some 9 s, and is home and landing soon enough to wait for it in real time.
const char* const kShort = "mission { max_flight_time \"40 s\" }\n";

/// Waits until it has been in a phase for some time: in `explore` it flies at full speed then.
bool wait_until_in(const fs::path& run, const std::string& phase) {
  if (!wait_for_phase(run, phase)) return false;
  if (phase == "explore") sleep(4);
  return true;
}

TEST_P(VehicleDies, TheCoreEndsWithTheReason) {
  const std::string phase = GetParam();
  const fs::path folder = fresh_folder("socket_vehicle_dies_" + phase), run = folder / "run";
  const std::string file = mission(folder, generated_cave("small", 7), kShort),
                    address = address_of("v" + phase);
  Background server(serve(file, address, folder), folder / "serve.log");
  Background flight(kKarst + "fly --real-time " + file + by_socket(address) + "--out " + run.string() +
                        " & echo listening; wait $!",
                    folder / "fly.log");
  ASSERT_TRUE(wait_until_in(run, phase)) << bytes_of(folder / "fly.log");
  server.send(SIGKILL);
  server.end();
  EXPECT_EQ(flight.end(), 2) << bytes_of(folder / "fly.log");
  EXPECT_EQ(outcome(run).value("outcome", ""), "lost");
  EXPECT_NE(outcome(run).value("reason", "").find("the other side closed the connection"), std::string::npos)
      << outcome(run).dump();
  const auto phases = events(run / "events.jsonl", "kind", "phase");
  ASSERT_GE(phases.size(), 2u);
  EXPECT_EQ(phases[phases.size() - 2].value("phase", ""), phase) << "the one before done";
  for (const char* kept : {"trajectory.tum", "telemetry.csv", "map.bt", "metrics.json"})
    EXPECT_TRUE(fs::exists(run / kept)) << kept;
}
INSTANTIATE_TEST_SUITE_P(Phases, VehicleDies, ::testing::Values("explore", "home", "land"));

/// A cave without blocks and ledges. An autopilot that lost the core comes down where it is and cannot choose
/// the place: on a rough floor it may set down on the side of a block, which is a contact.
std::string smooth_cave() {
  return generated_cave("small", 1,
                        "--set breakdown=0 --set speleothems=0 --set roughness='0.1 m' --set "
                        "passage_width='6 m' --set domes=0 --set chimneys=0",
                        "smooth");
}

/// The core's process is killed: the simulated vehicle comes down by itself and touches nothing else.
class CoreDies : public ::testing::TestWithParam<const char*> {};

TEST_P(CoreDies, TheVehicleComesDown) {
  const std::string phase = GetParam();
  const fs::path folder = fresh_folder("socket_core_dies_" + phase), run = folder / "run";
  const std::string file = mission(folder, smooth_cave(), kShort), address = address_of("c" + phase);
  Background server(serve(file, address, folder) + " --once", folder / "serve.log");
  {
    Background flight(kKarst + "fly --real-time " + file + by_socket(address) + "--out " + run.string() +
                          " & echo listening; trap 'kill -9 $!' TERM; wait $!",
                      folder / "fly.log");
    ASSERT_TRUE(wait_until_in(run, phase)) << bytes_of(folder / "fly.log");
    flight.send(SIGTERM);
    flight.end();
  }
  EXPECT_EQ(server.end(), 0) << server.text();
  EXPECT_TRUE(truth_says(folder, "autopilot")) << server.text();
  EXPECT_TRUE(truth_says(folder, "landed")) << server.text();
  EXPECT_FALSE(truth_says(folder, "contact")) << server.text();
}
INSTANTIATE_TEST_SUITE_P(Phases, CoreDies, ::testing::Values("explore", "home", "land"));

/// The core's process stands still for a while, as a computer that swaps does.
struct Stop {
  const char* name;
  int milliseconds;
};
class CoreStops : public ::testing::TestWithParam<Stop> {};

TEST_P(CoreStops, TheVehicleIsSafe) {
  const Stop stop = GetParam();
  const fs::path folder = fresh_folder(std::string("socket_core_stops_") + stop.name), run = folder / "run";
  const std::string file = mission(folder, smooth_cave(), kShort);
  const std::string address = address_of(stop.name);
  Background server(serve(file, address, folder) + " --once", folder / "serve.log");
  Background flight(kKarst + "fly --real-time " + file + by_socket(address) + "--out " + run.string() +
                        " & echo listening; trap 'kill -STOP $!' USR1; trap 'kill -CONT $!' USR2; "
                        "wait $!; while kill -0 $! 2>/dev/null; do wait $!; done",
                    folder / "fly.log");
  ASSERT_TRUE(wait_until_in(run, "explore")) << bytes_of(folder / "fly.log");
  flight.send(SIGUSR1);
  usleep(static_cast<useconds_t>(stop.milliseconds) * 1000);
  flight.send(SIGUSR2);
  flight.end();
  EXPECT_EQ(server.end(), 0) << server.text();
  EXPECT_TRUE(truth_says(folder, "landed")) << server.text();
  EXPECT_FALSE(truth_says(folder, "contact")) << server.text();
  if (stop.milliseconds > 700) {
    EXPECT_TRUE(truth_says(folder, "autopilot")) << "it takes over after half a second";
  }
  // What comes after a second depends on how soon the machine lets the core catch up; after ten the vehicle
  // stands.
  const std::string ending = outcome(run).value("outcome", "") + ": " + outcome(run).value("reason", "");
  EXPECT_FALSE(ending.starts_with("contact")) << ending;
  if (stop.milliseconds > 5000) {
    EXPECT_TRUE(ending.starts_with("aborted: landed by the autopilot") || ending.starts_with("lost: unix:"))
        << ending;
  }
}
INSTANTIATE_TEST_SUITE_P(Silence, CoreStops,
                         ::testing::Values(Stop{"s01", 100}, Stop{"s1", 1000}, Stop{"s10", 11000}),
                         [](const auto& stop) { return std::string(stop.param.name); });

TEST(SocketFlight, ASecondClientIsRefusedAndTheFirstFliesOn) {
  const fs::path folder = fresh_folder("socket_two_clients");
  const std::string file = mission(folder, generated_cave("small", 7), kShort), address = address_of("two");
  Background server(serve(file, address, folder) + " --once", folder / "serve.log");
  Background first(kKarst + "fly --real-time " + file + by_socket(address) + "--out " +
                       (folder / "first").string() + " & echo listening; wait $!",
                   folder / "fly.log");
  ASSERT_TRUE(wait_for_phase(folder / "first", "takeoff"));
  const Output second =
      run_karst("fly " + file + by_socket(address) + "--out " + (folder / "second").string());
  EXPECT_EQ(second.code, 1);
  EXPECT_TRUE(second.says("another client flies this vehicle")) << second.text;
  EXPECT_FALSE(fs::exists(folder / "second"));
  first.end();
  EXPECT_EQ(outcome(folder / "first").value("outcome", ""), "landed") << bytes_of(folder / "fly.log");
}

TEST(SocketFlight, ReasonsAreSaidBeforeAnythingIsWritten) {
  const fs::path folder = fresh_folder("socket_reasons");
  const std::string out = " --out " + (folder / "run").string();
  const Output none = run_karst("fly --set vehicle=socket" + out);
  EXPECT_EQ(none.code, 1);
  EXPECT_TRUE(none.says("is missing; expected tcp:HOST:PORT")) << none.text;
  const Output nobody = run_karst(
      "fly --set vehicle=socket --set socket.address=unix:/tmp/karst_nobody --set "
      "socket.connect_timeout=0.2s" +
      out);
  EXPECT_EQ(nobody.code, 1);
  EXPECT_TRUE(nobody.says("no vehicle answers there")) << nobody.text;
  EXPECT_FALSE(fs::exists(folder / "run"));
  const Output check = run_karst("vehicle check unix:/tmp/karst_nobody");
  EXPECT_EQ(check.code, 1);
  EXPECT_TRUE(check.says("no vehicle answers there")) << check.text;
}

/// The examples keep the protocol, and karst flies them.
class Example : public ::testing::TestWithParam<const char*> {
 protected:
  static std::string command(const std::string& language) {
    const std::string source =
        std::string(KARST_SOURCE_DIR) + "/examples/vehicle_" + language + "/point_mass.";
    if (language == "python") return "python3 " + source + "py ";
    const std::string program = std::string(KARST_BINARY_DIR) + "/test_runs/point_mass";
    const Output made =
        run_command("cc -O2 -std=c11 -Wall -Wextra -Werror -o " + program + " " + source + "c -lm");
    EXPECT_EQ(made.code, 0) << made.text;
    return program + " ";
  }
};

TEST_P(Example, KeepsTheProtocolAndIsFlown) {
  const std::string language = GetParam();
  const fs::path folder = fresh_folder("socket_example_" + language);
  const std::string address = address_of(language);
  const Background vehicle("exec " + command(language) + address, folder / "vehicle.log");
  const Output check = run_karst("vehicle check " + address + " --fly --seconds 2");
  EXPECT_EQ(check.code, 0) << check.text;
  EXPECT_TRUE(check.says("the vehicle conforms"));
  const Output out = run_karst("fly --set localization.source=pose_sensor --time 60s" + by_socket(address) +
                               "--out " + (folder / "run").string());
  EXPECT_EQ(out.code, 0) << out.text;
  EXPECT_EQ(outcome(folder / "run").value("outcome", ""), "landed");
  const json metrics = json::parse(bytes_of(folder / "run" / "metrics.json"));
  EXPECT_NEAR(metrics["explored_volume_m3"].get<double>(), 12 * 8 * 4, 60) << "the room's volume";
  fs::remove(address.substr(5));
}
/// The next message of a type; null if none comes.
template <class M>
std::optional<M> wait_for(socket::Stream& stream,
                          const std::function<void(const socket::ToCore&)>& meanwhile) {
  for (;;) {
    while (const auto frame = stream.next()) {
      std::string problem;
      const auto message = socket::read_message<socket::ToCore>(*frame, problem);
      EXPECT_TRUE(message) << problem;
      if (!message) return std::nullopt;
      meanwhile(*message);
      if (const M* found = std::get_if<M>(&*message)) return *found;
    }
    if (!stream.receive(socket::Wait(10'000))) return std::nullopt;
  }
}
template <class M>
std::optional<M> wait_for(socket::Stream& stream) {
  return wait_for<M>(stream, [](const socket::ToCore&) {});
}
template <class M>
void say(socket::Stream& stream, const M& message) {
  stream.queue(message);
  stream.flush(socket::Wait(1000));
}
socket::Stream start_of(const std::string& address, socket::FlightClock clock) {
  auto stream =
      socket::connect_to(socket::parse_address(address), socket::Wait(5000), socket::kMaxToCoreBytes);
  socket::Hello hello;
  hello.clock = clock;
  say(stream, hello);
  EXPECT_TRUE(wait_for<socket::Welcome>(stream));
  say(stream, socket::Start{});
  EXPECT_TRUE(wait_for<socket::Done>(stream));
  return stream;
}

/// A core that is stopped, and does not close: sending to it waited for it, in the loop of the vehicle.
TEST_P(Example, IsNotHeldUpByACoreThatReadsNothing) {
  const std::string language = GetParam(), address = address_of("stopped_" + language);
  const fs::path folder = fresh_folder("socket_example_stopped_" + language);
  const Background vehicle("exec " + command(language) + address, folder / "vehicle.log");
  socket::Stream stream = start_of(address, socket::FlightClock::real_time);
  core::Command rise;
  rise.rates.armed = true;
  rise.rates.thrust_n = 20;
  for (bool up = false; !up;) {
    say(stream, rise);
    wait_for<core::ImuSample>(stream,
                              [&](const auto& m) { up |= std::holds_alternative<socket::LiftOff>(m); });
  }
  sleep(5);
  // It came down meanwhile, which is told, and what it measured is not kept for long.
  core::TimeNs last = 0, longest_gap = 0;
  const auto imu = [&](const socket::ToCore& m) {
    if (const auto* sample = std::get_if<core::ImuSample>(&m)) {
      if (last > 0) longest_gap = std::max(longest_gap, sample->stamp - last);
      last = sample->stamp;
    }
  };
  const auto ground = wait_for<socket::Ground>(stream, imu);
  ASSERT_TRUE(ground);
  for (int i = 0; i < 20; ++i) wait_for<core::ImuSample>(stream, imu);
  EXPECT_GT(longest_gap, core::kSecond / 2);
  say(stream, socket::Start{});
  EXPECT_TRUE(wait_for<socket::Bye>(stream)) << "after a flight no refusal, but a goodbye";
}

TEST_P(Example, AnswersAPingInLockstep) {
  const std::string language = GetParam(), address = address_of("ping_" + language);
  const fs::path folder = fresh_folder("socket_example_ping_" + language);
  const Background vehicle("exec " + command(language) + address, folder / "vehicle.log");
  socket::Stream stream = start_of(address, socket::FlightClock::lockstep);
  say(stream, socket::Ping{77});
  const auto pong = wait_for<socket::Pong>(stream);
  ASSERT_TRUE(pong);
  EXPECT_EQ(pong->ping_sent, 77);
  say(stream, socket::Run{0, 0});
  EXPECT_TRUE(wait_for<socket::Done>(stream)) << "the flight goes on";
}
INSTANTIATE_TEST_SUITE_P(Languages, Example, ::testing::Values("c", "python"));

TEST(SocketFlight, TheSimulatorKeepsTheProtocol) {
  const fs::path folder = fresh_folder("socket_conformance");
  const std::string address = address_of("conf");
  const Background server(serve(mission(folder, generated_cave("small", 7), ""), address, folder),
                          folder / "serve.log");
  const Output check = run_karst("vehicle check " + address + " --fly --seconds 2");
  EXPECT_EQ(check.code, 0) << check.text;
}

}  // namespace
}  // namespace karst
