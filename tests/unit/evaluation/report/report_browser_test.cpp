// The report's page in a real browser.
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "core_stack/mapping/octomap/octomap_io.h"
#include "sdk/cave_drawing/report_drawings.h"
#include "sdk/evaluation/report/report.h"
#include "sdk/evaluation/report/team_report.h"
#include "tests/unit/cave_drawing/box_maps.h"
#include "tests/unit/evaluation/fake_run.h"
#include "tests/unit/evaluation/report/browser.h"

namespace karst::evaluation {
namespace {

namespace fs = std::filesystem;
using test::show_page;
using test::show_texts;
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
  const std::string well = show_texts(dir.path() / "report.html").body;
  EXPECT_NE(well.find("<span id=\"outcome\" class=\"badge landed\">✓ landed</span>"), std::string::npos);
  EXPECT_NE(well.find("lateral explored "), std::string::npos);
  EXPECT_NE(well.find("; home after "), std::string::npos);
  std::ofstream(dir.path() / "events.jsonl", std::ios::app)
      << R"({"t": 3, "kind": "safety", "action": "home", "reason": "no sensor sees the cave any more"})"
      << "\n";
  write_report(dir.path());
  const std::string early = show_texts(dir.path() / "report.html").body;
  EXPECT_NE(early.find("✕ landed, not as planned</span>"), std::string::npos);
  EXPECT_EQ(early.find("badge landed"), std::string::npos);
}

/// Leaves out the events of a kind.
void drop_events(const fs::path& run_dir, const std::string& kind) {
  std::ifstream in(run_dir / "events.jsonl");
  std::string kept;
  for (std::string line; std::getline(in, line);)
    if (line.find("\"kind\":\"" + kind + "\"") == std::string::npos) kept += line + "\n";
  in.close();
  std::ofstream(run_dir / "events.jsonl") << kept;
}

TEST(ReportInBrowser, IsNotGreenForALandingWithoutAGoalEverFlown) {
  TemporaryDirectory dir;
  write_small_run(dir.path());
  drop_events(dir.path(), "goal");
  write_report(dir.path());
  const std::string body = show_texts(dir.path() / "report.html").body;
  EXPECT_NE(body.find("<span id=\"outcome\" class=\"badge nowhere\">landed without exploring</span>"),
            std::string::npos);
}

TEST(ReportInBrowser, RoundsTheFlightTimeAsItsSentenceDoes) {
  TemporaryDirectory dir;
  write_small_run(dir.path());
  const auto card = [&](const char* time_s) {
    dir.write("metrics.json",
              std::string(R"({"policy": "lateral", "explored_volume_m3": 120.25, "flight_time_s": )") +
                  time_s + "}");
    write_report(dir.path());
    const std::string body = show_texts(dir.path() / "report.html").body;
    const std::string end = "<span>flight time</span>", begin = "<div class=\"figure\">";
    const std::size_t to = body.find(end), from = body.rfind(begin, to) + begin.size();
    const std::size_t sentence = body.find(" in ", body.find("id=\"summary\""));
    if (to == std::string::npos || sentence == std::string::npos)
      return std::string("no card or no sentence");
    return body.substr(from, to - from) + body.substr(sentence, 24);
  };
  EXPECT_EQ(card("176.71").find("<b>2:57<small> min</small></b> in 177&nbsp;s"), 0u) << card("176.71");
  EXPECT_EQ(card("36.5").find("<b>36<small> s</small></b> in 36&nbsp;s"), 0u)
      << "halves to even: " << card("36.5");
  EXPECT_EQ(card("5.4").find("<b>5<small> s</small></b> in 5&nbsp;s"), 0u) << card("5.4");
  EXPECT_EQ(card("59.6").find("<b>1:00<small> min</small></b> in 60&nbsp;s"), 0u) << card("59.6");
}

TEST(ReportInBrowser, DoesNotTellTheSpeedOfTouchdownOnceItIsOnTheGround) {
  TemporaryDirectory dir;
  write_small_run(dir.path());
  write_report(dir.path());
  const std::string end = show_texts(dir.path() / "report.html").body;
  EXPECT_NE(end.find("<div class=\"phase\">done, on the ground</div>"), std::string::npos);
  EXPECT_EQ(end.find("<dt>speed</dt>"), std::string::npos);
  EXPECT_EQ(end.find("<dt>clearance</dt>"), std::string::npos);
  EXPECT_NE(end.find("<dt>explored</dt>"), std::string::npos);
  EXPECT_NE(show_texts(dir.path() / "report.html", "t=15").body.find("<dt>speed</dt>"), std::string::npos);
}

/// A flight whose second goal is accepted at 6 s, while the first is flown to until 9 s.
void write_queued_goals(const TemporaryDirectory& dir) {
  write_small_run(dir.path());
  dir.write("events.jsonl",
            R"({"t":0,"kind":"phase","phase":"takeoff"}
{"t":2,"kind":"phase","phase":"explore"}
{"t":3,"kind":"decision","sequence":1,"outcome":"goals","goals":1,"reason":""}
{"t":3,"kind":"goal","position":[6,0,0],"heading":0,"frontier":1,"score":5,"why":"4.4 m away","state":"accepted","reason":""}
{"t":6,"kind":"decision","sequence":2,"outcome":"goals","goals":1,"reason":""}
{"t":6,"kind":"goal","position":[12,0,0],"heading":0,"frontier":2,"score":4,"why":"1.5 m away","state":"accepted","reason":""}
{"t":9,"kind":"goal","position":[6,0,0],"heading":0,"frontier":1,"score":5,"why":"4.4 m away","state":"reached","reason":""}
{"t":12,"kind":"phase","phase":"home"}
{"t":14,"kind":"phase","phase":"done"}
{"t":14,"kind":"outcome","outcome":"landed","reason":"at the start"}
)");
}

TEST(ReportInBrowser, SaysOfAnAcceptedGoalThatTheOneUnderWayComesFirst) {
  TemporaryDirectory dir;
  write_queued_goals(dir);
  write_report(dir.path());
  const std::string queued = "<div>accepted: next, after the goal under way</div>", row = "<dt>after it</dt>";
  const std::string before = show_texts(dir.path() / "report.html", "t=7").body;
  EXPECT_NE(before.find("<div class=\"why\">4.4&nbsp;m away</div>"), std::string::npos);
  EXPECT_NE(before.find(row + "<dd>goal 2, (12.0, 0.0, 0.0) m</dd>"), std::string::npos);
  EXPECT_NE(before.find(queued), std::string::npos);
  const std::string after = show_texts(dir.path() / "report.html", "t=10").body;
  EXPECT_NE(after.find("<div class=\"why\">1.5&nbsp;m away</div>"), std::string::npos);
  EXPECT_EQ(after.find(row), std::string::npos);
  EXPECT_EQ(after.find(queued), std::string::npos);
  EXPECT_NE(after.find("<div>accepted</div>"), std::string::npos);
}

TEST(ReportInBrowser, LabelsTheGoalShortlyAtTheEndOfALine) {
  TemporaryDirectory dir;
  write_queued_goals(dir);
  write_report(dir.path());
  const std::string body = show_page(dir.path() / "report.html", "t=7").body;
  const std::size_t at = body.find(">goal 1, score 5.00</span><i style=\"");
  EXPECT_NE(at, std::string::npos) << body.substr(body.find("id=\"labels\""), 500);
}

/// What turns the north arrow, in the page's markup: "rotate(12)".
std::string north_of(const std::string& body) {
  const std::size_t arrow = body.find("class=\"north\"");
  const std::string mark = "transform=\"";
  const std::size_t at = body.find(mark, arrow);
  if (arrow == std::string::npos || at == std::string::npos) return "no arrow";
  const std::size_t begin = at + mark.size();
  return body.substr(begin, body.find('"', begin) - begin);
}

TEST(ReportInBrowser, HasANorthArrowThatTurnsWithTheCamera) {
  TemporaryDirectory dir;
  write_small_run(dir.path());
  write_report(dir.path());
  const auto seen = [&](const char* view) {
    return north_of(show_page(dir.path() / "report.html", std::string("t=15&view=") + view).body);
  };
  EXPECT_EQ(seen("top"), "rotate(0)") << "north up";
  // From the south across a tunnel that bends to the north on its way east: the camera looks west of north.
  const std::string side = seen("side");
  EXPECT_EQ(side.find("rotate("), 0u) << side;
  EXPECT_GT(std::stoi(side.substr(7)), 3) << side;
  EXPECT_LT(std::stoi(side.substr(7)), 45) << side;
}

TEST(ReportInBrowser, ListsTheGoalsOfADecisionWithScoreReasonAndFate) {
  TemporaryDirectory dir;
  write_small_run(dir.path());
  write_report(dir.path());
  const std::string body = show_texts(dir.path() / "report.html", "t=15").body;  // of the fourth decision
  const std::size_t list = body.find("<ol class=\"goals\">");
  ASSERT_NE(list, std::string::npos);
  const std::string goals = body.substr(list, body.find("</ol>", list) - list);
  EXPECT_NE(goals.find("<li class=\"refused\"><div>largest opening</div>"), std::string::npos) << goals;
  EXPECT_NE(goals.find("score 9.10 · frontier 103 · ("), std::string::npos) << goals;
  EXPECT_NE(goals.find(") m</div><div>refused: not in known free space</div>"), std::string::npos) << goals;
  EXPECT_NE(goals.find("<li class=\"accepted\">"), std::string::npos) << goals;
  EXPECT_NE(goals.find("score 6.85 · frontier 100"), std::string::npos) << goals;
  EXPECT_NE(body.find("fly with --record-requests to see all"), std::string::npos);
}

TEST(ReportInBrowser, ExplainsTheColoursOfTheFrontiersByTheScoresOfTheirGoals) {
  TemporaryDirectory dir;
  write_small_run(dir.path());
  write_report(dir.path());
  const auto legend = [&](const char* moment) {
    const std::string body = show_page(dir.path() / "report.html", moment).body;
    const std::size_t at = body.find("id=\"score-scale\"");
    return body.substr(at, body.find("id=\"scale\"", at) - at);
  };
  const std::string fourth = legend("t=15");
  EXPECT_NE(fourth.find("<span>6.85</span><span>9.10</span>"), std::string::npos) << fourth;
  EXPECT_NE(fourth.find("no score known"), std::string::npos) << "ten frontiers have no goal: " << fourth;
  EXPECT_NE(legend("t=1").find("hidden"), std::string::npos) << "no frontiers yet";
}

TEST(ReportInBrowser, NamesWhatIsNotKnownInOneLineInsteadOfDashes) {
  TemporaryDirectory dir;
  write_small_run(dir.path());
  dir.write("metrics.json", R"({"policy": "lateral", "path_length_m": 60.5, "coverage": null,
                                "explored_volume_m3": 120.25})");
  write_report(dir.path());
  const std::string body = show_texts(dir.path() / "report.html").body;
  EXPECT_NE(body.find("not known: flight time, coverage, mean speed, least clearance"), std::string::npos);
  EXPECT_EQ(body.find("<b>–"), std::string::npos) << "no card without a value";
  EXPECT_NE(body.find("<p id=\"metrics-unknown\" class=\"quiet\">not known: coverage</p>"),
            std::string::npos);
  EXPECT_EQ(body.find("<td class=\"number\">–</td>"), std::string::npos);
}

