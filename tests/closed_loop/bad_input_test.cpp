// Every kind of bad input a user can give the command: a clear error, a non-zero exit, nothing lost.
#include "tests/closed_loop/command.h"

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
  expect_refused(fly(dir, c), {"c.info", "nonsense"});
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
  expect_refused(fly(dir, "--cave " + mesh + " --start '0 0 0'"), {"another run"});
  EXPECT_EQ(bytes_of(dir / "run" / "events.jsonl"), "precious\n");
}

TEST(BadInput, UsageErrorsTeach) {
  EXPECT_NE(run_karst("").code, 0);
  const Output nothing = run_karst("fly");
  EXPECT_NE(nothing.code, 0);
  EXPECT_TRUE(nothing.says("--cave")) << nothing.text;
  EXPECT_TRUE(run_karst("fly --help").says("karst fly examples/missions/demo.info"));
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
