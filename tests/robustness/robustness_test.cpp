// The parts of the campaign of faults: what is drawn, how flights are judged, what the tables count.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>

#include "plugins/simulator/cave/cave.h"
#include "tests/robustness/fly_trial.h"
#include "tests/robustness/tables.h"
#include "tests/robustness/trial_cave.h"

namespace karst::robustness {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

TEST(Draw, TheSameNumberIsTheSameTrialAndAllThingsComeUp) {
  const auto caves = cave_choices("");
  EXPECT_EQ(caves.size(), 6u) << "the generator's presets";
  std::map<Fault, int> faults;
  std::set<std::string> kinds, policies, vehicles, texts;
  for (int i = 0; i < 400; ++i) {
    const Trial a = draw_trial(i, caves), b = draw_trial(i, caves);
    EXPECT_EQ(a.fault_text(), b.fault_text());
    EXPECT_EQ(a.cave_name(), b.cave_name());
    EXPECT_EQ(a.flight_s, b.flight_s);
    ++faults[a.fault];
    kinds.insert(a.cave.kind), policies.insert(a.policy), vehicles.insert(a.vehicle), texts.insert(a.what);
    EXPECT_GE(a.flight_s, 30);
    EXPECT_LE(a.flight_s, 90);
    EXPECT_GT(a.fault_at_s, 0);
    EXPECT_LT(a.fault_at_s, a.flight_s);
    EXPECT_EQ(a.robots > 1, a.fault == Fault::radio_silence);
    if (a.fault == Fault::weak_motor) {
      EXPECT_TRUE(a.motor >= 1 && a.motor <= 4);
    }
    // A signal in the mission's own process is the end of it: not what a policy is to survive there.
    if (a.what == "crashes") {
      EXPECT_TRUE(a.own_process);
    }
    // A vehicle without a LiDAR has none that fails, and one with it no pose sensor.
    if (a.vehicle == "camera_uav") {
      EXPECT_EQ(a.what.find("lidar"), std::string::npos);
    }
    if (a.vehicle != "camera_uav") {
      EXPECT_EQ(a.what.find("pose"), std::string::npos);
    }
  }
  for (const Fault f : kFaults) EXPECT_EQ(faults[f], 40) << name_of(f);
  EXPECT_EQ(kinds.size(), 6u);
  EXPECT_EQ(policies.size(), 8u);
  EXPECT_EQ(vehicles.size(), 3u);
  for (const char* what : {"lidar lost", "lidar nan", "lidar stamp_back", "pose lost", "imu lost", "throws",
                           "crashes", "spins", "sleeps"})
    EXPECT_TRUE(texts.count(what)) << what;
}

TEST(Draw, CavesOfOneNameAreTheSame) {
  std::map<std::string, double> volumes;
  const auto caves = cave_choices("");
  for (int i = 0; i < 400; ++i) {
    const Trial t = draw_trial(i, caves);
    EXPECT_EQ(volumes.emplace(t.cave_name(), t.cave_volume_m3).first->second, t.cave_volume_m3);
  }
}

TEST(Draw, CommandsSetWhatTheFaultNeeds) {
  const auto caves = cave_choices("");
  const auto words_of = [&](Fault fault) {
    for (int i = 0;; ++i)
      if (const Trial t = draw_trial(i, caves); t.fault == fault) {
        std::string all;
        for (const std::string& w : command_of(t, {"karst", "breaks.so"}, "cave.info", "cache", "run"))
          all += w + '\n';
        return all;
      }
  };
  const auto has = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_TRUE(has(words_of(Fault::weak_motor), "simulator.motors.weak="));
  EXPECT_FALSE(has(words_of(Fault::none), "simulator.motors.weak="));
  EXPECT_TRUE(has(words_of(Fault::policy_hang), "policy.parameters.how=s"));
  EXPECT_TRUE(has(words_of(Fault::radio_silence), "radio.silent_for="));
  EXPECT_EQ(words_of(Fault::disk_full).rfind("/usr/bin/prlimit\n--fsize=", 0), 0u);
  EXPECT_EQ(words_of(Fault::sigterm).rfind("karst\nfly\n", 0), 0u);
}

TEST(TrialCave, ItsBoulderFallsAheadOfTheStartAndItsSensorsFailWhenTheyAreTo) {
  const fs::path dir = fs::path(testing::TempDir()) / "trial_cave";
  fs::create_directories(dir);
  cave::TriangleMesh box;  // a hall of 40 x 40 x 10 m
  for (int i = 0; i < 8; ++i)
    box.vertices.push_back({i & 1 ? 20.f : -20.f, i & 2 ? 20.f : -20.f, i & 4 ? 10.f : 0.f});
  box.triangles = {{0, 1, 2}, {1, 3, 2}, {4, 6, 5}, {5, 6, 7}, {0, 4, 1}, {1, 4, 5},
                   {2, 3, 6}, {3, 7, 6}, {0, 2, 4}, {2, 6, 4}, {1, 5, 3}, {3, 5, 7}};
  cave::write_mesh((dir / "hall.ply").string(), box);
  Trial t;
  t.cave = {"hall", (dir / "hall.ply").string(), "1 2 1.5 90"};
  const auto written = [&] {
    write_trial_cave(t, "no karst needed", dir, dir / "cave.info");
    return cave::describe_cave((dir / "cave.info").string(), "");
  };
  t.fault = Fault::rockfall;
  for (t.number = 0; t.number < 20; ++t.number) {
    const cave::CaveDescription c = written();
    ASSERT_EQ(c.boulders.size(), 1u);
    const cave::LooseRock& b = c.boulders[0];
    const double off_m = (b.position - core::Vec3(1, 2, 1.5)).norm();
    EXPECT_GT(off_m, b.within_m) << "or it would fall on the start";
    EXPECT_GE(b.within_m - b.radius_m - 0.3, 2.9) << "the vehicle stops from 2 m/s within 2 m";
    EXPECT_LT(b.position.head<2>().cwiseAbs().maxCoeff(), 20);
  }
  t.fault = Fault::sensor_gap;
  t.what = "lidar stamp_ahead", t.fault_at_s = 12, t.fault_for_s = 3;
  const cave::CaveDescription c = written();
  ASSERT_EQ(c.faults.size(), 1u);
  EXPECT_EQ(c.faults[0].sensor, cave::Fault::Sensor::lidar);
  EXPECT_EQ(c.faults[0].kind, cave::Fault::Kind::stamp_ahead);
  EXPECT_NEAR(c.faults[0].after_s, 12, 1e-9);
  EXPECT_NEAR(c.faults[0].lasts_s, 3, 1e-9);
  EXPECT_NEAR(c.start.heading_rad, std::numbers::pi / 2, 1e-6);
  EXPECT_TRUE(c.boulders.empty());
}

/// A record with these true events, at height 0, and the vehicle at x(t) from 0 to 60 s.
evaluation::RunRecord flown(const std::vector<std::tuple<double, const char*, double>>& events,
                            const std::function<double(double)>& x) {
  evaluation::RunRecord run;
  for (const auto& [t_s, what, at] : events)
    run.truth_events.push_back({{"time_s", t_s}, {"event", what}, {"x", at}, {"y", 0.0}, {"z", 0.0}});
  for (int i = 0; i <= 6000; ++i) {
    const double t_s = 0.01 * i;
    run.truth.push_back({t_s, {{x(t_s), 0, 1}, core::Quat::Identity()}});
  }
  run.estimate = run.truth;
  run.phases = {{"explore", 0, 40}, {"home", 40, 60}};
  return run;
}

TEST(Judge, HomeElsewhereInTheAirAndContact) {
  const auto moving = [](double t_s) { return t_s; };
  const auto outcome = [&](const std::vector<std::tuple<double, const char*, double>>& events) {
    return judge_vehicle(flown(events, moving)).outcome;
  };
  EXPECT_EQ(outcome({}), Outcome::not_flown);
  EXPECT_EQ(outcome({{0, "start", 0}}), Outcome::home);
  EXPECT_EQ(outcome({{0, "start", 0}, {2, "take-off", 0}, {50, "landed", 0.9}}), Outcome::home);
  EXPECT_EQ(outcome({{0, "start", 0}, {2, "take-off", 0}, {50, "landed", 1.1}}), Outcome::elsewhere);
  EXPECT_EQ(outcome({{0, "start", 0}, {2, "take-off", 0}}), Outcome::in_the_air);
  EXPECT_EQ(outcome({{0, "start", 0}, {2, "take-off", 0}, {50, "battery", 9}}), Outcome::in_the_air);
  EXPECT_EQ(outcome({{0, "start", 0}, {2, "take-off", 0}, {50, "contact", 9}}), Outcome::contact);
  EXPECT_EQ(outcome({{0, "start", 0}, {2, "take-off", 0}, {9, "landed", 0}, {12, "take-off", 0}}),
            Outcome::in_the_air);
}

TEST(Judge, AStallIsMoreThanFifteenSecondsAroundAPlaceInTheAir) {
  const std::vector<std::tuple<double, const char*, double>> events{
      {0, "start", 0}, {5, "take-off", 0}, {55, "landed", 0}};
  // Moves, but for `stand` seconds from 20 s on.
  const auto run = [&](double stand_s) {
    return flown(events, [stand_s](double t_s) { return t_s < 20 ? t_s : std::max(20.0, t_s - stand_s); });
  };
  EXPECT_NEAR(longest_stall_s(run(10)), 10.5, 0.6);  // and the half metre before or after
  EXPECT_EQ(judge_vehicle(run(10)).outcome, Outcome::home);
  EXPECT_EQ(judge_vehicle(run(16)).outcome, Outcome::stalled);
  // 12 s at the end of one phase and 12 s of the next are what two phases may take.
  const auto both = flown(events, [](double t_s) { return t_s < 28 ? t_s : std::max(28.0, t_s - 24); });
  EXPECT_NEAR(longest_stall_s(both), 12.5, 0.6);
  // Standing on the ground is none, before the take-off or after the landing.
  const auto early =
      flown({{0, "start", 0}, {30, "take-off", 0}, {31, "landed", 0}}, [](double) { return 0.0; });
  EXPECT_NEAR(longest_stall_s(early), 1, 0.02);
}

TEST(Judge, AProcessThatDiedOrHungIsBadWhateverItsRecordSays) {
  const fs::path empty = fs::path(testing::TempDir()) / "no_such_run";
  host::ProcessEnd end;
  EXPECT_EQ(judge(empty, end).outcome, Outcome::not_flown);
  end.signal = 11;
  EXPECT_TRUE(is_bad(judge(empty, end).outcome));
  end.hung = true;
  EXPECT_EQ(judge(empty, end).outcome, Outcome::no_exit);
}

TrialLine line(int trial, const char* kind, Outcome outcome, double clearance_m) {
  TrialLine l;
  l.trial = trial, l.build = "abc", l.cave_kind = kind, l.cave = kind, l.policy = "p", l.vehicle = "v";
  l.fault = trial % 2 ? "none" : "sigterm", l.fault_text = "at 3 s";
  l.verdict = {outcome, clearance_m, 1.5, 36, "landed: \"at the start\""};
  l.exit_code = 2, l.wall_s = 12;
  return l;
}

TEST(Lines, AreReadBackAndACutOneIsLeftOut) {
  const fs::path file = fs::path(testing::TempDir()) / "trials.jsonl";
  {
    std::ofstream out(file);
    out << to_json(line(3, "maze", Outcome::home, 0.25)) << "\n"
        << to_json(line(3, "maze", Outcome::contact, 0)) << "\n"
        << "no line\n"
        << to_json(line(1, "small", Outcome::elsewhere, 0.5)) << "\n"
        << to_json(line(9, "small", Outcome::home, 0.5)).substr(0, 50);
  }
  const auto lines = read_trials(file);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(to_json(lines[0]), to_json(line(1, "small", Outcome::elsewhere, 0.5)));
  EXPECT_EQ(lines[1].verdict.outcome, Outcome::contact) << "it was flown again";
}

TEST(Tables, CountOutcomesByCaveAndFaultAndNameTheBadOnes) {
  const std::vector<TrialLine> lines{line(0, "maze", Outcome::home, 0.4), line(1, "maze", Outcome::home, 0.3),
                                     line(2, "small", Outcome::contact, 0.0),
                                     line(3, "small", Outcome::elsewhere, 0.2)};
  const std::string text = summary(lines);
  for (const char* row :
       {"| maze | 2 | 2 | 0 | 0 | 0 | 0 | 0 | 0 |", "| small | 2 | 0 | 1 | 0 | 0 | 1 | 0 | 0 |",
        "| sigterm | 2 | 1 | 0 | 0 | 0 | 1 | 0 | 0 |", "| **all** | 4 | 2 | 1 | 0 | 0 | 1 | 0 | 0 |",
        "| 0.00 | 0.00 | 0.00 | 0.00 | 0.20 | 0.30 | 0.40 | 0.40 |", "- 2 (abc) small"})
    EXPECT_NE(text.find(row), std::string::npos) << row << "\n" << text;
  const std::string svg = clearance_plot(lines);
  EXPECT_NE(svg.find("of 4 flights"), std::string::npos);
  EXPECT_NE(svg.find("d=\"M50.0 280.0H50.0V215.0H"), std::string::npos) << svg;
}

}  // namespace
}  // namespace karst::robustness