TEST(ReportInBrowser, GivesTheUnitOfEachFigure) {
  TemporaryDirectory dir;
  write_small_run(dir.path());
  dir.write("metrics.json", R"({"path_length_m": 60.5, "explored_volume_m3": 120.25, "contacts": 0})");
  write_report(dir.path());
  const std::string body = show_texts(dir.path() / "report.html").body;
  for (const char* row :
       {"<td>path_length_m</td><td class=\"number\">60.50</td><td class=\"unit quiet\">m</td>",
        "<td>explored_volume_m3</td><td class=\"number\">120.3</td><td class=\"unit quiet\">m³</td>",
        "<td>contacts</td><td class=\"number\">0</td><td class=\"unit quiet\"></td>"})
    EXPECT_NE(body.find(row), std::string::npos) << row;
}

TEST(ReportInBrowser, FitsAPhone) {
  TemporaryDirectory dir;
  write_small_run(dir.path());
  write_report(dir.path());
  const test::PhoneLayout phone = test::lay_out_on_phone(dir.path() / "report.html");
  EXPECT_EQ(phone.too_wide, "");
  EXPECT_EQ(phone.too_small, "");
  EXPECT_EQ(phone.open, "") << "the view's controls are folded up";
}

TEST(ReportInBrowser, ShowsThreeDrawingsOfTheCaveThatFitAPhone) {
  TemporaryDirectory dir;
  write_small_run(dir.path());
  // A passage 30 m long with a side passage that leads up.
  core::write_octomap(test::map_of_boxes({{{0, 0, 0}, {150, 9, 9}}, {{80, 5, 5}, {89, 60, 20}}}),
                      (dir.path() / "map").string());
  write_report(dir.path(), cave_drawing::report_drawings(dir.path()));
  EXPECT_EQ(test::drawings_on(dir.path() / "report.html", 400), "Plan; Extended profile; Projected profile");
  const std::string body = show_texts(dir.path() / "report.html").body;
  EXPECT_NE(body.find("<section id=\"cave-drawings\" aria-label=\"Drawings\">"), std::string::npos);
  EXPECT_NE(body.find("<code>karst draw RUN --out drawings/cave</code>"), std::string::npos);
}

