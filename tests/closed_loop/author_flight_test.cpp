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
  const std::string document = GetParam();
  expect_as_documented(fs::path(KARST_SOURCE_DIR) / "docs" / document,
                       fresh_folder("author_" + fs::path(document).stem().string()));
}
INSTANTIATE_TEST_SUITE_P(Documents, Tutorial,
                         ::testing::Values("first_policy.md", "tutorials/1_nearest.md", "tutorials/2_tour.md",
                                           "tutorials/3_memory.md"));

/// Types the README of a new policy, word for word; `karst` is not on the path unless `bin` puts it there.
void type_the_readme(const std::string& karst, const std::string& bin, const fs::path& folder) {
  Shell shell(folder, bin);
  ASSERT_EQ(shell.run(karst + " policy new deep_first --dir work").code, 0);
  ASSERT_EQ(shell.run("cd work/deep_first").code, 0);
  const auto blocks = blocks_of(bytes_of(folder / "work/deep_first/README.md"), "");
  ASSERT_EQ(blocks.size(), 3u);
  std::string all;
  for (const auto& block : blocks)
    for (const std::string& command : block) {
      const Output out = shell.run(command);
      ASSERT_EQ(out.code, 0) << command << "\n" << out.text;
      all += out.text;
    }
  EXPECT_NE(all.find("100% tests passed"), std::string::npos) << all;
  const auto at = [&](const std::string& what) { return all.find(what); };
  EXPECT_NE(at("deep_first 0.1.0"), std::string::npos);
  EXPECT_NE(at("/.local/share/karst/policies/deep_first.so"), std::string::npos)
      << "installed, and found there";
  for (const char* run : {"first", "second"})
    EXPECT_NE(
        bytes_of(folder / "work/deep_first/runs" / run / "metrics.json").find("\"outcome\": \"landed\""),
        std::string::npos);
  EXPECT_TRUE(bytes_of(folder / "work/deep_first/runs/first/trajectory.tum") ==
              bytes_of(folder / "work/deep_first/runs/second/trajectory.tum"))
      << "one policy, one mission, wherever the file lies";
}

TEST(NewPolicy, ReadmeHoldsForABuildTree) {
  type_the_readme(KARST_BINARY_DIR "/bin/karst", "/usr/bin", fresh_folder("author_build_tree"));
}

TEST(NewPolicy, ReadmeHoldsForAnInstalledKarst) {
  const fs::path folder = fresh_folder("author_installed");
  const Output out =
      run_command("cmake --install " KARST_BINARY_DIR " --prefix " + (folder / "prefix").string());
  ASSERT_EQ(out.code, 0) << out.text;
  type_the_readme("karst", (folder / "prefix/bin").string(), folder);
}

}  // namespace
}  // namespace karst
