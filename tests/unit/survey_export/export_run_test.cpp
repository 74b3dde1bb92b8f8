// A run directory becomes files, and what is refused.
#include "sdk/survey_export/export_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "core_stack/mapping/octomap/octomap_io.h"
#include "tests/unit/replay/folder.h"
#include "tests/unit/survey_export/carved_map.h"

namespace karst::survey_export {
namespace {

using core::Vec3;

template <class F>
std::string error_of(const F& f) {
  try {
    f();
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "";
}
bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string tum(const std::vector<Vec3>& way) {
  std::string text;
  for (std::size_t i = 0; i < way.size(); ++i)
    text += core::format_text("%.2f %.3f %.3f %.3f 0 0 0 1\n", 0.1 * static_cast<double>(i), way[i].x(),
                              way[i].y(), way[i].z());
  return text;
}

class ExportRun : public testing::Test {
 protected:
  ExportRun() {
    core::write_octomap(test::tunnel_map(test::box({22, -10, -10}, {50, 10, 10})),
                        (folder_.path() / "map").string());
    const std::vector<Vec3> flown = test::way({{1, 0, 1.5}, {20, 0, 1.5}});
    folder_.write("trajectory.tum", tum(flown));
    std::string scans = "stamp_s,used_s,accepted,position_sigma_m,believed,problem\n";
    for (std::size_t i = 0; i < flown.size(); ++i)
      scans += core::format_text("%.3f,%.3f,1,0.0100,lidar,\n", 0.1 * static_cast<double>(i),
                                 0.1 * static_cast<double>(i));
    folder_.write("localization.csv", scans);
    folder_.write("events.jsonl",
                  "{\"t\": 1, \"kind\": \"frontiers\", \"clusters\": [[1, 21.9, 0, 1.5, 50]]}\n");
  }
  const test::Folder folder_;
};

TEST_F(ExportRun, WritesAllFilesTheSameEachTime) {
  const RunSurvey run = survey_of_run(folder_.path(), "My Cave");
  EXPECT_EQ(run.flown.name, "my_cave");
  EXPECT_TRUE(run.problems.empty()) << run.problems.front();
  EXPECT_NEAR(run.flown.accuracy.growth_m2_per_m, 1e-4 * 10, 1e-5);
  EXPECT_TRUE(std::any_of(run.flown.survey.stations.begin(), run.flown.survey.stations.end(),
                          [](const survey::Station& s) { return s.continuation; }));
  const std::string out = (folder_.path() / "My Cave").string();
  const WallMesh walls = write_survey(run, {}, out);
  EXPECT_GT(walls.mesh.triangles.size(), 1000u);
  const std::vector<std::filesystem::path> files = survey_files(out);
  EXPECT_EQ(files.size(), 7u);
  std::filesystem::create_directory(folder_.path() / "again");
  const std::string again = (folder_.path() / "again" / "My Cave").string();
  write_survey(survey_of_run(folder_.path(), "My Cave"), {}, again);
  for (std::size_t i = 0; i < files.size(); ++i) {
    EXPECT_GT(std::filesystem::file_size(files[i]), 100u) << files[i];
    EXPECT_TRUE(bytes_of(files[i]) == bytes_of(survey_files(again)[i])) << files[i];
  }
}

TEST_F(ExportRun, WithoutARecordOfTheLocalizationOnlyTheCellsCount) {
  std::filesystem::remove(folder_.path() / "localization.csv");
  EXPECT_EQ(survey_of_run(folder_.path(), "cave").flown.accuracy.scans, 0u);
}

TEST_F(ExportRun, RefusesARunWithoutAMap) {
  std::filesystem::remove(folder_.path() / "map.bt");
  const auto read = [&] { survey_of_run(folder_.path(), "cave"); };
  EXPECT_TRUE(says(error_of(read), "map.bt: is not there: the map is written when a flight ends"))
      << error_of(read);
  folder_.write("team.jsonl", "");
  EXPECT_TRUE(says(error_of(read), "robot_1")) << error_of(read);
  folder_.write("map.bt", "# Octomap OcTree binary file\nnothing");
  EXPECT_TRUE(says(error_of(read), "map.bt")) << error_of(read);
  EXPECT_TRUE(says(error_of([] { survey_of_run("/nonexistent/run", "cave"); }), "no such run directory"));
}

TEST_F(ExportRun, TheTitleHasTheCavesNameAndWithoutOneTheFolders) {
  const auto title = [&] { return survey_of_run(folder_.path(), "x").flown.survey.title; };
  EXPECT_EQ(title(), "Survey from a flight: " + folder_.path().filename().string());
  folder_.write("mission.info", "cave { file \"/caves/old mine.info\" }\n");
  EXPECT_EQ(title(), "Survey from a flight: old mine");
}

TEST_F(ExportRun, RefusesAnEmptyFlight) {
  folder_.write("trajectory.tum", "");
  const auto read = [&] { survey_of_run(folder_.path(), "cave"); };
  EXPECT_TRUE(says(error_of(read), "trajectory.tum: holds no pose: nothing was flown")) << error_of(read);
}

TEST_F(ExportRun, NamesTheFileThatCannotBeWritten) {
  const RunSurvey run = survey_of_run(folder_.path(), "cave");
  const std::string out = folder_.write("file", "x") + "/cave";
  EXPECT_TRUE(says(error_of([&] { write_survey(run, {}, out); }), out + ".svx: cannot be written"));
}

}  // namespace
}  // namespace karst::survey_export