TEST(ReportInBrowser, KeepsTheIdsOfDrawingsApart) {
  TemporaryDirectory dir;
  write_small_run(dir.path());
  const std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"cave-drawing\" width=\"210mm\" height=\"297mm\" "
      "viewBox=\"0 0 210 297\"><clipPath id=\"a\"><path d=\"M0 0H9V9Z\"/></clipPath>"
      "<path d=\"M0 0H9V9Z\" fill=\"#aaaaaa\" clip-path=\"url(#a)\"/></svg>";
  write_report(dir.path(), {{{"One", svg}, {"Two", svg}}, ""});
  EXPECT_EQ(test::drawings_on(dir.path() / "report.html", 400), "One; Two");
  const std::string body = show_texts(dir.path() / "report.html").body;
  for (const char* part : {"<clipPath id=\"drawing1-a\">", "<clipPath id=\"drawing2-a\">",
                           "fill=\"#aaaaaa\" clip-path=\"url(#drawing2-a)\""})
    EXPECT_NE(body.find(part), std::string::npos) << part;
}

TEST(ReportInBrowser, PrintsEachDrawingOnAPageOfItsOwn) {
  TemporaryDirectory dir;
  write_small_run(dir.path());
  const auto paper = [](const std::string& width, const std::string& height) {
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"cave-drawing\" width=\"" + width +
           "mm\" height=\"" + height + "mm\" viewBox=\"0 0 " + width + " " + height +
           "\"><path d=\"M0 0H9V9Z\"/></svg>";
  };
  write_report(dir.path(), {{{"One", paper("210", "297")}, {"Two", paper("297", "210")}}, ""});
  const test::PrintedPages with = test::print_page(dir.path() / "report.html");
  EXPECT_EQ(with.a4_upright, 1);
  EXPECT_EQ(with.a4_wide, 1);
  write_report(dir.path());
  const test::PrintedPages without = test::print_page(dir.path() / "report.html");
  EXPECT_EQ(without.a4_upright + without.a4_wide, 0);
  EXPECT_GT(without.all, 0);
}

