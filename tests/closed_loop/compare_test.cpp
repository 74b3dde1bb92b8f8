// Campaigns of short flights through a tiny cave, as a user starts, kills and resumes them.
#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>

#include "tests/closed_loop/command.h"

namespace karst {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTables[] = {"campaign", "contestant", "cave", "trial", "curve", "result"};

/// All rows of a store but those of `timing`.
std::string rows(const fs::path& folder) {
  sqlite3* db = nullptr;
  EXPECT_EQ(sqlite3_open((folder / "campaign.sqlite").c_str(), &db), SQLITE_OK);
  std::string text;
  const auto line = [](void* out, int columns, char** values, char**) {
    for (int i = 0; i < columns; ++i)
      *static_cast<std::string*>(out) += std::string(values[i] ? values[i] : "NULL") + "|";
    *static_cast<std::string*>(out) += "\n";
    return 0;
  };
  for (const char* table : kTables)
    EXPECT_EQ(sqlite3_exec(db, (std::string("SELECT * FROM ") + table).c_str(), line, &text, nullptr),
              SQLITE_OK);
  sqlite3_close(db);
  return text;
}

int stored_trials(const fs::path& folder) {
  sqlite3* db = nullptr;
  int count = 0;
  if (sqlite3_open_v2((folder / "campaign.sqlite").c_str(), &db, SQLITE_OPEN_READWRITE, nullptr) == SQLITE_OK)
    sqlite3_exec(
        db, "SELECT count(*) FROM trial",
        [](void* n, int, char** values, char**) { return *static_cast<int*>(n) = std::atoi(values[0]), 0; },
        &count, nullptr);
  sqlite3_close(db);
  return count;
}

/// Processes whose command line names a folder.
int processes_naming(const fs::path& folder) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    std::ifstream in(entry.path() / "cmdline", std::ios::binary);
    std::ostringstream words;
    words << in.rdbuf();
    count += words.str().find(folder.string() + "/") != std::string::npos;
  }
  return count;
}

std::string campaign_of(const std::string& cave, const fs::path& folder) {
  return "nearest_frontier highest_frontier --caves " + cave + " --seeds 3 --time 12s --jobs 2 --out " +
         folder.string();
}

/// Starts a campaign as a process of its own, which is killed as soon as `enough` says so.
void run_and_kill(const std::string& arguments, const std::function<bool()>& enough) {
  const std::string binary = std::string(KARST_BINARY_DIR) + "/bin/karst";
  const std::string line = "exec " + binary + " compare " + arguments + " >/dev/null 2>&1";
  const pid_t pid = fork();
  if (pid == 0) {
    execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
    _exit(127);
  }
  int status = 0;
  while (!enough() && waitpid(pid, &status, WNOHANG) == 0) usleep(20000);
  kill(pid, SIGKILL);
  waitpid(pid, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status)) << "it ended before it could be killed";
}

TEST(Compare, KilledTwiceAndResumedItsStoreIsThatOfAnUndisturbedOne) {
  const fs::path dir = fresh_folder("compare_killed"), whole = dir / "whole", killed = dir / "killed";
  const std::string cave = generated_cave("small", 3);
  const Output undisturbed = run_karst("compare " + campaign_of(cave, whole));
  ASSERT_EQ(undisturbed.code, 0) << undisturbed.text;
  EXPECT_TRUE(undisturbed.says("| place | contestant")) << undisturbed.text;

  run_and_kill(campaign_of(cave, killed), [&] { return stored_trials(killed) >= 1; });
  for (int i = 0; i < 500 && processes_naming(killed) > 0; ++i) usleep(10000);
  EXPECT_EQ(processes_naming(killed), 0) << "its trials fly on";
  const int first = stored_trials(killed);
  EXPECT_GE(first, 1);
  run_and_kill(campaign_of(cave, killed), [&] { return stored_trials(killed) > first; });
  const int second = stored_trials(killed);
  EXPECT_GT(second, first);
  EXPECT_LT(second, 6);

  const Output resumed = run_karst("compare " + killed.string());  // the folder says what to fly
  ASSERT_EQ(resumed.code, 0) << resumed.text;
  // One more may have been flown, and not stored yet, when it was killed.
  const auto flown = [&](int n) {
    return resumed.says("6 trials, " + std::to_string(n) + " of them flown already");
  };
  EXPECT_TRUE(flown(second) || flown(second + 1)) << resumed.text;
  EXPECT_EQ(rows(killed), rows(whole));
  EXPECT_FALSE(fs::exists(killed / "flying"));
  EXPECT_FALSE(fs::exists(killed / "trials/nearest_frontier/small3/1/map.ot"))
      << "run directories are kept slim";
}

