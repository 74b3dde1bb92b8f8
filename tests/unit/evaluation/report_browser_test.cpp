// The report's page in a real browser.
#include <gtest/gtest.h>

#include "sdk/evaluation/report.h"
#include "tests/unit/evaluation/browser.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::evaluation {
namespace {

namespace fs = std::filesystem;
using test::TemporaryDirectory;

TEST(ReportInBrowser, ShowsTheFlightWithoutAnError) {
  TemporaryDirectory dir;
  test::FakeRunOptions small;
  small.length_m = 36;
  small.map_resolution_m = 0.5;
  test::write_fake_run(dir.path(), small);
  write_report(dir.path());
  const std::string dom = test::dom_in_browser(dir.path() / "report.html");
  if (dom.empty()) GTEST_SKIP() << "skipped: no chromium";
  const std::string root = dom.substr(0, dom.find("<head>"));
  EXPECT_NE(root.find("data-ready=\"yes\""), std::string::npos) << root;
  EXPECT_EQ(root.find("data-errors"), std::string::npos) << root;
  const std::string body = dom.substr(dom.find("<body>"), dom.find("id=\"data\"") - dom.find("<body>"));
  EXPECT_NE(body.find("lateral · winding_tunnel · seed 7"), std::string::npos);
  EXPECT_NE(body.find("largest opening – not in known free space"), std::string::npos);
  EXPECT_NE(body.find("Explored volume"), std::string::npos);
  std::size_t canvases = 0;
  for (std::size_t at = body.find("<canvas"); at != std::string::npos; at = body.find("<canvas", at + 1))
    ++canvases;
  EXPECT_EQ(canvases, 7u);  // the view and six plots
}

TEST(ReportInBrowser, OfAnEmptyRunSaysSoWithoutAnError) {
  TemporaryDirectory dir;
  write_report(dir.path());
  const std::string dom = test::dom_in_browser(dir.path() / "report.html");
  if (dom.empty()) GTEST_SKIP() << "skipped: no chromium";
  const std::string root = dom.substr(0, dom.find("<head>"));
  EXPECT_NE(root.find("data-ready=\"yes\""), std::string::npos) << root;
  EXPECT_EQ(root.find("data-errors"), std::string::npos) << root;
  EXPECT_NE(dom.find("This run recorded neither a map nor a trajectory."), std::string::npos);
}

}  // namespace
}  // namespace karst::evaluation
