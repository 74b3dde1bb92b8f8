#include "sdk/campaign/plan/plan.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "sdk/campaign/plan/flight_times.h"
#include "sdk/campaign/plan/hash.h"
#include "sdk/campaign/plan/mesh_hash.h"
#include "sdk/campaign/plan/plan_text.h"
#include "sdk/campaign/run/folder.h"
#include "sdk/campaign/store/results.h"
#include "sdk/host/isolation/process.h"
#include "tests/unit/campaign/store/store_fixture.h"

namespace karst::campaign {
namespace {

using host::run_process;

Plan small_plan() {
  Plan plan{"small", "full", 300, 7200, {}, {}, {1, 2, 3}};
  for (const char* name : {"near", "far"}) {
    PlannedContestant c{
        name, "policy", "", "1.0.0", "0.1.0+ab", R"({"a":"1 m"})", R"({"motion.max_speed":"1 m/s"})", {}};
    c.mission.put("motion.max_speed", "1 m/s");
    c.mission.put("policy.parameters.a", name);
    c.mission.put("text", "with \"quotes\", {braces} ; and a comment sign");
    plan.contestants.push_back(c);
  }
  plan.caves = {{"maze", "/caves/maze.info", "", "m1", "h1"},
                {"shaft", "/caves/shaft.ply", "1 2 3 90", "m2", "h2"}};
  return plan;
}

TEST(Plan, ComesBackFromItsDefinition) {
  const Plan plan = small_plan(), back = plan_of(definition_of(plan), "here");
  EXPECT_TRUE(changes(plan, back, AcceptedBinaries::same).empty());
  EXPECT_EQ(definition_of(back), definition_of(plan));
  EXPECT_EQ(back.seeds, plan.seeds);
  EXPECT_EQ(back.contestants[1].settings, plan.contestants[1].settings);
  EXPECT_EQ(back.caves[1].start, "1 2 3 90");
  EXPECT_EQ(mission_text(back, 1, 1), mission_text(plan, 1, 1));
}

TEST(Plan, KeepsTheMetricThatWasDeclared) {
  Plan plan = small_plan();
  plan.metric = "depth_m";
  std::string text = definition_of(plan);
  EXPECT_EQ(plan_of(text, "here").metric, "depth_m");
  text.erase(text.find("metric depth_m\n"), 15);  // as campaigns were before it could be declared
  EXPECT_EQ(plan_of(text, "here").metric, "coverage_auc");
}

// As it was: the longest horizon was taken for all.
TEST(Plan, ContestantsThatMayNotExploreAsLongAreRefused) {
  std::vector<PlannedContestant> who = small_plan().contestants;
  for (PlannedContestant& c : who) c.mission.put("mission.max_flight_time", "300 s");
  EXPECT_EQ(horizon_of(who, "c.info"), 300);
  who[1].mission.put("simulator.battery_minutes", "10 min");
  EXPECT_EQ(horizon_of(who, "c.info"), 300);
  who[1].mission.put("simulator.battery_minutes", "2 min");
  const std::string e = error_of([&] { horizon_of(who, "c.info"); });
  EXPECT_TRUE(says(e, "c.info: contestant far: may explore for 120.0 s, near for 300.0 s")) << e;
  who[0].mission.put("simulator.battery_minutes", "2 min");
  EXPECT_EQ(horizon_of(who, "c.info"), 120);
}

// With 10 s, both contestants got the same coverage, and nothing said that none of it is exploration.
TEST(Plan, WithLessThanHalfOfTheFlightForExplorationHasAWarningThatNamesTheKey) {
  const auto warning = [](const std::string& flight_time, const std::string& reserve_of_far) {
    Plan plan = small_plan();
    for (PlannedContestant& c : plan.contestants) {
      c.mission.put("mission.max_flight_time", flight_time);
      c.mission.put("mission.takeoff_height", "0.8 m");
      c.mission.put("mission.landing_speed", "0.4 m/s");
      c.mission.put("mission.home_margin", "0.5");
      c.mission.put("mission.home_reserve", c.name == "far" ? reserve_of_far : "20 s");
    }
    return little_exploration_text(plan);
  };
  // 2 s up, 3 s down with the margin: of T, T - 25 s are left.
  EXPECT_EQ(warning("50 s", "20 s"), "");
  const std::string some = warning("49 s", "20 s"), none = warning("10 s", "20 s");
  EXPECT_TRUE(
      says(some, "the flight time of 49 s leaves at most 24 s to explore (contestant near): take-off,"))
      << some;
  EXPECT_TRUE(says(some, "a reserve of 20 s (mission.home_reserve)")) << some;
  EXPECT_TRUE(says(none, "the flight time of 10 s leaves no time to explore")) << none;
  EXPECT_TRUE(says(warning("1 min", "40 s"),
                   "the flight time of 60 s leaves at most 15 s to explore (contestant far)"))
      << "of the contestant that has least";
  EXPECT_EQ(little_exploration_text(small_plan()), "") << "a mission of which these are not known";
}

// As it was: all trials were flown, and then there was nothing to compare.
TEST(Plan, AFigureThatATeamOfThatSizeCannotHaveIsRefused) {
  std::vector<PlannedContestant> who = small_plan().contestants;
  const auto refused = [&](const std::string& metric) {
    return error_of([&] { refuse_figure_of_others(metric, who, "c.info"); });
  };
  EXPECT_EQ(refused("coverage_auc"), "");
  EXPECT_TRUE(says(refused("robots_connected"), "only teams of 2 robots and more have it"));
  for (PlannedContestant& c : who) c.mission.put("team.robots", 3);
  EXPECT_EQ(refused("robots_connected") + refused("exploration_time_3_s") + refused("exploration_time_s"),
            "");
  EXPECT_TRUE(says(refused("min_clearance_m"), "teams have no such figure, their robots have"));
  const std::string e = refused("exploration_time_4_s");
  EXPECT_TRUE(says(e, "c.info: metric exploration_time_4_s: only teams of 4 robots")) << e;
}

TEST(Plan, ADamagedDefinitionIsAnError) {
  for (const std::string& text : {std::string("name x\n"), std::string("name {\n"), std::string()})
    EXPECT_TRUE(says(error_of([&] { plan_of(text, "store"); }), "store: campaign.definition"));
}

// 200,000 levels ended the process, and what it includes was opened.
TEST(Plan, ADefinitionOfSomebodyElsesIsBoundedAndOpensNothing) {
  std::string deep;
  for (int i = 0; i < 200'000; ++i) deep += "a {\n";
  CampaignResults results;
  for (const auto& read : {std::function<void()>([&] { plan_of(deep, "store"); }),
                           std::function<void()>([&] { read_conditions(deep, "store", results); })})
    EXPECT_TRUE(
        says(error_of(read), "store: campaign.definition: line 101: blocks stand more than 100 deep"));
  const std::string including = definition_of(small_plan()) + "#include \"/dev/zero\"\n";
  EXPECT_TRUE(
      says(error_of([&] { plan_of(including, "store"); }), ": #include is followed in mission files"));
}

TEST(Plan, WhatChangedIsNamed) {
  const auto changed = [](auto change, AcceptedBinaries binaries = AcceptedBinaries::same) {
    Plan now = small_plan();
    change(now);
    const auto all = changes(small_plan(), now, binaries);
    return all.empty() ? std::string() : all.front();
  };
  EXPECT_EQ(changed([](Plan& p) { p.contestants[0].mission.put("motion.max_speed", "2 m/s"); }),
            "contestant near: motion.max_speed was \"1 m/s\", is \"2 m/s\"");
  EXPECT_EQ(changed([](Plan& p) { p.contestants[1].policy = "other"; }),
            "contestant far: policy was \"policy\", is \"other\"");
  EXPECT_EQ(changed([](Plan& p) { p.contestants.pop_back(); }), "contestant 2 was far, is missing");
  EXPECT_EQ(changed([](Plan& p) { p.caves[0].hash = "other"; }),
            "cave maze: content was \"h1\", is \"other\"");
  EXPECT_EQ(changed([](Plan& p) { p.seeds = {1, 3}; }), "seeds were 1 2 3, are 1 3");
  EXPECT_TRUE(says(changed([](Plan& p) { p.contestants[0].binary_version = "0.2.0"; }), "binary"));
  EXPECT_EQ(changed([](Plan& p) { p.contestants[0].binary_version = "0.2.0"; }, AcceptedBinaries::any), "");
  EXPECT_EQ(changed([](Plan& p) { p.seeds.push_back(9), p.contestants.push_back(p.contestants[0]); }), "");
  EXPECT_EQ(changed([](Plan& p) { p.caves[0].file = "/moved/maze.info"; }), "") << "the same cave elsewhere";
}

TEST(Plan, EveryTrialHasAHashOfItsOwnThatDoesNotTellWhereTheCaveLies) {
  const Plan plan = small_plan();
  std::set<std::string> hashes;
  for (const TrialKey& key : trials_of(plan)) hashes.insert(mission_hash(plan, key));
  EXPECT_EQ(hashes.size(), 12u);
  Plan moved = plan;
  moved.caves[0].file = "/elsewhere/maze.info";
  EXPECT_EQ(mission_hash(moved, {0, 0, 1}), mission_hash(plan, {0, 0, 1}));
}

TEST(Folder, OnlyOneCampaignWritesIntoIt) {
  const fs::path dir = fresh_folder("lock");
  {
    const FolderLock lock(dir);
    EXPECT_TRUE(says(error_of([&] { FolderLock second(dir); }), "another campaign is writing here"));
  }
  EXPECT_EQ(error_of([&] { FolderLock again(dir); }), "");
}

TEST(Folder, AnotherCampaignsStoreIsRefusedSayingWhatDiffers) {
  const fs::path dir = fresh_folder("other_campaign");
  { open_for(small_plan(), dir, AcceptedBinaries::same); }
  { open_for(small_plan(), dir, AcceptedBinaries::same); }
  Plan other = small_plan();
  other.contestants[0].mission.put("motion.max_speed", "2 m/s");
  const std::string e = error_of([&] { open_for(other, dir, AcceptedBinaries::same, "c.info"); });
  EXPECT_TRUE(says(e, "c.info: is another campaign than the one in")) << e;
  EXPECT_TRUE(says(e, "contestant near: motion.max_speed was \"1 m/s\", is \"2 m/s\"")) << e;
  Plan more = small_plan();
  more.seeds.push_back(4);
  { open_for(more, dir, AcceptedBinaries::same); }
  EXPECT_EQ(Store::open(dir / "campaign.sqlite").head().seeds, more.seeds);
}

TEST(Folder, TheMetricThatWasDeclaredFirstStays) {
  const fs::path dir = fresh_folder("metric_stays");
  Plan plan = small_plan();
  plan.metric = "depth_m";
  { open_for(plan, dir, AcceptedBinaries::same); }
  plan.metric = "coverage";  // another one after the flights would be a choice by what they found
  plan.seeds.push_back(4);
  { open_for(plan, dir, AcceptedBinaries::same); }
  const CampaignResults results = read_results(dir);
  EXPECT_EQ(results.metric, "depth_m");
  EXPECT_EQ(results.profile, "full");
  EXPECT_EQ(Store::open(dir / "campaign.sqlite").head().seeds, plan.seeds);
}

TEST(Hash, IsWhatSha256sumPrints) {
  const fs::path file = fresh_folder("hash") / "file";
  std::string bytes;
  for (int i = 0; i < 3'000'001; ++i) bytes += static_cast<char>(i * 7 + i / 255);
  std::ofstream(file, std::ios::binary) << bytes;
  const std::string wanted = run_process({"/usr/bin/sha256sum", file.string()}, 100).out.substr(0, 64);
  EXPECT_EQ(sha256_of_file(file), wanted);
  EXPECT_EQ(sha256(bytes), wanted);
  EXPECT_NE(error_of([] { sha256_of_file("/nowhere"); }), "");
}

TEST(Hash, OfAMeshCoversHowItIsRead) {
  const fs::path file = fresh_folder("mesh") / "a.obj";
  std::ofstream(file) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const auto hash_of = [&](const core::MeshKeys& keys) {
    return mesh_hash({file.string(), cave::mesh_frame("test", file.string(), keys)});
  };
  EXPECT_EQ(hash_of({}), sha256_of_file(file)) << "as in campaigns that were flown before";
  const std::set<std::string> hashes{hash_of({}), hash_of({2, core::MeshUnit::m, core::UpAxis::z, ""}),
                                     hash_of({1, core::MeshUnit::mm, core::UpAxis::z, ""}),
                                     hash_of({1, core::MeshUnit::m, core::UpAxis::y, ""}),
                                     hash_of({1, core::MeshUnit::m, core::UpAxis::z, "0 0 1"})};
  EXPECT_EQ(hashes.size(), 5u);
  EXPECT_EQ(hash_of({0.001, core::MeshUnit::m, core::UpAxis::z, ""}),
            hash_of({1, core::MeshUnit::mm, core::UpAxis::z, "0 0 0"}))
      << "the same rock";
}

}  // namespace
}  // namespace karst::campaign