TEST(Compare, ATrialOfTheCampaignIsTheFlightThatFlyFlies) {
  const fs::path dir = fresh_folder("compare_fly");
  const std::string cave = generated_cave("small", 3);
  const Output compared = run_karst("compare nearest_frontier --caves " + cave +
                                    " --seeds 1 --time 12s --profile full --out " + (dir / "c").string());
  ASSERT_EQ(compared.code, 0) << compared.text;
  run_karst("fly --quiet --no-report --cave " + cave +
            " --policy nearest_frontier --seed 1 --set mission.max_flight_time=12s --out " +
            (dir / "f").string());
  EXPECT_EQ(bytes_of(dir / "c/trials/nearest_frontier/small3/1/metrics.json"),
            bytes_of(dir / "f/metrics.json"));
  EXPECT_EQ(bytes_of(dir / "c/trials/nearest_frontier/small3/1/trajectory.tum"),
            bytes_of(dir / "f/trajectory.tum"));
  // Though it crashes where the other would fly on: in a campaign a crash is the policy's failure.
  EXPECT_NE(bytes_of(dir / "c/missions/nearest_frontier/small3.info").find("isolation in_process"),
            std::string::npos);
  EXPECT_NE(bytes_of(dir / "f/mission.info").find("isolation process"), std::string::npos);
}

TEST(Compare, PoliciesHaveProcessesOfTheirOwnIfTheCampaignOrItsMissionSaysSo) {
  const fs::path dir = fresh_folder("compare_isolated");
  std::ofstream(dir / "base.info") << "policy { isolation process }\n";
  std::ofstream(dir / "c.info") << "mission base.info\nflight_time 12s\nseeds 1\ncave { file "
                                << generated_cave("small", 3)
                                << " }\ncontestant { policy nearest_frontier }\n";
  const std::string compare = "compare " + (dir / "c.info").string() + " --out ";
  ASSERT_EQ(run_karst(compare + (dir / "c").string()).code, 0);
  ASSERT_EQ(run_karst(compare + (dir / "d").string() + " --set policy.isolation=in_process").code, 0);
  const auto says = [&](const char* campaign, const char* what) {
    return bytes_of(dir / campaign / "missions/nearest_frontier/small3.info").find(what) != std::string::npos;
  };
  EXPECT_TRUE(says("c", "isolation process"));
  EXPECT_TRUE(says("d", "isolation in_process"));
}

TEST(Compare, CtrlCStopsCleanlyAndSaysHowToGoOn) {
  const fs::path dir = fresh_folder("compare_stopped");
  const std::string cave = generated_cave("small", 3);
  const Output out =
      run_karst("compare nearest_frontier --caves " + cave + " --seeds 2 --time 600s --jobs 1 --out " +
                (dir / "c").string() + " 2>&1 & p=$!; while [ -z \"$(ls " + (dir / "c/flying").string() +
                " 2>/dev/null)\" ]; do sleep 0.05; done; kill -INT $p; wait $p; echo code $?");
  EXPECT_TRUE(out.says("code 130")) << out.text;
  EXPECT_TRUE(out.says("karst compare " + (dir / "c").string() + " goes on where it was")) << out.text;
  EXPECT_FALSE(fs::exists(dir / "c/flying"));
}

