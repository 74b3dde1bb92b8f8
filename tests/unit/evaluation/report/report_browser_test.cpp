// The report's page in a real browser.
#include <gtest/gtest.h>

#include <fstream>

#include "sdk/evaluation/report/report.h"
#include "sdk/evaluation/report/team_report.h"
#include "tests/unit/evaluation/fake_run.h"
#include "tests/unit/evaluation/report/browser.h"

namespace karst::evaluation {
namespace {

namespace fs = std::filesystem;
using test::show_page;
using test::TemporaryDirectory;

void write_small_run(const fs::path& run_dir) {
  test::FakeRunOptions small;
  small.length_m = 36;
  small.map_resolution_m = 0.5;
  test::write_fake_run(run_dir, small);
}

TEST(ReportInBrowser, ShowsTheFlightWithoutAnError) {
  TemporaryDirectory dir;
  write_small_run(dir.path());
  write_report(dir.path());
  const std::string body = show_page(dir.path() / "report.html").body;
  EXPECT_NE(body.find("lateral · winding_tunnel · seed 7"), std::string::npos);
  EXPECT_NE(body.find("largest opening – not in known free space"), std::string::npos);
  EXPECT_NE(body.find("Explored volume"), std::string::npos);
  std::size_t canvases = 0;
  for (std::size_t at = body.find("<canvas"); at != std::string::npos; at = body.find("<canvas", at + 1))
    ++canvases;
  EXPECT_EQ(canvases, 7u);  // the view and six plots
}

TEST(ReportInBrowser, TellsInItsHeadHowTheFlightEndedAndIsGreenOnlyIfThatWasMeant) {
  TemporaryDirectory dir;
  write_small_run(dir.path());
  write_report(dir.path());
  const std::string well = show_page(dir.path() / "report.html").body;
  EXPECT_NE(well.find("<span id=\"outcome\" class=\"badge landed\">✓ landed</span>"), std::string::npos);
  EXPECT_NE(well.find("lateral explored "), std::string::npos);
  EXPECT_NE(well.find("; home after "), std::string::npos);
  std::ofstream(dir.path() / "events.jsonl", std::ios::app)
      << R"({"t": 3, "kind": "safety", "action": "home", "reason": "no sensor sees the cave any more"})"
      << "\n";
  write_report(dir.path());
  const std::string early = show_page(dir.path() / "report.html").body;
  EXPECT_NE(early.find("✕ landed, not as meant</span>"), std::string::npos);
  EXPECT_EQ(early.find("badge landed"), std::string::npos);
}

TEST(ReportInBrowser, OfAnEmptyRunSaysSoWithoutAnError) {
  TemporaryDirectory dir;
  write_report(dir.path());
  const std::string dom = show_page(dir.path() / "report.html").dom;
  EXPECT_NE(dom.find("This run recorded neither a map nor a trajectory."), std::string::npos);
}

TEST(ReportInBrowser, OfATeamShowsTheNewestStateOfEachObject) {
  TemporaryDirectory dir;
  write_small_run(dir.path() / "robot_1");
  dir.write("team.jsonl",
            R"({"t":0,"kind":"start","robot":1}
{"t":5,"kind":"object","robot":1,"number":1,"state":"found","what":"rope","position":[1,0,1]}
{"t":6,"kind":"object","robot":1,"number":2,"state":"found","what":"rope","position":[3,0,1]}
{"t":7,"kind":"object_known","robot":1,"number":1,"state":"found","what":"rope","position":[1,0,1]}
{"t":8,"kind":"object","robot":1,"number":1,"state":"revised","what":"rope","position":[1.2,0,1]}
{"t":9,"kind":"object","robot":1,"number":2,"state":"withdrawn"}
{"t":10,"kind":"objects","known":[{"what":"rope","position":[1,0,1],"told_by":[[1,1]]}]}
)");
  write_team_report(dir.path());
  const auto at = [&](const char* moment) {
    return show_page(dir.path() / "report.html", std::string("t=") + moment).body;
  };
  const std::string before = at("6.5");
  EXPECT_NE(before.find("<dt>finds, robot by robot</dt><dd>2</dd><dt>known at the base</dt><dd>0</dd>"),
            std::string::npos);
  const std::string after = at("12");
  EXPECT_NE(after.find("<dt>finds, robot by robot</dt><dd>1</dd><dt>known at the base</dt><dd>1</dd>"),
            std::string::npos);
}

TEST(ReportInBrowser, ShowsATeamWithoutAnErrorEvenIfItsLogIsDamaged) {
  TemporaryDirectory dir;
  write_small_run(dir.path() / "robot_1");
  write_small_run(dir.path() / "robot_2");
  dir.write(
      "team.jsonl",
      R"({"t":0,"kind":"team","robots":2,"strategy":"relay_chain","base":[0,0,1],"reach":15})"
      "\n"
      R"({"t":0,"kind":"start","robot":1})"
      "\n"
      R"({"t":20,"kind":"start","robot":2})"
      "\n"
      R"({"t":25,"kind":"base","connected":[0,1],"links":[[0,1,1.1]],"held":[[1,7]],"relays":[[1,[9,0,0]]],"dead":[]})"
      "\n"
      R"({"t":25,"kind":"tree","nodes":[[0,1,0,0,1,1],[1,1,4,0,1,0,0,1]]})"
      "\n"
      R"({"t":30,"kind":"base","connected":"none","links":[[0],[0,1,"bad"]],"held":3})"
      "\n{cut");
  write_team_report(dir.path());
  const std::string dom = show_page(dir.path() / "report.html").dom;
  EXPECT_NE(dom.find("team.jsonl: line 7"), std::string::npos) << "the cut line is named";
  EXPECT_NE(dom.find("fields of what the base knew"), std::string::npos);
  EXPECT_NE(dom.find("Reach from the base over landed relays"), std::string::npos);
}

}  // namespace
}  // namespace karst::evaluation
