// Teams flown while somebody forges frames beside them: a vehicle that is not there, told of to those that
// are.
#include <atomic>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "core_stack/common/random.h"
#include "core_stack/team/communication/messages.h"
#include "sdk/flight/fly.h"
#include "tests/closed_loop/command.h"
#include "tests/closed_loop/drawn_cave.h"

namespace karst {
namespace {

using namespace core;
using nlohmann::json;

/// Who speaks, and under which key.
struct Forger {
  RobotId phantom = 0;
  MissionKey key;
  std::uint64_t seed = 1;
};

/// The simulated world, and on its radio a forger who hears all. Every quarter of a second it says of the
/// phantom that it is about to land 2 to 4 m from a robot, for five seconds, then by another.
class ForgedWorld final : public sim::SimulatedWorld {
 public:
  ForgedWorld(std::unique_ptr<sim::SimulatedWorld> world, const Forger& forger,
              const MissionKey& listens_with)
      : world_(std::move(world)), forger_(forger), listens_with_(listens_with), random_(forger.seed) {}

  Vehicle& robot(std::size_t i) override { return world_->robot(i); }
  TeamPort& port(std::size_t robot) override { return port_of(robot + 1); }
  RadioPort& radio(std::size_t number) override { return port_of(number); }
  std::string start_of(std::size_t i) const override { return world_->start_of(i); }
  Vec3 base() const override { return world_->base(); }
  void meet(TimeNs now) override { world_->meet(now); }
  void silence(std::size_t radio) override { world_->silence(radio); }
  void wreck(std::size_t robot, const std::string& reason) override { world_->wreck(robot, reason); }
  sim::RadioTraffic traffic(std::size_t radio) const override { return world_->traffic(radio); }
  void finish() override { world_->finish(); }

 private:
  class Port final : public TeamPort {
   public:
    Port(ForgedWorld& world, std::size_t radio) : world_(world), radio_(radio) {}
    void send(std::span<const std::uint8_t> frame, TimeNs now) override { world_.send(radio_, frame, now); }
    std::vector<Bytes> receive(TimeNs until) override { return world_.receive(radio_, until); }
    void drop_node(std::size_t radio) override { world_.world_->port(radio_ - 1).drop_node(radio); }

   private:
    ForgedWorld& world_;
    std::size_t radio_;
  };

  Port& port_of(std::size_t radio) { return ports_.try_emplace(radio, *this, radio).first->second; }

  void send(std::size_t radio, std::span<const std::uint8_t> bytes, TimeNs now) {
    world_->radio(radio).send(bytes, now);
    Refusal why{};
    const auto frame = read_frame(bytes, listens_with_, why);
    if (frame && !frame->states.empty() && in_the_air(frame->states.front().phase))
      flying_[radio] = frame->states.front().position;
    if (now % (kSecond / 4) == 0 && told_at_ != now) forge(now);
  }
  std::vector<Bytes> receive(std::size_t radio, TimeNs until) {
    auto out = world_->radio(radio).receive(until);
    if (told_at_ == until && !lie_.empty()) out.push_back(lie_);
    return out;
  }

  void forge(TimeNs now) {
    told_at_ = now, lie_.clear();
    if (flying_.empty()) return;
    if (now % (5 * kSecond) == 0) {
      auto victim = flying_.begin();
      std::advance(victim, static_cast<std::ptrdiff_t>(random_.bits() % flying_.size()));
      const double angle = random_.uniform(0, 2 * M_PI), away_m = random_.uniform(2, 4);
      state_.position = to_centimetres(victim->second + away_m * Vec3(std::cos(angle), std::sin(angle), 0));
    }
    state_.robot = forger_.phantom, state_.phase = TeamPhase::landing, state_.stamp = now;
    const Frame frame{.sender = forger_.phantom, .sent = now, .sequence = sequence_++, .states = {state_}};
    lie_ = *write_frame(frame, forger_.key);
  }

  std::unique_ptr<sim::SimulatedWorld> world_;
  std::map<std::size_t, Port> ports_;
  Forger forger_;
  MissionKey listens_with_;
  Random random_;
  std::map<std::size_t, Vec3> flying_;  // where each radio's robot said that it is
  TeamState state_;
  Bytes lie_;
  TimeNs told_at_ = -1;
  std::uint16_t sequence_ = 0;
};

class ForgedPlugin final : public sim::SimulatedWorldPlugin {
 public:
  ForgedPlugin(VehiclePlugin& plugin, const Forger& forger)
      : plugin_(dynamic_cast<sim::SimulatedWorldPlugin&>(plugin)), forger_(forger) {}
  void describe_options(OptionTable& table) override { plugin_.describe_options(table); }
  void describe_radio(OptionTable& table) override { plugin_.describe_radio(table); }
  std::unique_ptr<Vehicle> create(const VehicleSetup& setup) override { return plugin_.create(setup); }
  std::unique_ptr<sim::SimulatedWorld> create_world(const sim::WorldSetup& setup) override {
    return std::make_unique<ForgedWorld>(plugin_.create_world(setup), forger_, key_of_seed(setup.world.seed));
  }