TEST(Compare, WhatIsWrongIsSaidBeforeAnythingFlies) {
  const fs::path dir = fresh_folder("compare_bad");
  const std::string cave = generated_cave("small", 3);
  const auto refused = [&](const std::string& arguments, std::initializer_list<const char*> parts) {
    const Output out = run_karst("compare " + arguments + " --out " + (dir / "c").string());
    EXPECT_EQ(out.code, 1) << out.text;
    for (const char* part : parts)
      EXPECT_TRUE(out.says(part)) << "expected \"" << part << "\" in:\n" << out.text;
    EXPECT_FALSE(fs::exists(dir / "c" / "campaign.sqlite"));
  };
  refused("nearest_fronteer --caves " + cave,
          {"contestant nearest_fronteer", "did you mean nearest_frontier"});
  refused("nearest_frontier:min_cels=3 --caves " + cave, {"min_cels", "did you mean", "min_cells"});
  refused("nearest_frontier:min_cells=-3 --caves " + cave, {"parameters.min_cells", "1 to 10000", "-3"});
  refused("nearest_frontier nearest_frontier --caves " + cave, {"two of this name"});
  refused("nearest_frontier --caves " + cave + " --set motion.max_sped=1", {"did you mean motion.max_speed"});
  refused("nearest_frontier --caves " + cave + " --metric coverag", {"coverag", "did you mean coverage"});
  refused("nearest_frontier --caves " + (dir / "none.info").string(), {"none.info", "is not there"});
  refused("nearest_frontier highest_frontier", {"--caves"});
  std::ofstream(dir / "no.ply") << "ply\n";
  refused("nearest_frontier --caves " + (dir / "no.ply").string(), {"no.ply"});
  refused("/nowhere/c.info", {"/nowhere/c.info"});
  for (const std::string& beside :
       std::vector<std::string>{" nearest_frontier", " other.info", " --caves " + cave})
    refused("c.info" + beside, {"c.info: is a campaign's file or folder, which stands alone"});
  const std::string crashing = std::string(KARST_BINARY_DIR) + "/tests/plugins/crash_at_load.so";
  ASSERT_TRUE(fs::exists(crashing));
  refused("plain --plugin " + crashing + " --caves " + cave, {"crash_at_load.so"});
}

// As it was: "command line:" and "--set:" were named for what a campaign's file says.
TEST(Compare, WhatIsWrongInACampaignFileIsSaidOfItsEntry) {
  const fs::path dir = fresh_folder("compare_bad_file");
  const std::string cave = generated_cave("small", 3), file = (dir / "c.info").string();
  const auto complaint = [&](const std::string& contestant, const std::string& start, const std::string& rest,
                             const std::string& arguments = "") {
    std::ofstream(file) << "contestant { name near policy nearest_frontier " << contestant << " }\nseeds 2\n"
                        << "cave { name maze file " << cave << " " << start << " }\n"
                        << rest;
    const Output out = run_karst("compare " + file + " --out " + (dir / "c").string() + arguments);
    EXPECT_EQ(out.code, 1) << out.text;
    return out.text;
  };
  const auto starts = [&](const std::string& text, const std::string& place) {
    EXPECT_EQ(text.find("karst: " + place), 0u) << text;
  };
  starts(complaint("parameters { min_cels 3 }", "", ""),
         file + ": contestant near: parameters.min_cels: no such key; did you mean min_cells?");
  starts(complaint("settings { motion { max_speed \"900 m/s\" } }", "", ""),
         file + ": contestant near: settings.motion.max_speed: expected");
  starts(complaint("", "", "settings { motion { max_sped 1 } }"),
         file + ": settings.motion.max_sped: no such key");
  starts(complaint("", "", "", " --set motion.max_sped=1"),
         "command line: --set: motion.max_sped: no such key");
  starts(complaint("", "start \"1 2\"", ""), file + ": cave maze: start");
  starts(complaint("", "start \"900 900 900\"", ""), file + ": cave maze: start: ");
  starts(complaint("", "",
                   "contestant { policy nearest_frontier settings { simulator { battery_minutes 1 } } }"),
         file + ": contestant nearest_frontier+battery_minutes=1: may explore for 60.0 s, near for 300.0 s");
  starts(run_karst("select --leave-one-out --results " + dir.string()).text,
         dir.string() + ": holds no campaign");
  starts(run_karst("results " + dir.string()).text, dir.string() + ": holds no campaign");
  starts(run_karst("select --cave " + dir.string()).text, dir.string() + ": is a directory");
  const Output tune = run_karst("tune nearest_frontier --caves " + cave + " --out " + file);
  EXPECT_NE(tune.code, 0);
  EXPECT_TRUE(tune.says("--out: " + file + " is a file; expected a folder")) << tune.text;
}

