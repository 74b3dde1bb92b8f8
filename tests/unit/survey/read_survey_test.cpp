#include "sdk/survey/read_survey.h"

#include "tests/unit/survey/adjusted_surveys.h"

namespace karst::survey {
namespace {

using core::Vec3;
using test::expect_at;
using test::Folder;
using test::place;
using test::says;
using test::station;

std::string refusal_of_file(const std::string& file) {
  try {
    read_survey(file);
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "";
}
TEST(ReadSurvey, TheEndingTellsTheKind) {
  EXPECT_TRUE(says(refusal_of_file("cave.stl"), "cave.stl: is no survey by its name: .th, .svx, .3d"));
  EXPECT_TRUE(says(refusal_of_file("/nowhere/cave.th"), "/nowhere/cave.th: cannot be opened: no such file"));
  EXPECT_TRUE(says(refusal_of_file("/nowhere/cave.3d"), "/nowhere/cave.3d: "));
}

TEST(ReadSurvey, ASurvexSurveyHasItsPassagesFlagsAndSplays) {
  SKIP_WITHOUT_SURVEX();
  const Folder folder;
  const Survey s = read_survey(folder.write(
      "a.svx",
      "*title \"My cave\"\n*begin a\n*fix 1 10 20 30\n*entrance 1\n1 2 10 0 0\n2 3 10 90 0\n2 .. 4 180 0\n"
      "*flags duplicate\n3 4 5 - down\n*flags not duplicate surface\n1 5 7 180 0\n*flags not surface\n"
      "*data passage station left right up down\n1 1 2 3 4\n2 - 1 1 1\n3 1 1 1 1\n*end a\n"));
  EXPECT_EQ(s.title, "My cave");
  ASSERT_EQ(s.stations.size(), 5u);
  expect_at(place(s, "a.4"), {20, 30, 25});
  EXPECT_TRUE(station(s, "a.1").entrance && station(s, "a.1").fixed);
  EXPECT_TRUE(station(s, "a.5").surface && !station(s, "a.1").surface);
  ASSERT_EQ(s.legs.size(), 4u);
  EXPECT_EQ(std::count_if(s.legs.begin(), s.legs.end(), [](const Leg& l) { return l.duplicate; }), 1);
  ASSERT_EQ(s.splays.size(), 1u);
  expect_at(s.splays[0].end_m, {10, 26, 30});
  ASSERT_EQ(s.sections.size(), 3u);
  expect_at(s.sections[0].facing, {0, 1, 0});
  expect_at(s.sections[1].facing, Vec3(1, 1, 0).normalized());
  expect_at(s.sections[2].facing, {1, 0, 0});
  EXPECT_FALSE(s.sections[1].dimensions.left_m);
  EXPECT_EQ(s.sections[0].dimensions.down_m, 4);
  EXPECT_NEAR(length_m(s), 20, 0.02);
}

TEST(ReadSurvey, ErrorsAndWarningsOfCavernNameTheirPlace) {
  SKIP_WITHOUT_SURVEX();
  const Folder folder;
  folder.write("part.svx", "1 2 10 0 0\n1 3 ten 0 0\n");
  const std::string said = refusal_of_file(folder.write("a.svx", "*include part\n"));
  EXPECT_TRUE(says(said, "part.svx: line 2: ")) << said;
  const Survey s = read_survey(folder.write("b.svx", "*fix 9 1 2 3\n*fix 1 0 0 0\n1 2 10 0 0\n"));
  EXPECT_TRUE(test::notes_say(s.notes, "cavern: ")) << "an unused fixed point";
  EXPECT_TRUE(
      says(refusal_of_file(folder.write("c.svx", "*fix 1 0 0 0\n1 2 10 0 0\n3 4 10 0 0\n")), "not attached"));
  EXPECT_TRUE(says(refusal_of_file(folder.write("d.svx", "")), "d.svx: "));
}

TEST(ReadSurvey, SeveralErrorsOfCavernAreGivenAtOnce) {
  SKIP_WITHOUT_SURVEX();
  const Folder folder;
  const std::string said =
      refusal_of_file(folder.write("a.svx", "*fix 1 0 0 0\n1 2 10 0 0\n2 3 x 0 0\n*foo bar\n3 4 y 0 0\n"));
  for (const char* part : {"a.svx: line 3: ", "; line 4: ", "; line 5: "})
    EXPECT_TRUE(says(said, part)) << said;
  std::string many = "*fix 1 0 0 0\n1 2 10 0 0\n";
  for (int i = 0; i < 7; ++i) many += "*foo bar\n";
  const std::string cut = refusal_of_file(folder.write("b.svx", many));
  EXPECT_TRUE(says(cut, "; line 7: ") && !says(cut, "line 8") && says(cut, "; and 2 more errors")) << cut;
}

TEST(ReadSurvey, LoosePartsAreCountedAndNamed) {
  SKIP_WITHOUT_SURVEX();
  const Folder folder;
  const std::string said =
      refusal_of_file(folder.write("a.svx", "*begin x\n1 2 10 40 0\n8 9 10 40 0\n*end x\n"));
  EXPECT_TRUE(says(said, "1 loose part, with x.8") && says(said, "*equate")) << said;
}

TEST(ReadSurvey, ASurvexFileThatIncludesItselfIsRefusedWithItsLine) {
  SKIP_WITHOUT_SURVEX();
  const Folder folder;
  EXPECT_TRUE(says(refusal_of_file(folder.write("a.svx", "*include a\n1 2 10 0 0\n")), "a.svx: line 1: "));
}

TEST(ReadSurvey, FarEndsOfSplaysAreNoStationsThoughTheyHaveNames) {
  SKIP_WITHOUT_SURVEX();
  const Folder folder;
  const Survey s = read_survey(folder.write(
      "a.svx",
      "*fix 1 0 0 0\n1 2 10 0 0\n*flags splay\n2 w 4 90 0\nv 2 4 90 0\n*flags not splay\n2 3 5 0 0\n"));
  EXPECT_EQ(s.stations.size(), 3u);
  EXPECT_EQ(s.legs.size(), 2u);
  ASSERT_EQ(s.splays.size(), 2u);
  for (const Splay& splay : s.splays) {
    EXPECT_EQ(s.stations[splay.station].name, "2");
    EXPECT_NEAR(std::abs(splay.end_m.x()), 4, 0.01);
  }
}

// Splays between the legs, and a branch that is noted first, put the legs of a .3d file into pieces.
TEST(ReadSurvey, LegsBetweenSectionsAreOfTheirRun) {
  SKIP_WITHOUT_SURVEX();
  const Folder folder;
  const Survey s = read_survey(
      folder.write("a.svx",
                   "*fix 1 0 0 0\n2 5 7 180 0\n1 2 10 0 0\n2 .. 4 90 0\n2 3 10 0 0\n3 .. 4 90 0\n3 4 10 0 0\n"
                   "*data passage station left right up down\n2 1 1 1 1\n5 2 2 2 2\n"
                   "*data passage station left right up down\n1 3 3 3 3\n2 3 3 3 3\n3 3 3 3 3\n"));
  ASSERT_EQ(s.legs.size(), 4u);
  ASSERT_EQ(s.sections.size(), 5u);
  const auto run = [&](const std::string& a, const std::string& b) {
    for (const Leg& l : s.legs) {
      const std::string &from = s.stations[l.from].name, &to = s.stations[l.to].name;
      if ((from == a && to == b) || (from == b && to == a)) return l.run;
    }
    return ~0u;
  };
  const auto run_of_width = [&](double left_m) {
    for (const Section& section : s.sections)
      if (section.dimensions.left_m == left_m) return section.run;
    return ~0u;
  };
  EXPECT_EQ(run("2", "5"), run_of_width(2));
  EXPECT_EQ(run("1", "2"), run_of_width(3));
  EXPECT_EQ(run("2", "3"), run_of_width(3));
  EXPECT_NE(run_of_width(2), run_of_width(3));
  EXPECT_NE(run("3", "4"), run_of_width(2));
  EXPECT_NE(run("3", "4"), run_of_width(3));
}

TEST(ReadSurvey, NamesMayHoldSpacesAndBeginAsAnOptionDoes) {
  SKIP_WITHOUT_SURVEX();
  const Folder folder;
  folder.write("-o x.svx", "1 2 10 0 0\n");
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  const Survey svx = read_survey("-o x.svx");
  const CavernRun run = run_cavern("-o x.svx", folder.path());
  std::filesystem::rename(run.three_d, "-o x.3d");
  const Survey processed = read_survey("-o x.3d");
  std::filesystem::current_path(before);
  EXPECT_EQ(svx.legs.size(), 1u);
  EXPECT_EQ(processed.legs.size(), 1u);
}

TEST(ReadSurvey, AProcessedSurveyIsThatOfItsSource) {
  SKIP_WITHOUT_SURVEX();
  const Folder folder;
  const std::string svx =
      folder.write("a.svx", "*fix 1 0 0 0\n1 2 10 0 0\n2 3 10 120 0\n3 1 10 240 1\n3 4 5 0 0\n");
  const CavernRun run = run_cavern(svx, folder.path());
  ASSERT_TRUE(run.closed);
  const Survey from_3d = read_survey(run.three_d.string()), from_svx = read_survey(svx);
  EXPECT_EQ(from_3d.stations.size(), from_svx.stations.size());
  EXPECT_EQ(from_3d.legs.size(), 4u);
  EXPECT_EQ(from_3d.loops.count, 1u);
  expect_at(place(from_3d, "4"), place(from_svx, "4"));
  EXPECT_TRUE(
      says(refusal_of_file(folder.write("b.3d", "not a survey")), "b.3d: cannot be read as a survey"));
}

TEST(ReadSurvey, LegsWithinACentimetreAreLeftOutWithANote) {
  SKIP_WITHOUT_SURVEX();
  const Folder folder;
  const std::string lines = "*begin a\n*fix 1 0 0 0\n1 2 10 0 0\n2 3 0.004 0 0\n3 4 10 0 0\n";
  const Survey s = read_survey(folder.write("a.svx", lines + "*end a\n"));
  EXPECT_EQ(s.legs.size(), 2u);
  ASSERT_EQ(s.stations.size(), 3u);
  EXPECT_EQ(&station(s, "a.2"), &station(s, "a.3"));
  EXPECT_TRUE(test::notes_say(s.notes, "1 leg left out: both ends round to the same centimetre"));
  EXPECT_TRUE(test::notes_say(s.notes, "such as a.2 = a.3") || test::notes_say(s.notes, "such as a.3 = a.2"));
  const Survey more =
      read_survey(folder.write("b.svx", lines + "4 5 0.003 90 0\n4 6 5 0 0\n*equate 6 7\n*end a\n"));
  EXPECT_TRUE(test::notes_say(more.notes, "2 legs left out"));
  const Survey equated =
      read_survey(folder.write("c.svx", "*fix 1 0 0 0\n1 2 10 0 0\n*equate 2 3\n3 4 10 0 0\n"));
  EXPECT_FALSE(test::notes_say(equated.notes, "left out"));
}

// Compass measures in feet.
TEST(ReadSurvey, CompassSurveys) {
  SKIP_WITHOUT_SURVEX();
  const Folder folder;
  const std::string dat = folder.write(
      "c.dat",
      "Cave\r\nSURVEY NAME: A\r\nSURVEY DATE: 7 10 1979  COMMENT:x\r\nSURVEY TEAM:\r\nX\r\nDECLINATION: 0.00 "
      " FORMAT: "
      "DDDDLRUDLADNF  CORRECTIONS: 0.00 0.00 0.00\r\n\r\nFROM TO LENGTH BEARING INC LEFT UP DOWN RIGHT FLAGS "
      "COMMENTS\r\n\r\nA1 A2 100.0 90.0 0.0 1.0 2.0 3.0 4.0\r\nA2 A3 100.0 0.0 0.0 -9.90 2.0 3.0 "
      "4.0\r\n\f\r\n");
  const Survey s = read_survey(dat);
  expect_at(place(s, "A3"), {30.48, 30.48, 0});
  ASSERT_EQ(s.sections.size(), 2u);
  EXPECT_EQ(s.stations[s.sections[0].station].name, "A1");
  expect_at(s.sections[0].facing, {1, 0, 0});
  expect_at(s.sections[1].facing, {0, 1, 0});
  EXPECT_DOUBLE_EQ(*s.sections[0].dimensions.left_m, 0.3048);
  EXPECT_DOUBLE_EQ(*s.sections[0].dimensions.up_m, 2 * 0.3048);
  EXPECT_DOUBLE_EQ(*s.sections[0].dimensions.down_m, 3 * 0.3048);
  EXPECT_DOUBLE_EQ(*s.sections[0].dimensions.right_m, 4 * 0.3048);
  ASSERT_TRUE(s.sections[0].leg);
  EXPECT_EQ(s.legs[*s.sections[0].leg].run, s.sections[0].run);
  EXPECT_FALSE(s.sections[1].dimensions.left_m) << "-9.90 stands for what was not measured";
  EXPECT_TRUE(says(place_of(s, s.sections[1].source), "c.dat: line 11"));
  const Survey mak = read_survey(folder.write("c.mak", "#c.dat,A1[m,10,20,30];\r\n"));
  expect_at(place(mak, "A3"), {40.48, 50.48, 30});
  EXPECT_EQ(mak.sections.size(), 2u);
  std::filesystem::copy_file(dat, folder.path() / "Copy.Dat");
  EXPECT_EQ(read_survey((folder.path() / "Copy.Dat").string()).sections.size(), 2u);
  const Survey plt = read_survey(folder.write("c.plt",
                                              "Z 0 100 0 100 0 0 I 0\r\nSCave\r\nNA D 7 10 1979 CX\r\nM 0 0 "
                                              "0 SA1 P 1 2 3 4 I 0\r\nD 0 100 0 SA2 P 1 2 3 4 I "
                                              "100\r\nX 0 100 0 100 0 0 SA\r\n\f\r\n"));
  expect_at(place(plt, "A.A2"), {30.48, 0, 0});
}

TEST(ReadSurvey, WithoutSurvexThePackageIsNamed) {
  const Folder folder;
  const std::string svx = folder.write("a.svx", "1 2 10 0 0\n");
  const std::string th =
      folder.write("a.th", test::centreline("data normal from to length compass clino\n1 2 10 0 0\n"));
  const std::string path = std::getenv("PATH") ? std::getenv("PATH") : "";
  setenv("PATH", folder.path().c_str(), 1);
  const std::string said_of_svx = refusal_of_file(svx), said_of_th = refusal_of_file(th);
  setenv("PATH", path.c_str(), 1);
  const std::string why = ": cavern of Survex is not installed, or not in PATH: apt-get install survex";
  EXPECT_EQ(said_of_svx, svx + why);
  EXPECT_EQ(said_of_th, th + why) << "not the file that is written for cavern";
}

TEST(ReadSurvey, AHundredThousandLegsAreClosed) {
  SKIP_WITHOUT_SURVEX();
  std::string text = "survey s\ncentreline\ndata normal from to length compass clino\n";
  for (int i = 0; i < 100'000; ++i) text += std::to_string(i) + " " + std::to_string(i + 1) + " 1 0 0\n";
  const Folder folder;
  const Survey s = read_survey(folder.write("s.th", text + "endcentreline\nendsurvey\n"));
  EXPECT_EQ(s.stations.size(), 100'001u);
  expect_at(place(s, "s.100000"), {0, 100'000, 0});
}

}  // namespace
}  // namespace karst::survey
