// `karst cave from-survey` as a command: what it writes, says and refuses.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "core_stack/common/shell_word.h"
#include "sdk/tools/cave_command.h"
#include "sdk/tools/from_survey_command.h"
#include "tests/unit/simulator/meshes.h"
#include "tests/unit/survey/skip_without_survex.h"

namespace karst::tools {
namespace {

using test::error_of;

/// What the command writes to standard output.
std::string run(std::vector<std::string> words) {
  CLI::App app{"karst", "karst"};
  add_from_survey_command(add_cave_command(app));
  std::reverse(words.begin(), words.end());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  try {
    app.parse(words);
  } catch (...) {
    testing::internal::GetCapturedStdout();
    testing::internal::GetCapturedStderr();
    throw;
  }
  testing::internal::GetCapturedStderr();
  return testing::internal::GetCapturedStdout();
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

class FromSurveyCommand : public testing::Test {
 protected:
  FromSurveyCommand() {
    std::ofstream(survey_)
        << "survey cave -title \"Two halls\"\n"
           "  survey upper\n    centreline\n"
           "      fix 0 0 0 0\n      station 0 \"the entrance\" entrance\n"
           "      data normal from to tape compass clino left right up down\n"
           "      0 1 10 90 0 2 2 2 1\n      1 2 10 90 0 2 2 2 1\n      2 3 10 90 0 2 2 2 1\n"
           "    endcentreline\n  endsurvey\n"
           "  survey lower\n    centreline\n"
           "      data normal from to tape compass clino left right up down\n"
           "      0 1 8 0 -10 0.1 0.1 1 1\n      1 2 8 0 0 2 2 2 1\n"
           "    endcentreline\n  endsurvey\n"
           "  equate 3@upper 0@lower\nendsurvey\n";
  }
  void SetUp() override { SKIP_WITHOUT_SURVEX(); }
  ~FromSurveyCommand() override { std::filesystem::remove_all(folder_); }

  std::string run_with(const std::vector<std::string>& more) const {
    std::vector<std::string> words{"cave", "from-survey", survey_, "--out", out_, "--resolution", "0.3"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }

  const std::string folder_ = test::scratch_folder(), survey_ = folder_ + "/cave.th",
                    out_ = folder_ + "/new/real";
};

TEST_F(FromSurveyCommand, WritesACaveThatCanBeFlownItsStationsAndWhatWasGuessed) {
  const std::string said = run_with({});
  for (const char* line : {"passages           46 m in 5 legs, 6 stations, 1 entrance", "walls              ",
                           "not measured       ", "narrow             ", "within reach       ",
                           "connected          1 part\n", "karst fly --cave "})
    EXPECT_TRUE(has(said, line)) << line << "\n" << said;
  const std::string info = test::read_bytes(out_ + ".info");
  EXPECT_TRUE(
      has(info, "; made by: karst cave from-survey " + core::shell_word(survey_) + " --resolution 0.3"))
      << info;
  EXPECT_TRUE(has(info, " --max-triangles 20000000")) << info;
  EXPECT_TRUE(has(info, "within reach")) << "the report is in the file, too";
  const std::string table = test::read_bytes(out_ + ".stations.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 7) << table;
  EXPECT_TRUE(has(table, "name,x,y,z,flags\n")) << table;
  EXPECT_TRUE(has(table, ",0.000,0.000,0.000,entrance")) << table;
  const auto j = nlohmann::json::parse(run({"cave", "info", "--json", out_ + ".info"}));
  EXPECT_TRUE(j["closed"]);
  EXPECT_EQ(j["open_loops"], 0);
  EXPECT_GT(j["fly_through_volume_m3"], 30);
}

TEST_F(FromSurveyCommand, WritesTheReportAsJson) {
  const auto j = nlohmann::json::parse(run_with({"--json", "--vehicle-width", "0.6"}));
  EXPECT_EQ(j["schema"], "karst.from_survey/1");
  EXPECT_NEAR(j["passage_m"].get<double>(), 46, 0.03) << "positions come to the centimetre";
  EXPECT_NEAR(j["depth_m"].get<double>(), 8 * std::sin(10 * std::numbers::pi / 180), 0.01);
  EXPECT_GT(j["narrow_m"].get<double>(), 0);
  EXPECT_NEAR(j["within_reach_m"].get<double>(), 30, 8.1);
  EXPECT_EQ(j["parts"].size(), 1u);
  EXPECT_EQ(j["mesh_bytes"], std::filesystem::file_size(out_ + ".ply"));
}

TEST_F(FromSurveyCommand, LoosePartsAndContradictionsAreInTheReport) {
  const std::string loose = folder_ + "/loose.th";
  std::ofstream(loose)
      << "survey e\n  centreline\n    fix 1 0 0 0\n    data normal from to tape compass clino\n"
         "    1 2 10 0 0\n    2 3 10 90 0\n    3 4 10 0 0\n    8 9 10 0 0\n    equate 1 3\n"
         "  endcentreline\nendsurvey\n";
  const std::string said = run({"cave", "from-survey", loose, "--out", out_, "--resolution", "0.4"});
  EXPECT_TRUE(has(said, "left out           1 part, 10 m in 1 leg, that no leg or equate ties to the rest"))
      << said;
  EXPECT_TRUE(has(said, "loose.th: line 8: 1 leg from here on is tied to no fixed station: left out"))
      << said;
  EXPECT_TRUE(has(said, "check              1 traverse of loops")) << said;
  EXPECT_FALSE(has(said, " 0.00 m,   0.00 %")) << "3 to 4 is on no loop: " << said;
  const auto j = nlohmann::json::parse(
      run({"cave", "from-survey", loose, "--out", out_, "--resolution", "0.4", "--force", "--json"}));
  EXPECT_EQ(j["loose_parts"], 1);
  EXPECT_EQ(j["loose_legs"], 1);
}

TEST_F(FromSurveyCommand, APartIsChosenByNameAndNearAStation) {
  auto j = nlohmann::json::parse(run_with({"--json", "--survey", "upper"}));
  EXPECT_NEAR(j["passage_m"].get<double>(), 30, 0.03);
  EXPECT_NEAR(j["other_parts_of_survey_m"].get<double>(), 16, 0.03);
  j = nlohmann::json::parse(run_with({"--json", "--force", "--around", "upper.1", "--radius", "11"}));
  EXPECT_NEAR(j["passage_m"].get<double>(), 20, 0.03);
}

TEST_F(FromSurveyCommand, OverwritesOnlyIfForcedAndWithTheSameBytes) {
  run_with({});
  const std::string mesh = test::read_bytes(out_ + ".ply"), info = test::read_bytes(out_ + ".info");
  EXPECT_TRUE(has(error_of([&] { run_with({}); }), "real.ply: is there already"));
  run_with({"--force"});
  EXPECT_EQ(test::read_bytes(out_ + ".ply"), mesh);
  EXPECT_EQ(test::read_bytes(out_ + ".info"), info);
  run_with({"--force", "--seed", "2"});
  EXPECT_NE(test::read_bytes(out_ + ".ply"), mesh);
}

TEST_F(FromSurveyCommand, LongCommentsAreCutBetweenCharacters) {
  std::string umlauts;
  for (int i = 0; i < 80; ++i) umlauts += "\u00f6";
  const std::string commented = folder_ + "/commented.th";
  std::ofstream(commented) << "encoding utf-8\nsurvey cave\n  centreline\n"
                              "    data normal from to tape compass clino left right up down\n"
                              "    0 1 10 90 0 2 2 2 1\n    station 1 \"sump "
                           << umlauts << "\"\n  endcentreline\nendsurvey\n";
  const std::string said = run({"cave", "from-survey", commented, "--out", out_, "--resolution", "0.4"});
  EXPECT_TRUE(has(said, "cave.1: sump " + umlauts.substr(0, 2 * 55) + "\n")) << said;
}

TEST_F(FromSurveyCommand, TheCommandInTheFileIsQuotedForTheShell) {
  const std::string odd = folder_ + "/it's a \"cave\" $HOME.th";
  std::filesystem::copy_file(survey_, odd);
  run({"cave", "from-survey", odd, "--out", out_, "--resolution", "0.4", "--max-triangles", "3000000",
       "--around", "upper.1", "--radius", "50", "--box=-50 -50 -50 50 50 50"});
  const std::string info = test::read_bytes(out_ + ".info");
  EXPECT_TRUE(has(info, "karst cave from-survey " + core::shell_word(odd) + " --resolution 0.4")) << info;
  EXPECT_TRUE(
      has(info, " --max-triangles 3000000 --around upper.1 --radius 50 '--box=-50 -50 -50 50 50 50'\n"))
      << info;
}

TEST_F(FromSurveyCommand, BadArgumentsAreNamedAndNothingIsWritten) {
  EXPECT_TRUE(has(error_of([&] { run_with({"--survey", "uper"}); }), "the nearest name is upper"));
  EXPECT_TRUE(has(error_of([&] { run_with({"--around", "upper.9"}); }), "no such station"));
  EXPECT_TRUE(has(error_of([&] { run_with({"--box", "0 0 0 1"}); }), "--box"));
  EXPECT_TRUE(has(error_of([&] {
                    run_with({"--start", "0 0"});
                  }),
                  "command line, --start: start: expected \"x y z [heading_deg]\""));
  EXPECT_TRUE(has(error_of([&] { run_with({"--start", "0 0 500"}); }), "--start: lies in no passage"));
  EXPECT_TRUE(has(error_of([&] { run_with({"--max-triangles", "1000"}); }), "--max-triangles 1000"));
  EXPECT_THROW(run_with({"--radius", "5"}), CLI::RequiresError);
  EXPECT_THROW(run_with({"--resolution", "0"}), CLI::ValidationError);
  EXPECT_THROW(run_with({"--roughness", "-1"}), CLI::ValidationError);
  EXPECT_TRUE(has(error_of([&] {
                    run({"cave", "from-survey", folder_ + "/none.th", "--out", out_});
                  }),
                  "none.th"));
  for (const char* ending : {".ply", ".info", ".stations.csv"})
    EXPECT_FALSE(std::filesystem::exists(out_ + ending)) << ending;
}

}  // namespace
}  // namespace karst::tools
