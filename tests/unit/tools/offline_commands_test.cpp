// `karst evaluate` as a command: what it writes and what it refuses.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core_stack/common/error.h"
#include "sdk/evaluation/metrics/metrics.h"
#include "sdk/evaluation/report/report.h"
#include "sdk/tools/evaluate_command.h"
#include "tests/unit/evaluation/fake_run.h"

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

}  // namespace
}  // namespace karst::tools
