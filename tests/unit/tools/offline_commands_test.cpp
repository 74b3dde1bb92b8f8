// `karst evaluate` and `karst cave describe` as commands: what they write and what they refuse.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "core_stack/common/error.h"
#include "plugins/simulator/cave/triangle_mesh.h"
#include "sdk/evaluation/metrics/metrics.h"
#include "sdk/evaluation/report/report.h"
#include "sdk/tools/cave_describe_command.h"
#include "sdk/tools/evaluate_command.h"
#include "tests/unit/evaluation/fake_run.h"
#include "tests/unit/evaluation/reachable/boxes.h"
#include "tests/unit/tools/captured_output.h"

namespace karst::tools {
namespace {

using nlohmann::json;
using test::TemporaryDirectory;

/// The exit code; errors of input are thrown.
int run(std::vector<std::string> words) {
  CLI::App app;
  add_evaluate_command(app);
  std::reverse(words.begin(), words.end());
  try {
    app.parse(words);
  } catch (const CLI::RuntimeError& e) {
    return e.get_exit_code();
  }
  return 0;
}

json read_json(const std::filesystem::path& file) {
  std::ifstream in(file);
  return json::parse(in, nullptr, false);
}

TEST(EvaluateCommand, FindsTheDriftThatWasPlantedAndAgreesWithTheMetrics) {
  TemporaryDirectory dir;
  test::FakeRunOptions options;
  options.drift_per_m = 0.005;
  test::write_fake_run(dir.path(), options);
  evaluation::write_report(dir.path());
  EXPECT_EQ(run({"evaluate", dir.path().string(), "--no-align"}), 0);
  const json e = read_json(dir.path() / "evaluation.json");
  ASSERT_TRUE(e.is_object());
  const json t = e["trajectory"], metrics = json::parse(evaluation::evaluate_run(dir.path(), {}).dump());
  EXPECT_NEAR(t["drift"]["end_percent"].get<double>(), 0.5, 0.05);
  EXPECT_NEAR(t["drift"]["end_percent"].get<double>(), metrics["drift_percent"].get<double>(), 0.02);
  EXPECT_TRUE(e["map"].is_null()) << "its cave is made up and no file";
  std::ifstream report(dir.path() / "report.html");
  const std::string page((std::istreambuf_iterator<char>(report)), {});
  EXPECT_NE(page.find("\"errors\":{\"map\":null"), std::string::npos);
}

TEST(EvaluateCommand, OfABareTrajectoryWritesBesideIt) {
  TemporaryDirectory dir;
  test::write_fake_run(dir.path());
  const std::string tum = (dir.path() / "trajectory.tum").string(),
                    truth = (dir.path() / "ground_truth.tum").string();
  EXPECT_EQ(run({"evaluate", tum, "--truth", truth}), 0);
  EXPECT_EQ(read_json(tum + ".evaluation.json")["trajectory"]["alignment"]["kind"], "umeyama");
  EXPECT_THROW(run({"evaluate", tum}), core::InputError) << "nothing to compare it with";
  EXPECT_THROW(run({"evaluate", "/nowhere"}), core::InputError);
  EXPECT_THROW(run({"evaluate", tum, "--truth", "/nowhere.tum"}), core::InputError);
}

/// What `cave describe` prints of a mesh.
json described(std::vector<std::string> words) {
  CLI::App app;
  add_cave_describe(app);
  words.insert(words.begin(), "describe");
  words.emplace_back("--json");
  return json::parse(test::captured_output(app, std::move(words)).out);
}

TEST(CaveDescribe, ABareMeshIsReadInTheUnitThatIsGiven) {
  TemporaryDirectory dir;
  std::set<std::array<int, 3>> cells;
  test::fill(cells, {0, 0, 0}, {12, 4, 3});
  cave::TriangleMesh mesh = test::lattice_mesh(cells, 1.0, {0.03, 0.04, 0.05});
  const std::string metres = (dir.path() / "m.ply").string(), millimetres = (dir.path() / "mm.ply").string();
  cave::write_mesh(metres, mesh);
  for (core::Vec3f& v : mesh.vertices) v *= 1000.0f;
  cave::write_mesh(millimetres, mesh);
  const json m = described({metres, "--start", "3 2 1.5"}),
             mm = described({millimetres, "--start", "3 2 1.5", "--unit", "mm"});
  EXPECT_NEAR(mm["volume"].get<double>(), m["volume"].get<double>(), 0.5);
  EXPECT_NEAR(mm["width"].get<double>(), m["width"].get<double>(), 0.01);
  EXPECT_THROW(described({metres, "--unit", "km", "--start", "3 2 1.5"}), core::InputError);
  const std::string numbers = (dir.path() / "numbers.info").string();
  std::ofstream(numbers) << "width \"3 m\"\n";
  EXPECT_THROW(described({numbers, "--unit", "mm"}), core::InputError) << "it has no mesh";
}

}  // namespace
}  // namespace karst::tools
