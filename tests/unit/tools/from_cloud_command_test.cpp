// `karst cave from-cloud` as a command: what it writes, says and refuses.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "sdk/tools/cave_command.h"
#include "sdk/tools/from_cloud_command.h"
#include "tests/unit/cave_from_cloud/scans.h"
#include "tests/unit/tools/captured_output.h"

namespace karst::tools {
namespace {

using test::error_of;

/// What the command writes to standard output.
std::string run(std::vector<std::string> words) {
  CLI::App app{"karst", "karst"};
  add_from_cloud_command(add_cave_command(app));
  return test::captured_output(app, std::move(words)).out;
}

class FromCloudCommand : public testing::Test {
 protected:
  FromCloudCommand() {
    test::write_scan(cloud_, test::scan_of_hall_and_passage({.spacing_m = 0.1, .entrance = true}));
  }
  ~FromCloudCommand() override { std::filesystem::remove_all(folder_); }

  std::string run_with(const std::vector<std::string>& more, const std::string& name = "real") const {
    std::vector<std::string> words{"cave", "from-cloud", cloud_, "--out", out(name), "--resolution", "0.25"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }
  std::string out(const std::string& name = "real") const { return folder_ + "/new/" + name; }
  std::string text_of(const std::string& file) const { return test::read_bytes(file); }

  const std::string folder_ = test::scratch_folder(), cloud_ = folder_ + "/scan.ply";
};

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST_F(FromCloudCommand, WritesACaveThatCanBeFlownAndSaysWhatWasGuessed) {
  const std::string said = run_with({});
  for (const char* line : {"points             ", "one a cell of 0.25 m", "closed; encloses 15",
                           "guessed            ", "m across, around 12.", "written: ", "karst fly --cave "})
    EXPECT_TRUE(has(said, line)) << line << "\n" << said;
  const std::string info = text_of(out() + ".info");
  EXPECT_TRUE(has(info, "; made by: karst cave from-cloud \"" + cloud_ + "\" --resolution 0.25\n")) << info;
  EXPECT_TRUE(has(info, "m across, around 12.")) << "the report is in the file, too: " << info;
  const auto j = nlohmann::json::parse(run({"cave", "info", "--json", out() + ".info"}));
  EXPECT_TRUE(j["closed"]);
  EXPECT_EQ(j["open_loops"], 0);
  EXPECT_GT(j["fly_through_volume_m3"], 30);
  EXPECT_TRUE(j["advice"].empty());
}

TEST_F(FromCloudCommand, SaysOnStandardErrorWhatItDoes) {
  CLI::App app{"karst", "karst"};
  add_from_cloud_command(add_cave_command(app));
  std::vector<std::string> words{"0.25", "--resolution", out(), "--out", cloud_, "from-cloud", "cave"};
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  app.parse(words);
  const std::string steps = testing::internal::GetCapturedStderr();
  testing::internal::GetCapturedStdout();
  for (const char* step : {"reading scan.ply\nthinning out ", " points\nfinding the normals of ",
                           "reconstructing the surface\n", "closing holes\n", "looking for a start\n"})
    EXPECT_TRUE(has(steps, step)) << step << "\n" << steps;
}

TEST_F(FromCloudCommand, TheOptionsOfACloudSpeakOfACloud) {
  CLI::App app{"karst", "karst"};
  CLI::App& cave = add_cave_command(app);
  add_from_cloud_command(cave);
  for (const char* name : {"--unit", "--scale", "--up", "--offset"}) {
    const std::string help = cave.get_subcommand("from-cloud")->get_option(name)->get_description();
    EXPECT_TRUE(has(help, "cloud") && !has(help, "mesh")) << help;
    EXPECT_TRUE(has(cave.get_subcommand("info")->get_option(name)->get_description(), "mesh")) << name;
  }
}

TEST_F(FromCloudCommand, WritesTheReportAsJson) {
  const auto j = nlohmann::json::parse(run_with({"--json", "--guessed-beyond", "0.4"}));
  EXPECT_EQ(j["schema"], "karst.from_cloud/1");
  EXPECT_EQ(j["resolution_m"], 0.25);
  EXPECT_EQ(j["guessed_beyond_m"], 0.4);
  EXPECT_EQ(j["normals"], "points");
  EXPECT_EQ(j["mesh_bytes"], std::filesystem::file_size(out() + ".ply"));
  ASSERT_GE(j["guessed"].size(), 1u);
  EXPECT_NEAR(j["guessed"][0]["centre_m"][0].get<double>(), test::kLength_m, 1);
  EXPECT_NEAR(j["guessed_m2"].get<double>(), j["guessed"][0]["area_m2"].get<double>(), 0.5);
  EXPECT_NEAR(j["volume_m3"].get<double>(), test::hall_and_passage_m3(false), 6);
  EXPECT_TRUE(j["start"].is_string());
}

TEST_F(FromCloudCommand, OverwritesOnlyIfForcedAndWithTheSameBytes) {
  run_with({});
  const std::string mesh = text_of(out() + ".ply"), info = text_of(out() + ".info");
  EXPECT_TRUE(has(error_of([&] { run_with({}); }), "real.ply: is there already"));
  run_with({"--force"});
  EXPECT_EQ(text_of(out() + ".ply"), mesh);
  EXPECT_EQ(text_of(out() + ".info"), info);
}

TEST_F(FromCloudCommand, TheScannersPathAndPlacesAreUsedAndNoted) {
  const std::string path = folder_ + "/path.tum";
  std::ofstream(path) << "# t x y z qx qy qz qw\n0 0 0 0 0 0 0 1\n1 0.1 0 0 0 0 0 1\n2 5 0 0 0 0 0 1\n";
  const auto j = nlohmann::json::parse(run_with({"--json", "--path", path, "--scanner", "9 0 0"}));
  EXPECT_GT(j["points_seen"].get<double>(), 0.6 * j["thinned_points"].get<double>());
  EXPECT_TRUE(has(text_of(out() + ".info"), "--scanner \"9 0 0\" --path \"" + path + "\""));
}

TEST_F(FromCloudCommand, BadArgumentsAreNamedAndNothingIsWritten) {
  EXPECT_TRUE(has(error_of([&] { run_with({"--scanner", "1 2"}); }), "--scanner"));
  EXPECT_TRUE(has(error_of([&] {
                    run_with({"--path", folder_ + "/none.tum"});
                  }),
                  "none.tum: cannot be opened"));
  std::ofstream(folder_ + "/bad.tum") << "hello\n";
  EXPECT_TRUE(has(error_of([&] { run_with({"--path", folder_ + "/bad.tum"}); }), "bad.tum: holds no pose"));
  EXPECT_TRUE(has(error_of([&] { run_with({"--unit", "miles"}); }), "unit"));
  EXPECT_TRUE(has(error_of([&] {
                    run_with({"--start", "0 0 90"});
                  }),
                  "start: no part of the surface encloses it"));
  EXPECT_THROW(run_with({"--resolution", "0"}), CLI::ValidationError);
  EXPECT_FALSE(std::filesystem::exists(out() + ".ply"));
  EXPECT_FALSE(std::filesystem::exists(out() + ".info"));
}

// A file's name may hold anything; in the cave's file it stands in a comment.
TEST_F(FromCloudCommand, ANameWithALineEndDoesNotBreakTheCavesFile) {
  const std::string odd = folder_ + "/odd\nmesh x.ply";
  std::filesystem::create_directories(odd.substr(0, odd.rfind('/')));
  std::filesystem::copy_file(cloud_, odd);
  run({"cave", "from-cloud", odd, "--out", out(), "--resolution", "0.25"});
  EXPECT_EQ(cave::describe_cave(out() + ".info", "").mesh_path, out() + ".ply");
}

}  // namespace
}  // namespace karst::tools