 private:
  sim::SimulatedWorldPlugin& plugin_;
  Forger forger_;
};

struct Flown {
  json metrics;
  std::vector<json> truth, log;
  std::uint64_t refused = 0;

  std::size_t contacts() const {
    return static_cast<std::size_t>(
        std::count_if(truth.begin(), truth.end(), [](const json& e) { return e["kind"] == "contact"; }));
  }
};

std::vector<json> lines_of(const std::filesystem::path& file) {
  std::vector<json> out;
  std::istringstream in(bytes_of(file));
  for (std::string line; std::getline(in, line);) out.push_back(json::parse(line));
  return out;
}

/// Two robots in the air, and a third that does not start before they are down, in a passage where two get
/// by.
Flown fly(const std::string& name, std::uint64_t seed, RobotId phantom, const MissionKey& key) {
  const auto folder = fresh_folder(name + std::to_string(seed));
  flight::MissionOverrides overrides;
  overrides.cave = draw_cave(folder, {{{-4, -4, 0}, {4, 4, 3}}, {{3, -1.5, 0}, {60, 1.5, 3}}}, {0, 0, 1});
  overrides.policy = "nearest_frontier";
  overrides.settings = {"seed=" + std::to_string(seed),
                        "team.robots=3",
                        "team.strategy=return_to_base",
                        "team.stagger=15s",
                        "team.linger=2s",
                        "simulator.battery_minutes=1.1min",
                        "simulator.pose.fitted=always",
                        "localization.source=pose_sensor",
                        "radio.propagation=distance",
                        "radio.range=60m"};
  flight::Mission mission = flight::read_mission("", overrides);
  ForgedPlugin plugin(*mission.vehicle_plugin, {phantom, key, seed});
  mission.vehicle_plugin = &plugin;
  flight::FlightRequest request;
  request.run_dir = folder / "run";
  request.report = flight::Report::none;
  request.notes = request.status_line = false;
  flight::MissionFlight(mission, request).fly(std::atomic<bool>{false});
  Flown f;
  f.metrics = json::parse(bytes_of(request.run_dir / "metrics.json"));
  f.truth = lines_of(request.run_dir / "team_truth.jsonl"), f.log = lines_of(request.run_dir / "team.jsonl");
  for (const json& e : f.log)
    if (e["kind"] == "traffic") f.refused += e["frames_refused"].get<std::uint64_t>();
  return f;
}

// As it was: both made room for a vehicle that was not there, and flew into each other at 1.87 m/s.
TEST(ForgedRadio, AVehicleThatIsNotInTheTeamIsRefusedAndNobodyTouchesAnother) {
  for (int seed = 1; seed <= seeds(); ++seed) {
    const auto s = static_cast<std::uint64_t>(seed);
    const Flown f = fly("forged_stranger_", s, 9, key_of_seed(s));  // even with the mission's key
    EXPECT_EQ(f.contacts(), 0u) << seed;
    EXPECT_GT(f.refused, 100u) << seed;
    for (const json& robot : f.metrics["robots"]) EXPECT_NE(robot["outcome"], "contact") << seed << robot;
  }
}

TEST(ForgedRadio, WithoutTheKeyNothingSaidOfAMemberIsBelieved) {
  const Flown f = fly("forged_member_", 1, 3, key_of_seed(99));
  EXPECT_EQ(f.contacts(), 0u);
  EXPECT_GT(f.refused, 100u);
  for (const json& robot : f.metrics["robots"]) EXPECT_NE(robot["outcome"], "contact") << robot;
}

/// Who holds the key is believed: they stop and make room for nobody. But nobody is flown into.
TEST(ForgedRadio, WhereOneWhoHoldsTheKeyLiesAboutAMemberNobodyTouchesAnother) {
  for (int seed = 1; seed <= seeds(); ++seed) {
    const auto s = static_cast<std::uint64_t>(seed);
    const Flown f = fly("forged_insider_", s, 3, key_of_seed(s));
    EXPECT_EQ(f.contacts(), 0u) << seed;
    EXPECT_EQ(f.metrics["contacts"], 0) << seed;
    for (const json& robot : f.metrics["robots"]) EXPECT_NE(robot["outcome"], "contact") << seed << robot;
  }
}

}  // namespace
}  // namespace karst