TEST(Compare, WhatCannotShowADifferenceIsSaidBeforeItFliesAndTheDeclaredMetricIsTheVerdicts) {
  const fs::path dir = fresh_folder("compare_few");
  const std::string cave = generated_cave("small", 3), out = (dir / "c").string();
  std::ofstream(dir / "c.info")
      << "metric path_length_m\nflight_time 12s\nseeds 1\ncave { file " << cave
      << " }\ncontestant { policy nearest_frontier }\ncontestant { policy highest_frontier }\n";
  const Output flown = run_karst("compare " + (dir / "c.info").string() + " --out " + out);
  ASSERT_EQ(flown.code, 0) << flown.text;
  EXPECT_TRUE(flown.says("no difference can be shown by this campaign")) << flown.text;
  EXPECT_TRUE(flown.says("needs 6 pairs of flights, and these are 1; fly 6 seeds at least")) << flown.text;
  EXPECT_TRUE(flown.says("the flight time of 12 s leaves no time to explore")) << flown.text;
  EXPECT_TRUE(flown.says("failed | path_length_m |")) << flown.text;
  const Output declared = run_karst("results " + out),
               other = run_karst("results " + out + " --metric coverage");
  EXPECT_TRUE(declared.says("failed | path_length_m |")) << declared.text;
  EXPECT_TRUE(other.says("declared path_length_m before it flew; what follows is about coverage."))
      << other.text;
  EXPECT_TRUE(other.says("failed | coverage |")) << other.text;

  const std::string paper = "results " + out + " --paper " + (dir / "paper").string();
  const Output written = run_karst(paper), again = run_karst(paper), forced = run_karst(paper + " --force");
  EXPECT_EQ(written.code, 0) << written.text;
  EXPECT_TRUE(written.says((dir / "paper/ranking.tex").string())) << written.text;
  EXPECT_NE(bytes_of(dir / "paper/ranking.tex").find("path\\_length\\_m"), std::string::npos);
  EXPECT_EQ(again.code, 1);
  EXPECT_TRUE(again.says("is there already; --force overwrites it")) << again.text;
  EXPECT_EQ(forced.code, 0) << forced.text;
}

TEST(Compare, AnotherCampaignInTheFolderIsRefusedSayingWhatDiffersAndMoreSeedsAreFlown) {
  const fs::path dir = fresh_folder("compare_changed");
  const std::string cave = generated_cave("small", 3), out = " --time 12s --out " + (dir / "c").string();
  ASSERT_EQ(run_karst("compare nearest_frontier --seeds 1 --caves " + cave + out).code, 0);
  const Output other =
      run_karst("compare nearest_frontier --seeds 1 --set motion.max_speed=1 --caves " + cave + out);
  EXPECT_EQ(other.code, 1);
  EXPECT_TRUE(other.says("contestant nearest_frontier: motion.max_speed was")) << other.text;
  const Output more = run_karst("compare nearest_frontier highest_frontier --seeds 2 --caves " + cave + out);
  EXPECT_EQ(more.code, 0) << more.text;
  EXPECT_TRUE(more.says("4 trials, 1 of them flown already")) << more.text;
  EXPECT_EQ(stored_trials(dir / "c"), 4);
}