TEST(ReportInBrowser, SaysWhyThereAreNoDrawings) {
  TemporaryDirectory dir;
  write_small_run(dir.path());
  write_report(dir.path(), cave_drawing::report_drawings(dir.path()));
  const std::string body = show_texts(dir.path() / "report.html").body;
  EXPECT_NE(body.find("class=\"unknown quiet\">No drawings: the run holds no map.bt"), std::string::npos);
  EXPECT_EQ(test::drawings_on(dir.path() / "report.html", 400), "");
}

TEST(ReportInBrowser, CutsNoLabelAndBreaksNoWordOfAHeadOnADesktop) {
  TemporaryDirectory dir;
  for (const char* robot : {"robot_1", "robot_2", "robot_3"}) write_small_run(dir.path() / robot);
  write_report(dir.path() / "robot_1");
  EXPECT_EQ(test::cut_on_desktop(dir.path() / "robot_1" / "report.html"), "");
  dir.write("metrics.json",
            R"({"outcome": "landed", "exploration_time_s": 90, "explored_volume_m3": 4420, "coverage": 1,
    "t50_s": 1234, "robots_landed": 1, "robots_connected": 1, "data_at_base_share": 1, "contacts": 0, "path_length_m": 527,
    "bytes_on_air": 90965, "robots": [{"outcome": "landed", "reason": "as a relay", "start_s": 0, "battery_left": 0.9,
    "exploration_time_s": 14.6, "connected": true, "records": 20, "records_at_base": 20}, {}, {}]})");
  dir.write("team.jsonl",
            "{\"t\":0,\"kind\":\"team\",\"robots\":3}\n{\"t\":0,\"kind\":\"start\",\"robot\":1}\n");
  write_team_report(dir.path());
  EXPECT_EQ(test::cut_on_desktop(dir.path() / "report.html"), "");
}

