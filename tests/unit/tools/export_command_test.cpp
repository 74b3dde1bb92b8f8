// `karst export` as a command: what it writes, says and refuses.
#include "sdk/tools/export_command.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core_stack/mapping/octomap/octomap_io.h"
#include "sdk/survey/cavern.h"
#include "tests/unit/simulator/meshes.h"
#include "tests/unit/survey_export/carved_map.h"

namespace karst::tools {
namespace {

using test::error_of;

/// What the command writes to standard output.
std::string run(std::vector<std::string> words) {
  CLI::App app{"karst", "karst"};
  add_export_command(app);
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

class ExportCommand : public testing::Test {
 protected:
  ExportCommand() {
    core::write_octomap(test::tunnel_map(), folder_ + "/map");
    std::ofstream out(folder_ + "/trajectory.tum");
    double t_s = 0;
    for (const core::Vec3& p : test::tunnel_flight())
      out << (t_s += 0.1) << ' ' << p.x() << ' ' << p.y() << ' ' << p.z() << " 0 0 0 1\n";
  }
  ~ExportCommand() override { std::filesystem::remove_all(folder_); }

  std::string run_with(const std::vector<std::string>& more) const {
    std::vector<std::string> words{"export", folder_, "--survey", out_};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }
  std::string text_of(const std::string& ending) const {
    std::ifstream in(out_ + ending);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  const std::string folder_ = test::scratch_folder(), out_ = folder_ + "/new/tunnel";
};

TEST_F(ExportCommand, WritesTheSurveyAndSaysWhatIsInIt) {
  const std::string said = run_with({});
  EXPECT_TRUE(has(said, "tunnel: ")) << said;
  EXPECT_TRUE(has(said, " stations, ")) << said;
  EXPECT_TRUE(has(said, "the run holds no record of its drift")) << said;
  EXPECT_TRUE(has(said, "cavern " + out_ + ".svx")) << said;
  EXPECT_TRUE(has(text_of(".svx"), "*begin tunnel\n"));
  EXPECT_TRUE(has(text_of(".thconfig"), "source \"tunnel.th\"\n"));
}

TEST_F(ExportCommand, JsonHasTheFigures) {
  const auto j = nlohmann::json::parse(run_with({"--json"}));
  EXPECT_EQ(j["schema"], "karst.export/1");
  EXPECT_EQ(j["files"].size(), 7u);
  EXPECT_NEAR(j["length_m"].get<double>(), 28.5, 1.5);
  EXPECT_EQ(j["approximate_legs"], 0);
}

TEST_F(ExportCommand, FixesAndTurnsTheSurvey) {
  run_with({"--fix", "451234 5078123 812", "--cs", "UTM33N", "--declination", "3.5"});
  EXPECT_TRUE(has(text_of(".svx"), "*cs UTM33N\n*cs out UTM33N\n*declination 3.5000 degrees\n"));
  EXPECT_TRUE(has(text_of(".th"), "    grid-angle 3.5000 degrees\n"));
}

TEST_F(ExportCommand, CommandsToCopyAreQuoted) {
  const std::string said = run({"export", folder_, "--survey", folder_ + "/a b c"});
  EXPECT_TRUE(has(said, "  cavern '" + folder_ + "/a b c.svx'\n")) << said;
  EXPECT_TRUE(has(said, "  therion '" + folder_ + "/a b c.thconfig'\n")) << said;
}

TEST_F(ExportCommand, WithoutAFixNoStationIsFixedAndTheSummarySaysSo) {
  EXPECT_TRUE(has(run_with({"--no-fix"}), "no station is fixed"));
  EXPECT_FALSE(has(text_of(".svx"), "*fix"));
}

TEST_F(ExportCommand, ASurveyOfTheMissionThatWasMovedCanBeReplacedOrLeftOut) {
  std::ofstream(folder_ + "/mission.info")
      << "survey { file \"/nonexistent/old.svx\" offset \"1000 0 0\" }\n";
  EXPECT_TRUE(has(error_of([&] { run_with({}); }), "mission.info: survey.file: /nonexistent/old.svx"));
  EXPECT_FALSE(has(run_with({"--prior", "none"}), "coordinates: "));
  if (!survey::has_survex()) GTEST_SKIP() << "skipped: no survex/therion";
  std::ofstream(folder_ + "/moved.svx") << "*fix 1 1000 0 1.5\n*data normal from to tape compass clino\n"
                                           "1 2 30 90 0\n";
  const std::string said = run_with({"--force", "--prior", folder_ + "/moved.svx"});
  EXPECT_TRUE(has(said, "coordinates: those of the survey")) << said;
  EXPECT_TRUE(has(said, "new: 0 legs")) << said;
  EXPECT_TRUE(has(text_of(".svx"), "*fix 1 100")) << text_of(".svx");
  EXPECT_NO_THROW(run_with({"--force", "--prior", folder_ + "/moved.svx", "--cs", "UTM33N"}));
}

TEST_F(ExportCommand, OverwritesOnlyIfForced) {
  run_with({});
  EXPECT_TRUE(has(error_of([&] { run_with({}); }), "tunnel.svx: is there already"));
  EXPECT_NO_THROW(run_with({"--force"}));
}

TEST_F(ExportCommand, RefusesWhatItCannotUse) {
  EXPECT_TRUE(has(error_of([&] { run_with({"--fix", "1 2"}); }), "--fix"));
  EXPECT_TRUE(has(error_of([&] { run_with({"--fix", "1 2 3", "--cs", "lat-long"}); }), "--cs"));
  EXPECT_TRUE(has(error_of([&] {
                    run_with({"--fix", "1 2 3", "--cs", "EPSG:4326"});
                  }),
                  "--cs: expected a system in metres such as EPSG:32633 or UTM33N; EPSG:4326 is latitude"));
  EXPECT_TRUE(has(error_of([&] { run_with({"--cs", "UTM33N"}); }), "--cs: needs --fix"));
  EXPECT_THROW(run_with({"--fix", "1 2 3", "--no-fix"}), CLI::ParseError);
  EXPECT_THROW(run_with({"--declination", "north"}), CLI::ParseError);
  EXPECT_TRUE(has(error_of([&] { run({"export", folder_}); }), "--survey OUT or --mcap FILE"));
  EXPECT_THROW(run({"export", folder_, "--mcap", out_, "--declination", "3"}), CLI::ParseError);
  EXPECT_THROW(run({"export", folder_, "--survey", out_, "--epoch", "3"}), CLI::ParseError);
  EXPECT_THROW(run({"export", folder_, "--mcap", out_, "--epoch", "-1"}), CLI::ParseError);
  EXPECT_TRUE(has(error_of([&] {
                    run({"export", folder_ + "/none", "--survey", out_});
                  }),
                  "no such run directory"));
  EXPECT_TRUE(has(error_of([&] {
                    run({"export", folder_, "--survey", folder_ + "/map.bt/x"});
                  }),
                  "cannot be made"));
}

TEST_F(ExportCommand, WritesTheFlightAsOneFileAndSaysItsTopics) {
  const std::string file = folder_ + "/flight.mcap";
  const std::string said = run({"export", folder_, "--mcap", file});
  EXPECT_TRUE(has(said, "/odometry")) << said;
  EXPECT_TRUE(has(said, "nav_msgs/msg/Path")) << said;
  EXPECT_TRUE(has(error_of([&] { run({"export", folder_, "--mcap", file}); }), "is there already"));
  EXPECT_TRUE(has(error_of([&] { run({"export", folder_, "--mcap", folder_}); }), "got a folder"));
  const auto j = nlohmann::json::parse(
      run({"export", folder_, "--mcap", file, "--force", "--json", "--epoch", "1700000000"}));
  EXPECT_EQ(j.at("schema"), "karst.export_mcap/1");
  EXPECT_EQ(j.at("epoch_s"), 1.7e9);
  EXPECT_EQ(j.at("bytes"), std::filesystem::file_size(file));
}

TEST_F(ExportCommand, ANameThatTherionDoesNotReadIsRefusedBeforeAnythingIsMade) {
  for (const char* name : {"my \"cave", "two\nlines", "latin \xe9", ""})
    EXPECT_TRUE(has(error_of([&] {
                      run({"export", folder_, "--survey", folder_ + "/made/" + name});
                    }),
                    "--survey: expected"))
        << name;
  EXPECT_FALSE(std::filesystem::exists(folder_ + "/made"));
}

}  // namespace
}  // namespace karst::tools