TEST(Compare, WhatIsGivenBesideAFolderIsRefused) {
  const fs::path dir = fresh_folder("compare_beside");
  const Output out = run_karst("compare " + dir.string() + " --seeds 20");
  EXPECT_EQ(out.code, 1);
  EXPECT_TRUE(out.says("--seeds")) << out.text;
}

TEST(Compare, ABuildUnderItsFeetStopsTheCampaign) {
  const fs::path dir = fresh_folder("compare_rebuilt");
  fs::create_directories(dir / "bin");
  fs::create_directories(dir / "lib");
  const fs::path build = KARST_BINARY_DIR, karst = dir / "bin/karst", store = dir / "c";
  fs::copy_file(build / "bin/karst", karst);
  fs::create_directory_symlink(build / "lib/karst", dir / "lib/karst");
  const std::string compare = "compare nearest_frontier --seeds 40 --jobs 1 --caves " +
                              generated_cave("small", 3) + " --out " + store.string();
  const Output out = run_command(karst.string() + " " + compare +
                                 " --time 12s 2>&1 & p=$!; while [ -z \"$(ls " + (store / "flying").string() +
                                 " 2>/dev/null)\" ]; do sleep 0.05; done; touch -d 2001-01-01 " +
                                 karst.string() + "; wait $p; echo code $?");
  EXPECT_TRUE(out.says("code 1")) << out.text;
  EXPECT_TRUE(out.says("was changed while the campaign flew")) << out.text;
  EXPECT_LT(stored_trials(store), 40);
}

TEST(Compare, WhatAutoChoseIsTheContestantsPolicyInEveryCave) {
  const fs::path dir = fresh_folder("compare_auto");
  const std::string table =
      " --set policy.auto.cave.name=small3 --set policy.auto.cave.policy=highest_frontier --seeds 1 --time "
      "12s";
  const std::string compare = "compare auto --caves " + generated_cave("small", 3);
  const Output one = run_karst(compare + table + " --out " + (dir / "one").string());
  ASSERT_EQ(one.code, 0) << one.text;
  EXPECT_NE(rows(dir / "one").find("|auto|highest_frontier|"), std::string::npos) << rows(dir / "one");
  const Output two =
      run_karst(compare + " " + generated_cave("small", 4) + table + " --out " + (dir / "two").string());
  EXPECT_EQ(two.code, 1);
  EXPECT_TRUE(two.says("contestant auto in cave small4")) << two.text;
  EXPECT_FALSE(fs::exists(dir / "two" / "campaign.sqlite"));
}

TEST(Compare, AHungTrialIsAResult) {
  const fs::path dir = fresh_folder("compare_crash");
  const std::string cave = generated_cave("small", 3);
  const Output out = run_karst("compare nearest_frontier --seeds 1 --time 600s --trial-timeout 2s --caves " +
                               cave + " --out " + (dir / "c").string());
  EXPECT_EQ(out.code, 0) << out.text;
  EXPECT_TRUE(out.says("hung: not done after 2 s")) << out.text;
  const std::string all = rows(dir / "c");
  EXPECT_NE(all.find("|failed|failed|hung: not done after 2 s"), std::string::npos) << all;
}

TEST(PolicyStream, ChangesThePolicysRandomNumbersAndNothingElse) {
  const fs::path dir = fresh_folder("policy_stream");
  const std::string cave = generated_cave("small", 3);
  const auto fly = [&](const std::string& name, const std::string& more) {
    run_karst("fly --quiet --no-report --cave " + cave +
              " --policy nearest_frontier --seed 1 --set mission.max_flight_time=12s --out " +
              (dir / name).string() + more);
    return bytes_of(dir / name / "trajectory.tum");
  };
  // This policy draws no random numbers: its flight, and with it noise and gusts, must be the same.
  const std::string plain = fly("plain", "");
  EXPECT_FALSE(plain.empty());
  EXPECT_EQ(fly("stream", " --set policy.stream=7"), plain);
}

}  // namespace
}  // namespace karst