TEST(ReportInBrowser, OfAReplaySaysWhatWasReplayedAndShowsBothPaths) {
  TemporaryDirectory dir;
  write_small_run(dir.path());
  fs::remove(dir.path() / "events.jsonl");
  fs::copy_file(dir.path() / "trajectory.tum", dir.path() / "trajectory_odometry.tum");
  std::ofstream(dir.path() / "loops.csv")
      << "older_s,newer_s,state,older_x,older_y,older_z,newer_x,newer_y,newer_z\n1,40,closed,1,2,3,1.5,2,3\n";
  std::ofstream(dir.path() / "mission.info") << "replay { scans /data/cave.bag }\n";
  std::ofstream(dir.path() / "events.jsonl")
      << R"({"t": 0, "kind": "phase", "phase": "replay", "reason": "900 scans"})"
      << "\n"
      << R"({"t": 30, "kind": "outcome", "outcome": "replayed", "reason": "the recording ended"})"
      << "\n";
  write_report(dir.path());
  const std::string body = show_page(dir.path() / "report.html").body;
  for (const char* there : {">cave.bag · replay<", "✓ replayed", "path, corrected", "path before loops",
                            "<b>1</b><span>loops closed</span>", "greatest correction"})
    EXPECT_NE(body.find(there), std::string::npos) << there;
  for (const char* none : {"unknown policy", "goals (refused)", "Last decision", "Battery left", "</i>out"})
    EXPECT_EQ(body.find(none), std::string::npos) << none;
}

TEST(ReportInBrowser, OfATeamFitsAPhoneAndHasANorthArrow) {
  TemporaryDirectory dir;
  for (const char* robot : {"robot_1", "robot_2"}) write_small_run(dir.path() / robot);
  dir.write("team.jsonl",
            "{\"t\":0,\"kind\":\"team\",\"robots\":2}\n{\"t\":0,\"kind\":\"start\",\"robot\":1}\n");
  write_team_report(dir.path());
  EXPECT_EQ(north_of(show_page(dir.path() / "report.html", "view=top").body), "rotate(0)");
  const test::PhoneLayout phone = test::lay_out_on_phone(dir.path() / "report.html");
  EXPECT_EQ(phone.too_wide, "");
  EXPECT_EQ(phone.too_small, "");
}

TEST(ReportInBrowser, OfATeamNamesAsRelaysOnlyRobotsThatLandedAwayFromTheBase) {
  TemporaryDirectory dir;
  for (const char* robot : {"robot_1", "robot_2", "robot_3"}) write_small_run(dir.path() / robot);
  dir.write("metrics.json", R"({"outcome": "landed", "robots": [{"outcome": "landed", "reason": "as a relay"},
    {"outcome": "landed", "reason": "at the start"}, {"outcome": "landed", "reason": "as a relay"}]})");
  dir.write("team.jsonl",
            R"({"t":0,"kind":"team","robots":3,"strategy":"relay_chain","base":[0,0,1],"reach":15}
{"t":0,"kind":"start","robot":1}
{"t":1,"kind":"start","robot":2}
{"t":2,"kind":"start","robot":3}
{"t":5,"kind":"base","connected":[0,1,2,3],"links":[],"held":[],"relays":[[1,[9,0,0]],[2,[3,0,0]],[3,[0.4,0.3,0]]],"dead":[]}
)");
  write_team_report(dir.path());
  const std::string body = show_page(dir.path() / "report.html").body;
  EXPECT_NE(body.find("<dt>reach it</dt><dd>1, 2, 3</dd><dt>stand as relays</dt><dd>1</dd>"),
            std::string::npos);
  for (const char* label :
       {">1 landed</span>", ">2 landed</span>", ">3 landed</span>"})  // all at the same place
    EXPECT_NE(body.find(label), std::string::npos) << label;
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
    return show_texts(dir.path() / "report.html", std::string("t=") + moment).body;
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
