// Every kind of bad input a user can give the command: a clear error, a non-zero exit, nothing lost.
#include <sys/stat.h>

#include <regex>
#include <utility>

#include "core_stack/common/sanitized.h"
#include "tests/closed_loop/command.h"
#include "tests/closed_loop/drawn_cave.h"

namespace karst {
namespace {

namespace fs = std::filesystem;

/// A box of rock around the origin as an STL in text: 12 triangles, without the first `missing`.
std::string box_stl(double half_m, int missing = 0) {
  const double c[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                          {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
  const int f[12][3] = {{4, 5, 6}, {4, 6, 7}, {0, 2, 1}, {0, 3, 2}, {0, 1, 5}, {0, 5, 4},
                        {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
  std::ostringstream out;
  out << "solid box\n";
  for (int i = missing; i < 12; ++i) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (const int v : f[i])
      out << "vertex " << half_m * c[v][0] << ' ' << half_m * c[v][1] << ' ' << half_m * c[v][2] << '\n';
    out << "endloop\nendfacet\n";
  }
  out << "endsolid box\n";
  return out.str();
}

std::string written(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
  return file.string();
}

/// Flies for an instant; what is wrong must be said before.
Output fly(const fs::path& folder, const std::string& arguments) {
  return run_karst("fly --quiet --set mission.max_flight_time=10s --out " + (folder / "run").string() + " " +
                   arguments);
}

void expect_refused(const Output& out, std::initializer_list<const char*> parts) {
  EXPECT_EQ(out.code, 1) << out.text;
  for (const char* part : parts)
    EXPECT_TRUE(out.says(part)) << "expected \"" << part << "\" in:\n" << out.text;
  EXPECT_FALSE(out.says("terminate called")) << out.text;
}

TEST(BadInput, ANumberThatIsNone) {
  for (const char* arguments : {"select --cave x.info --level nan", "cave info x.info --resolution nan",
                                "cave info x.info --clearance inf", "evaluate x --density nan",
                                "evaluate x --delta nan", "map merge a b --out c --resolution nan"})
    expect_refused(run_karst(arguments), {"expected a number in "});
}

TEST(BadInput, ATruncatedMesh) {
  const fs::path dir = fresh_folder("bad_truncated");
  std::string binary(80, ' ');
  const std::uint32_t declared = 100;
  binary.append(reinterpret_cast<const char*>(&declared), 4);
  binary.append(50 * 7, '\1');  // seven triangles of the hundred declared
  const std::string mesh = written(dir / "cut.stl", binary);
  expect_refused(fly(dir, "--cave " + mesh + " --start '0 0 0'"), {"cut.stl", "truncated"});
}

TEST(BadInput, AMeshWithAHoleAtTheStart) {
  const fs::path dir = fresh_folder("bad_hole");
  const std::string mesh = written(dir / "open.stl", box_stl(4, 2));
  expect_refused(fly(dir, "--cave " + mesh + " --start '0 0 0'"), {"open.stl", "hole"});
}

TEST(BadInput, AFlightIsRefusedWhereCaveInfoRefuses) {
  // As it was: it flew, and said afterwards that its coverage could not be known. The hole lies behind a
  // corner, out of sight of the start.
  const fs::path dir = fresh_folder("bad_hole_far");
  const std::string cave = draw_cave(
      dir, {{{0, 0, 0}, {12, 4, 4}}, {{8, 0, 0}, {12, 12, 4}}, {{8, 8, 0}, {20, 12, 4}}}, {2, 2, 1.5});
  std::string mesh = bytes_of(dir / "cave.obj");
  const std::size_t face = mesh.rfind("\nf ");
  written(dir / "cave.obj", mesh.substr(0, face + 1));
  expect_refused(run_karst("cave info " + cave), {"free space leads outside the mesh"});
  expect_refused(fly(dir, "--cave " + cave), {"free space leads outside the mesh"});
  EXPECT_FALSE(fs::exists(dir / "run"));
}

TEST(BadInput, ATeamWithoutRoomToStandLeavesNoFolderBehind) {
  const fs::path dir = fresh_folder("bad_team_room");
  const std::string cave = draw_cave(dir, {{{0, 0, 0}, {3, 2, 3}}}, {1, 1, 1});
  expect_refused(fly(dir, "--cave " + cave + " --set team.robots=12"), {"room for", "vehicles side by side"});
  EXPECT_FALSE(fs::exists(dir / "run"));
}

TEST(BadInput, ACaveCacheThatIsNoFolder) {
  const fs::path dir = fresh_folder("bad_cache");
  const std::string mesh = written(dir / "box.stl", box_stl(4)), file = written(dir / "taken", "a file");
  for (const std::string& cache : {file, file + "/below"})
    expect_refused(fly(dir, "--cave " + mesh + " --start '0 0 0' --cave-cache " + cache),
                   {"--cave-cache", "is not a writable directory"});
  EXPECT_FALSE(fs::exists(dir / "run"));
}

TEST(BadInput, AStartInsideRock) {
  const fs::path dir = fresh_folder("bad_start");
  const std::string mesh = written(dir / "box.stl", box_stl(4));
  expect_refused(fly(dir, "--cave " + mesh + " --start '9 0 0'"), {"box.stl", "outside of the cave"});
  expect_refused(fly(dir, "--cave " + mesh + " --start '3.9 0 0'"), {"box.stl", "rock"});
}

TEST(BadInput, AStartThatIsNoPose) {
  const fs::path dir = fresh_folder("bad_pose");
  const std::string mesh = written(dir / "box.stl", box_stl(4));
  expect_refused(fly(dir, "--cave " + mesh + " --start '1 2'"), {"start"});
  expect_refused(fly(dir, "--cave " + mesh), {"start"});
}

TEST(BadInput, AnUnknownKeyAndAWrongUnit) {
  const fs::path dir = fresh_folder("bad_keys");
  const std::string mesh = written(dir / "box.stl", box_stl(4));
  const std::string a =
      written(dir / "a.info", "cave { file box.stl start \"0 0 0\" }\nmotion { max_sped 2 }\n");
  expect_refused(fly(dir, a), {"a.info", "motion.max_sped", "did you mean motion.max_speed"});
  const std::string b =
      written(dir / "b.info", "cave { file box.stl start \"0 0 0\" }\nmotion { max_speed \"2 kg\" }\n");
  expect_refused(fly(dir, b), {"b.info", "motion.max_speed", "m/s", "kg"});
  const std::string c = written(
      dir / "c.info", "cave { file box.stl start \"0 0 0\" }\npolicy { parameters { nonsense 1 } }\n");
  expect_refused(fly(dir, c), {"c.info", "policy.parameters.nonsense"});
}

TEST(BadInput, SpeedsInTheWrongOrder) {
  const fs::path dir = fresh_folder("bad_speeds");
  const std::string mesh = written(dir / "box.stl", box_stl(4));
  expect_refused(
      fly(dir, "--cave " + mesh + " --start '0 0 0' --set motion.min_speed=1 --set motion.max_speed=0.5"),
      {"motion.min_speed", "motion.max_speed"});
}

TEST(BadInput, AMissingPolicy) {
  const fs::path dir = fresh_folder("bad_policy");
  const std::string mesh = written(dir / "box.stl", box_stl(4));
  expect_refused(fly(dir, "--cave " + mesh + " --start '0 0 0' --policy nearest_fronteer"),
                 {"nearest_fronteer", "nearest_frontier"});
}

TEST(BadInput, APolicyOfAbiMajorTwo) {
  const fs::path dir = fresh_folder("bad_major");
  const std::string mesh = written(dir / "box.stl", box_stl(4));
  const std::string plugin = std::string(KARST_BINARY_DIR) + "/tests/plugins/wrong_major.so";
  ASSERT_TRUE(fs::exists(plugin));
  expect_refused(fly(dir, "--cave " + mesh + " --start '0 0 0' --policy plain --plugin " + plugin),
                 {"wrong_major.so", "ABI 2.0", "1.0", "rebuild"});
}

TEST(BadInput, MissingFiles) {
  const fs::path dir = fresh_folder("bad_missing");
  expect_refused(fly(dir, "/nowhere/mission.info"), {"/nowhere/mission.info"});
  expect_refused(fly(dir, "--cave /nowhere/cave.stl --start '0 0 0'"), {"/nowhere/cave.stl"});
  expect_refused(run_karst("report " + dir.string()), {"mission.info"});
}

TEST(BadInput, AnOutputDirectoryThatCannotBeWritten) {
  const fs::path dir = fresh_folder("bad_out");
  const std::string mesh = written(dir / "box.stl", box_stl(4));
  expect_refused(run_karst("fly --quiet --cave " + mesh + " --start '0 0 0' --out /proc/karst_run"),
                 {"/proc/karst_run"});
  const std::string file = written(dir / "file", "not a folder");
  expect_refused(run_karst("fly --quiet --cave " + mesh + " --start '0 0 0' --out " + file), {"file"});
}

TEST(BadInput, ARunIsNeverOverwritten) {
  const fs::path dir = fresh_folder("bad_overwrite");
  const std::string mesh = written(dir / "box.stl", box_stl(4));
  fs::create_directories(dir / "run");
  written(dir / "run" / "events.jsonl", "precious\n");
  expect_refused(fly(dir, "--cave " + mesh + " --start '0 0 0'"),
                 {"has files of a run already (events.jsonl)"});
  EXPECT_EQ(bytes_of(dir / "run" / "events.jsonl"), "precious\n");
}

TEST(BadInput, AStartBeyondAHundredKilometres) {
  const fs::path dir = fresh_folder("bad_far");
  const std::string mesh = written(dir / "box.stl", box_stl(4));
  for (const char* start : {"0 0 1e19", "1e37 0 0", "0 -1e300 0", "100001 0 0"})
    expect_refused(fly(dir, "--cave " + mesh + " --start '" + start + "'"), {"start", "within 100 km"});
}

TEST(BadInput, AMissionNestedAHundredThousandDeep) {
  const fs::path dir = fresh_folder("bad_deep");
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "a {\n";
  expect_refused(fly(dir, written(dir / "deep.info", deep)), {"deep.info", "line 101", "deep"});
}

TEST(BadInput, AFileOfTheUsersIsNeverOverwritten) {
  const fs::path dir = fresh_folder("bad_user_files");
  const std::string mesh = written(dir / "box.stl", box_stl(4));
  for (const char* name : {"mission.info", "map.ply", "report.html", "truth.csv"}) {
    fs::create_directories(dir / "run");
    written(dir / "run" / name, "precious\n");
    expect_refused(fly(dir, "--cave " + mesh + " --start '0 0 0'"), {name, "has files of a run already"});
    EXPECT_EQ(bytes_of(dir / "run" / name), "precious\n");
    EXPECT_EQ(std::distance(fs::directory_iterator(dir / "run"), {}), 1);
    fs::remove_all(dir / "run");
  }
}

TEST(BadInput, ARefusedFlightLeavesNothingInADirectoryThatWasThere) {
  const fs::path dir = fresh_folder("bad_refused");
  const std::string mesh = written(dir / "box.stl", box_stl(4));
  fs::create_directories(dir / "run");
  expect_refused(fly(dir, "--cave " + mesh + " --start '0 0 -2' --set mission.takeoff_height=8m"), {"start"});
  EXPECT_TRUE(fs::is_empty(dir / "run"));
}

TEST(BadInput, AnOptionAndASettingOfTheSameKey) {
  // As it was: --time won, and nothing said so.
  const fs::path dir = fresh_folder("bad_twice");
  const std::string mesh = written(dir / "box.stl", box_stl(4));
  const std::string flight = "--cave " + mesh + " --start '0 0 0' ";
  expect_refused(fly(dir, flight + "--time 60s --set mission.max_flight_time=90s"),
                 {"--time", "mission.max_flight_time", "--set", "give one of them"});
  expect_refused(fly(dir, flight + "--seed 3 --set seed=4"), {"--seed", "give one of them"});
  expect_refused(fly(dir, flight + "--in-process --set policy.isolation=process"),
                 {"--in-process", "give one of them"});
}

TEST(BadInput, EmptyOptionsAreNoDefaults) {
  const fs::path dir = fresh_folder("bad_empty");
  const std::string mesh = written(dir / "box.stl", box_stl(4));
  for (const char* option : {"--policy", "--seed", "--start", "--out", "--plugin"})
    expect_refused(run_karst("fly --cave " + mesh + " " + option + " ''"), {option});
}

TEST(BadInput, ASeedOfACaveThatIsNone) {
  const fs::path dir = fresh_folder("bad_cave_seed");
  for (const char* seed : {"-1", "18446744073709551616", "1.5", "''"})
    expect_refused(run_karst("cave generate --out " + (dir / "c").string() + " --seed " + seed), {"--seed"});
  EXPECT_TRUE(fs::is_empty(dir));
}

TEST(BadInput, ACaveIsNotOverwrittenUnlessForced) {
  const fs::path dir = fresh_folder("bad_cave_there");
  written(dir / "c.ply", "precious\n");
  const std::string generate =
      "cave generate --set volume=500 --set 'grid=0.4 m' --out " + (dir / "c").string();
  expect_refused(run_karst(generate), {"c.ply", "--force"});
  EXPECT_EQ(bytes_of(dir / "c.ply"), "precious\n");
  const Output forced = run_karst(generate + " --force");
  EXPECT_EQ(forced.code, 0) << forced.text;
}

TEST(BadInput, AFullStandardOutput) {
  for (const char* command : {"--help", "policy list", "fly --keys"})
    expect_refused(run_karst(std::string(command) + " 2>&1 >/dev/full #"), {"standard output"});
}

TEST(BadInput, ASettingDoesNotSwallowTheMissionFile) {
  const fs::path dir = fresh_folder("bad_swallow");
  expect_refused(run_karst("fly --set seed=3 " + (dir / "none.info").string()),
                 {"none.info", "cannot be opened"});
}

TEST(BadInput, ATableOfRunsNamesWhatIsNone) {
  const fs::path dir = fresh_folder("bad_table");
  fs::create_directories(dir / "cut");
  fs::create_directories(dir / "good");
  written(dir / "cut" / "metrics.json", "{\"cave\": \"c");
  written(dir / "good" / "metrics.json", "{\"cave\": \"lava\", \"outcome\": \"landed\"}");
  expect_refused(run_karst("table " + (dir / "nope").string()), {"nope: no such run"});
  expect_refused(run_karst("table " + dir.string()), {"passed over", "bad_table: no run directory"});
  expect_refused(run_karst("table " + (dir / "cut").string() + " " + (dir / "good").string()),
                 {"damaged metrics.json", "| lava |"});
}

TEST(BadInput, AReportWithoutItsCaveKeepsWhatIsKnown) {
  const fs::path dir = fresh_folder("bad_moved_cave");
  written(dir / "mission.info", "cave { file /nowhere/moved.ply start \"0 0 0\" }\n");
  written(dir / "metrics.json",
          "{\"coverage\": 0.625, \"reachable_volume_m3\": 512.5, \"drift_percent\": 3}");
  const Output out = run_karst("report " + dir.string());
  EXPECT_EQ(out.code, 0) << out.text;
  EXPECT_TRUE(out.says("moved.ply") && out.says("kept") && out.says("coverage")) << out.text;
  const std::string metrics = bytes_of(dir / "metrics.json");
  EXPECT_NE(metrics.find("\"coverage\": 0.625"), std::string::npos) << metrics;
  EXPECT_NE(metrics.find("\"reachable_volume_m3\": 512.5"), std::string::npos) << metrics;
  EXPECT_NE(metrics.find("\"drift_percent\": null"), std::string::npos) << "the cave does not say this one";
}

TEST(BadInput, UsageErrorsNameTheWord) {
  expect_refused(run_karst("reprt x"), {"\"reprt\" is no command", "did you mean report"});
  expect_refused(run_karst("cave genrate --out x"), {"\"genrate\" is no command", "did you mean generate"});
  EXPECT_FALSE(run_karst("reprt x").says("subcommand is required")) << "it was said twice";
  expect_refused(run_karst("fly --polcy x"),
                 {"karst: \"--polcy\" is no option of karst fly; did you mean --policy?"});
  expect_refused(
      run_karst("cave info --zzzzz"),
      {"karst: \"--zzzzz\" is no option of karst cave info; `karst cave info --help` says more\n"});
  expect_refused(run_karst("fly --threads many"), {"--threads", "many"});
  EXPECT_EQ(run_karst("--verison").text,
            "karst: \"--verison\" is no option of karst; did you mean --version? `karst --help` says more\n")
      << "it was called a command";
  // Only near spellings are meant: --tome was said to mean --cave.
  EXPECT_EQ(run_karst("cave info --tome x").text,
            "karst: \"--tome\" is no option of karst cave info; `karst cave info --help` says more\n");
  EXPECT_FALSE(run_karst("flew").says("did you mean"));
  EXPECT_TRUE(run_karst("fy").says("did you mean fly?"));
}

// "cave is required", "--paper: 1 required FOLDER missing", "shell: fish not in {bash,zsh}", and "Run with
// --help or --help-all for more information".
TEST(BadInput, UsageErrorsNameTheCommandAndWhereToReadMore) {
  for (const auto& [arguments, said] :
       {std::pair{"preflight",
                  "karst: karst preflight: argument cave is missing, or --vehicle with the name of a vehicle "
                  "plugin; `karst "
                  "preflight --help` says more\n"},
        std::pair{"fly a b c",
                  "karst: karst fly: \"b\" is more than it takes; `karst fly --help` says more\n"},
        std::pair{"fly --out",
                  "karst: karst fly: --out: needs a value, FOLDER; `karst fly --help` says more\n"},
        std::pair{"completion fish",
                  "karst: karst completion: shell: expected bash or zsh, got \"fish\"; "
                  "`karst completion --help` says more\n"},
        std::pair{"fly --threads many",
                  "karst: karst fly: --threads: expected a number from 1 to 256, got "
                  "\"many\"; `karst fly --help` says more\n"},
        std::pair{"reprt", "karst: \"reprt\" is no command; did you mean report? `karst --help` says more\n"},
        std::pair{"fly --seed x",
                  "karst: karst fly: --seed: expected another kind of value, got \"x\"; "
                  "`karst fly --help` says more\n"}}) {
    const Output out = run_karst(arguments);
    EXPECT_EQ(out.code, 1) << arguments;
    EXPECT_EQ(out.text, said) << arguments;
  }
}

// It was an error: "A subcommand is required".
TEST(BadInput, KarstAndItsGroupsAlonePrintTheirHelp) {
  for (const char* group : {"", "policy", "cave", "map"}) {
    const Output alone = run_karst(group), help = run_karst(std::string(group) + " --help");
    EXPECT_EQ(alone.code, 0) << alone.text;
    EXPECT_EQ(alone.text, help.text);
    EXPECT_TRUE(alone.says("Usage:") && alone.says("Subcommands:")) << alone.text;
  }
  for (const char* wrong : {"--nonsense", "policy --nonsense", "map --nonsense"})
    expect_refused(run_karst(wrong), {"--nonsense"});
}

TEST(BadInput, HelpIsACommandToo) {
  EXPECT_EQ(run_karst("help").text, run_karst("--help").text);
  EXPECT_EQ(run_karst("help fly").text, run_karst("fly --help").text);
  EXPECT_EQ(run_karst("help cave generate").text, run_karst("cave generate --help").text);
  EXPECT_EQ(run_karst("help cave generate").code, 0);
  expect_refused(run_karst("help reprt"), {"karst: \"reprt\" is no command; did you mean report?"});
  expect_refused(run_karst("help cave genrate"), {"did you mean generate?", "`karst cave --help` says more"});
}

TEST(BadInput, ACaveFileIsNoMission) {
  const fs::path dir = fresh_folder("bad_cave_as_mission");
  written(dir / "box.stl", box_stl(4));
  const std::string cave = written(dir / "box.info", "mesh box.stl\nstart \"0 0 0\"\n"),
                    said = cave + ": is a cave file; fly it with karst fly --cave " + cave;
  expect_refused(run_karst("fly " + cave), {said.c_str()});
}

TEST(BadInput, AFlightTimeIsReadAsOfTheMission) {
  const fs::path dir = fresh_folder("bad_flight_time");
  const std::string mesh = written(dir / "box.stl", box_stl(4)), resolved = (dir / "resolved.info").string();
  const Output out =
      run_karst("fly --cave " + mesh + " --start '0 0 0' --quiet --time 5min --check " + resolved);
  ASSERT_EQ(out.code, 0) << out.text;
  EXPECT_NE(bytes_of(resolved).find("max_flight_time \"300 s\""), std::string::npos) << bytes_of(resolved);
  expect_refused(run_karst("fly --cave " + mesh + " --start '0 0 0' --time soon"),
                 {"mission.max_flight_time", "soon"});
}

TEST(BadInput, UsageErrorsTeach) {
  const Output nothing = run_karst("fly");
  EXPECT_NE(nothing.code, 0);
  EXPECT_TRUE(nothing.says("--cave")) << nothing.text;
  EXPECT_TRUE(run_karst("fly --help").says("karst fly mission.info"));
}

/// The pages and examples that a text names.
std::vector<std::string> files_named(const std::string& text) {
  const std::regex path(R"re([^\s"'(]*\b(docs|examples)/[\w./-]*\w)re");
  std::vector<std::string> out;
  for (std::sregex_iterator m(text.begin(), text.end(), path), end; m != end; ++m) out.push_back(m->str());
  return out;
}

// They named docs/tune.md and the like, which are in no folder of a user's. Of an installed karst the same is
// asked by installed_karst_test.sh.
TEST(BadInput, HelpNamesFilesThatAreThere) {
  for (const auto& [arguments, least] :
       {std::pair{"--help-all", std::size_t{5}}, std::pair{"fly --keys", std::size_t{2}}}) {
    const Output help = run_karst(arguments);
    EXPECT_EQ(help.code, 0) << help.text;
    const std::vector<std::string> files = files_named(help.text);
    EXPECT_GE(files.size(), least) << help.text;
    for (const std::string& file : files)
      EXPECT_TRUE(fs::path(file).is_absolute() && fs::exists(file)) << arguments << " names " << file;
  }
}

/// What `karst ARGUMENTS` says, which would wait for ever for a FIFO's other end: here for twenty seconds.
Output within_limits(const std::string& arguments) {
  return run_command((kSanitized ? "" : "ulimit -v 8000000; ") + std::string("timeout 20 ") +
                     KARST_BINARY_DIR + "/bin/karst " + arguments);
}

// They blocked, or filled the memory.
TEST(BadInput, AFifoOrADeviceIsNoInput) {
  const fs::path dir = fresh_folder("bad_fifo");
  const std::string mesh = written(dir / "box.stl", box_stl(4));
  fs::create_directories(dir / "run");
  for (const char* name :
       {"f.ply", "f.info", "f.so", "f.bt", "f.tum", "f.sqlite", "f.pcd", "run/metrics.json"})
    ASSERT_EQ(mkfifo((dir / name).c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", dir / "zero.info");
  fs::create_symlink("/dev/zero", dir / "zero.ply");
  const auto at = [&](const char* name) { return (dir / name).string(); };
  const std::string start = " --start '0 0 0'";
  for (const char* kind : {"f", "zero"}) {
    const std::string named = at(kind), why = std::string(kind) == "f" ? "is a FIFO" : "is a device";
    for (const std::string& arguments :
         {"fly --out " + at("out") + " --cave " + named + ".ply" + start,
          "fly --out " + at("out") + " " + named + ".info",
          "fly --out " + at("out") + " --cave " + mesh + start + " --preset " + named + ".info",
          "cave info " + named + ".ply", "cave info " + named + ".info", "compare " + named + ".info"})
      expect_refused(within_limits(arguments), {why.c_str(), "not a regular file"});
  }
  expect_refused(within_limits("policy check " + at("f.so")), {"is a FIFO"});
  const Output merged = within_limits("map merge " + at("f.bt") + " " + at("f.bt") + " --out " + at("m"));
  expect_refused(merged, {});
  EXPECT_TRUE(merged.says("is a FIFO") || merged.says("built without PCL")) << merged.text;
  EXPECT_NE(within_limits("table " + at("run")).code, 124) << "it waited for the FIFO";
}

// They erased the screen, set the title and hid what was said before.
TEST(BadInput, WhatOthersWroteIsNotObeyedByATerminal) {
  const fs::path dir = fresh_folder("bad_escapes");
  fs::create_directories(dir / "run");
  written(dir / "run" / "metrics.json", R"({"cave": "a\u001b[2Jb\u009b2Jc\u202ed", "outcome": "landed"})");
  const Output table = run_karst("table " + (dir / "run").string());
  EXPECT_TRUE(table.says("a?[2Jb?2Jc?d")) << table.text;
  const std::string name = "evil\033]0;owned\007.info";
  written(dir / name, "mission { \033[2J 1 }\n");
  const Output refused = run_karst("fly '" + (dir / name).string() + "'");
  expect_refused(refused, {"evil?]0;owned?.info"});
  for (const Output* out : {&table, &refused})
    for (const char* obeyed : {"\033", "\007", "\xc2\x9b", "\xe2\x80\xae"})
      EXPECT_FALSE(out->says(obeyed)) << out->text;
}

TEST(BadInput, AMissionOfAGigabyteOrAMillionKeysIsRefusedInShortWords) {
  const fs::path dir = fresh_folder("bad_large");
  fs::resize_file(written(dir / "gigabyte.info", ""), std::uintmax_t{1} << 30);
  expect_refused(within_limits("fly " + (dir / "gigabyte.info").string()),
                 {"gigabyte.info: is 1073741824 bytes"});
  std::string keys;
  for (int i = 0; i < 1'000'000; ++i) keys += "k 1\n";
  expect_refused(within_limits("fly " + written(dir / "keys.info", keys)),
                 {"keys.info: line 200001: more than"});
  const Output longest =
      run_karst("fly " + written(dir / "value.info", "seed " + std::string(60'000, '7') + "\n"));
  expect_refused(longest, {"value.info: seed"});
  EXPECT_LT(longest.text.size(), 10'000u);
}

TEST(BadInput, AFirstHoverAboveTheCeilingIsRefusedAndLeavesNoRunDirectory) {
  const fs::path dir = fresh_folder("bad_ceiling");
  const std::string mesh = written(dir / "box.stl", box_stl(4));
  expect_refused(fly(dir, "--cave " + mesh + " --start '0 0 -2' --set mission.takeoff_height=8m"),
                 {"box.stl: start", "can rise by 7.3", "(0.00 0.00 4.00)"});
  EXPECT_FALSE(fs::exists(dir / "run"));
}

}  // namespace
}  // namespace karst
