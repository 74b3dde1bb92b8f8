// What an author does: every command that the documentation, and the README of a folder just written, tell to
// type.
#include "tests/closed_loop/transcript.h"

namespace karst {
namespace {

namespace fs = std::filesystem;

TEST(Transcript, TellsOtherOutputFromWhatIsDocumented) {
  const std::vector<std::string> said{"made", "...", "done"};
  EXPECT_TRUE(matches(said, 0, {"made", "done"}, 0));
  EXPECT_TRUE(matches(said, 0, {"made", "one", "two", "done"}, 0));
  EXPECT_FALSE(matches(said, 0, {"made", "one", "two"}, 0));
  EXPECT_FALSE(matches({"39 s"}, 0, {"40 s"}, 0));
  EXPECT_FALSE(matches({"39 s"}, 0, {"39 s", "and more"}, 0));
  EXPECT_FALSE(matches({"39 s"}, 0, {}, 0));
}

class Tutorial : public ::testing::TestWithParam<const char*> {};

TEST_P(Tutorial, PrintsWhatItSays) {
  // Compiled in half the time; NewPolicy types the same commands without it.
  setenv("CMAKE_BUILD_TYPE", "Debug", 1);
  const std::string document = GetParam();
  expect_as_documented(fs::path(KARST_SOURCE_DIR) / "docs" / document,
                       fresh_folder("author_" + fs::path(document).stem().string()));
}
INSTANTIATE_TEST_SUITE_P(Documents, Tutorial,
                         ::testing::Values("first_policy.md", "first_policy_python.md",
                                           "tutorials/1_nearest.md", "tutorials/2_tour.md",
                                           "tutorials/3_memory.md"));

/// Types the README of a new policy, word for word, and returns what was printed. `karst` is not on the path
/// unless `bin` puts it there.
std::string typed_readme(const std::string& karst, const std::string& bin, const std::string& options,
                         std::size_t blocks_expected, const fs::path& folder) {
  Shell shell(folder, bin);
  EXPECT_EQ(shell.run(karst + " policy new deep_first --dir work" + options).code, 0);
  EXPECT_EQ(shell.run("cd work/deep_first").code, 0);
  const auto blocks = blocks_of(bytes_of(folder / "work/deep_first/README.md"), "");
  EXPECT_EQ(blocks.size(), blocks_expected);
  std::string all;
  for (const auto& block : blocks)
    for (const std::string& command : block) {
      const Output out = shell.run(command);
      all += out.text;
      EXPECT_EQ(out.code, 0) << command << "\n" << out.text;
      if (out.code != 0) return all;
    }
  const fs::path runs = folder / "work/deep_first/runs";
  for (const char* run : {"first", "second"})
    EXPECT_NE(bytes_of(runs / run / "metrics.json").find("\"outcome\": \"landed\""), std::string::npos);
  EXPECT_TRUE(bytes_of(runs / "first/trajectory.tum") == bytes_of(runs / "second/trajectory.tum"))
      << "one policy, one mission, wherever the file lies";
  return all;
}

TEST(NewPolicy, ReadmeHoldsInPython) {
  const std::string all = typed_readme(KARST_BINARY_DIR "/bin/karst", "/usr/bin", " --template python", 4,
                                       fresh_folder("author_python"));
  for (const char* said : {"passed: test_the_nearer", "deep_first 0.1.0", " 0 failed", "landed: deep_first"})
    EXPECT_NE(all.find(said), std::string::npos) << said << "\n" << all;
}

TEST(NewPolicy, ReadmeHoldsForAnInstalledKarst) {
  const fs::path folder = fresh_folder("author_installed");
  const Output out =
      run_command("cmake --install " KARST_BINARY_DIR " --prefix " + (folder / "prefix").string());
  ASSERT_EQ(out.code, 0) << out.text;
  const std::string all = typed_readme("karst", (folder / "prefix/bin").string(), "", 3, folder);
  for (const char* said :
       {"100% tests passed", "deep_first 0.1.0", "/.local/share/karst/policies/deep_first.so"})
    EXPECT_NE(all.find(said), std::string::npos) << said << "\n" << all;
}

/// Where karst is not on the path, each command names it in full, and is otherwise that of an installed
/// karst, which the test above types. first_policy.md builds for a build tree.
TEST(NewPolicy, ReadmeForABuildTreeNamesItsKarst) {
  const fs::path folder = fresh_folder("author_build_tree");
  const std::string karst = KARST_BINARY_DIR "/bin/karst";
  const auto readme = [&](const std::string& command, const std::string& bin, const std::string& name) {
    Shell shell(folder, bin);
    EXPECT_EQ(shell.run(command + " policy new deep_first --dir " + name).code, 0);
    return bytes_of(folder / name / "deep_first/README.md");
  };
  std::string off_path = readme(karst, "/usr/bin", "off_path");
  const std::string on_path = readme("karst", KARST_BINARY_DIR "/bin", "on_path");
  std::size_t named = 0;
  for (std::size_t at; (at = off_path.find(karst)) != std::string::npos; ++named)
    off_path.replace(at, karst.size(), "karst");
  EXPECT_GT(named, 5u);
  EXPECT_EQ(on_path.find(karst), std::string::npos);
  EXPECT_EQ(off_path, on_path);
}

/// What a document has typed into the debugger.
std::vector<std::string> debugger_commands(const std::string& document) {
  const std::string prompt = "(gdb) ";
  std::vector<std::string> out;
  for (const std::string& line : lines_of(document))
    if (line.starts_with(prompt)) out.push_back(line.substr(prompt.size()));
  return out;
}

TEST(NewPolicy, StopsInADebuggerAsDocumented) {
  if (run_command("command -v gdb").code != 0) GTEST_SKIP() << "gdb is not installed";
  const std::string so = "build/lib/karst/policies/my_nearest.so";
  const std::vector<std::string> before{
      "karst policy new my_nearest", "cd my_nearest", "cmake -S . -B build && cmake --build build",
      "karst fly --cave " + generated_cave("small", 7) + " --policy my_nearest --plugin " + so +
          " --set mission.max_flight_time=20s --quiet --no-report --record-requests --out runs/first" +
          " || test $? = 2"};
  Shell shell(fresh_folder("author_debugger"));
  for (const std::string& command : before) {
    const Output out = shell.run(command);
    ASSERT_EQ(out.code, 0) << command << "\n" << out.text;
  }
  std::string gdb = "gdb --batch -nx";
  const auto typed = debugger_commands(bytes_of(fs::path(KARST_SOURCE_DIR) / "docs/testing_policies.md"));
  ASSERT_EQ(typed.size(), 3u);
  for (const std::string& command : typed) gdb += " -ex '" + command + "'";
  const Output stopped =
      shell.run(gdb + " -ex 'backtrace 1' --args karst policy replay runs/first --plugin " + so + " --to 40");
  if (stopped.says("Could not trace the inferior process"))
    GTEST_SKIP() << "this machine does not let a debugger trace a program";
  EXPECT_TRUE(stopped.says("Breakpoint 1, ") || stopped.says("Breakpoint 1.1, ")) << stopped.text;
  EXPECT_TRUE(stopped.says("MyNearest::decide") && stopped.says("my_nearest.cpp:")) << stopped.text;
}

}  // namespace
}  // namespace karst
