// The structure of Therion's files: surveys, inputs, names, encodings, what is skipped and refused.
#include "sdk/survey/therion_reader.h"

#include <set>

#include "tests/unit/survey/survey_files.h"

namespace karst::survey {
namespace {

using test::Folder;
using test::notes_say;
using test::readings_of;
using test::refusal_of;
using test::refusal_of_text;
using test::says;

const std::string kLeg = "centreline\ndata normal from to length compass clino\n1 2 10 0 0\nendcentreline\n";

std::set<std::string> names(const Readings& r) {
  std::set<std::string> all;
  for (const ReadStation& s : r.stations) all.insert(s.name);
  return all;
}

TEST(TherionReader, NamesAreThoseOfTheSurveysFromTheOutermost) {
  const Folder folder;
  const Readings r = read_therion(folder.write("s.th", "survey a -title \"A cave\"\nsurvey b\n" + kLeg +
                                                           "endsurvey b\nsurvey c -namespace off\n" + kLeg +
                                                           "endsurvey\nequate 1@b 2\nendsurvey\n"));
  EXPECT_EQ(names(r), (std::set<std::string>{"a.b.1", "a.b.2", "a.1", "a.2"}));
  EXPECT_EQ(r.title, "A cave");
  ASSERT_EQ(r.equates.size(), 1u);
  EXPECT_EQ(r.stations[r.equates[0].a].name, "a.b.1");
  EXPECT_EQ(r.stations[r.equates[0].b].name, "a.2");
}

TEST(TherionReader, NamesBehindAtMayComeLaterAndGoDeep) {
  const Folder folder;
  const Readings r = read_therion(folder.write("s.th", "survey a\nequate 1@c.b 2@c.b\nsurvey b\nsurvey c\n" +
                                                           kLeg + "endsurvey\nendsurvey\nendsurvey\n"));
  EXPECT_EQ(r.stations[r.equates.at(0).a].name, "a.b.c.1");
  EXPECT_EQ(r.stations.size(), 2u);
}

TEST(TherionReader, EquatesOfUnknownSurveysAreRefusedAndOfUnknownStationsNoted) {
  EXPECT_TRUE(says(refusal_of_text("survey a\n" + kLeg + "equate 1 2@nowhere\nendsurvey\n"),
                   "line 6: there is no survey nowhere"));
  const Readings r = readings_of("data normal from to length compass clino\n1 2 10 0 0\nequate 1 x\n");
  EXPECT_TRUE(notes_say(r.log.notes, "no leg leads to s.x"));
}

TEST(TherionReader, NamesThatAreEmptyOrTooLongAreRefused) {
  EXPECT_TRUE(says(refusal_of_text("survey a\n" + kLeg + "equate 1 @a\nendsurvey\n"),
                   "line 6: is no name of a station"));
  EXPECT_TRUE(
      says(refusal_of_text("survey " + std::string(2000, 'x') + "\n"), "line 1: the names of the surveys"));
}

TEST(TherionReader, InputsAreRelativeWithOrWithoutEndingAndInAnyCase) {
  const Folder folder;
  std::filesystem::create_directories(folder.path() / "Parts/deep");
  folder.write("Parts/one.th", "survey one\n" + kLeg + "input deep/two\nendsurvey\n");
  folder.write("Parts/deep/two.th", "survey two\n" + kLeg + "endsurvey\n");
  const Readings r = read_therion(folder.write("s.th", "input Parts/one.th\ninput parts/Deep/TWO\n"));
  EXPECT_EQ(names(r), (std::set<std::string>{"one.1", "one.2", "one.two.1", "one.two.2", "two.1", "two.2"}));
  EXPECT_TRUE(notes_say(r.log.notes, "no input is called parts/Deep/TWO; read instead: "));
  EXPECT_EQ(r.log.files.size(), 3u);
}

TEST(TherionReader, InputsThatAreMissingOrRunInACircleAreRefused) {
  EXPECT_TRUE(says(refusal_of_text("\ninput nowhere\n"), "s.th: line 2: cannot find the input nowhere"));
  const Folder folder;
  folder.write("b.th", "\n\ninput s\n");
  try {
    read_therion(folder.write("s.th", "input b\n"));
    FAIL();
  } catch (const core::InputError& e) {
    EXPECT_TRUE(says(e.what(), "b.th: line 3: inputs s, which this line itself is part of")) << e.what();
  }
}

TEST(TherionReader, DrawingsAreNotOpened) {
  const Folder folder;
  const Readings r =
      read_therion(folder.write("s.th", "input a.th2\ninput b.th2\nsurvey s\n" + kLeg + "endsurvey\n"));
  ASSERT_EQ(r.log.notes.size(), 1u);
  EXPECT_TRUE(says(r.log.notes[0].text, "drawings"));
  EXPECT_EQ(r.log.notes[0].more, 1u);
}

TEST(TherionReader, TextIsInTheEncodingOfItsFile) {
  const Folder folder;
  const auto title = [&](const std::string& text) { return read_therion(folder.write("s.th", text)).title; };
  const std::string rest = "\"\n" + kLeg + "endsurvey\n";
  EXPECT_EQ(title("encoding utf-8\nsurvey s -title \"H\xc3\xb6hle" + rest), "H\xc3\xb6hle");
  EXPECT_EQ(title("encoding ISO8859-1\nsurvey s -title \"H\xf6hle" + rest), "H\xc3\xb6hle");
  EXPECT_EQ(title("encoding iso8859-2\nsurvey s -title \"\xb9" + rest), "\xc5\xa1");
  EXPECT_EQ(title("encoding iso-8859-15\nsurvey s -title \"\xa4" + rest), "\xe2\x82\xac");
  EXPECT_EQ(title("encoding cp1250\nsurvey s -title \"\x9a" + rest), "\xc5\xa1");
  EXPECT_EQ(title("encoding CP1252\nsurvey s -title \"\x80" + rest), "\xe2\x82\xac");
  const Readings wrong = read_therion(folder.write("s.th", "survey s -title \"H\xf6hle" + rest));
  EXPECT_EQ(wrong.title, "H?hle");
  EXPECT_TRUE(notes_say(wrong.log.notes, "is not UTF-8"));
  EXPECT_TRUE(says(refusal_of_text("encoding klingon\n"), "line 1: the encoding klingon is not known"));
}

TEST(TherionReader, LinesGoOnBehindABackslashAndEndAtAComment) {
  const Readings r =
      readings_of("data normal from to \\\n length compass clino # in metres\r\n1 2 \\\n10 0 0 # there\n");
  ASSERT_EQ(r.legs.size(), 1u);
  EXPECT_EQ(r.legs[0].source.line, 5u) << "where the line begins";
}

TEST(TherionReader, BlocksWithoutSurveyDataAreSkipped) {
  const Folder folder;
  const Readings r = read_therion(
      folder.write("s.th",
                   "survey s\nmap m -title x\n 1 2 3\nendmap\nscrap p\nline wall\n1 2\nendline\nendscrap\n"
                   "surface\ngrid 1 2\nendsurface\njoin a b\n" +
                       kLeg + "endsurvey\n"));
  EXPECT_EQ(r.legs.size(), 1u);
  EXPECT_TRUE(says(refusal_of_text("survey s\nmap m\nendsurvey\n"), "line 2: map has no endmap"));
  EXPECT_TRUE(says(refusal_of_text("survy s\n"), "line 1: is no command: 'survy'"));
}

TEST(TherionReader, SurveysAndCentrelinesMustEnd) {
  EXPECT_TRUE(says(refusal_of_text("survey s\n"), "line 1: the survey has no endsurvey"));
  EXPECT_TRUE(says(refusal_of_text("endsurvey\n"), "endsurvey without survey"));
  EXPECT_TRUE(says(refusal_of_text("survey a\nendsurvey b\n"), "endsurvey b ends survey a"));
  EXPECT_TRUE(says(refusal_of_text("survey s\ncentreline\n"), "line 2: the centreline has no endcentreline"));
  std::string deep;
  for (int i = 0; i < 400; ++i) deep += "survey s\n";
  EXPECT_TRUE(says(refusal_of_text(deep), "too deep in each other"));
}

TEST(TherionReader, StationsHaveCommentsFlagsAndFixes) {
  const Readings r = readings_of(
      "cs UTM33\nstation 1 \"The \"\"big\"\" one\" entrance\nstation 2 \"\" continuation explored 80m not "
      "fixed attr a b\n"
      "fix 1 400000 5000000 1200 1 2 3\ndata normal from to length compass clino\n1 2 10 0 0\n");
  EXPECT_EQ(r.stations[0].comment, "The \"big\" one");
  EXPECT_TRUE(r.stations[0].entrance);
  EXPECT_TRUE(r.stations[1].continuation);
  ASSERT_EQ(r.fixes.size(), 1u);
  EXPECT_EQ(r.fixes[0].system, "UTM33");
  EXPECT_EQ(r.fixes[0].sd_m, core::Vec3(1, 2, 3));
  EXPECT_TRUE(says(refusal_of("station 9 \"\" entrance\n"), "line 3: there is no station s.9"));
  EXPECT_TRUE(says(refusal_of("station 1 \"\" haunted\n"), "is no flag of a station: 'haunted'"));
  EXPECT_TRUE(says(refusal_of("station 1 \"\" continuation explored\n"), "a word is missing"));
  EXPECT_TRUE(says(refusal_of("station 1 \"\" not\n"), "'not' is followed by a flag"));
  EXPECT_TRUE(says(refusal_of("fix 1 2 3\n"), "line 3: fix takes"));
  EXPECT_TRUE(says(refusal_of("fix 1 a 3 4\n"), "is no coordinate: 'a'"));
}

TEST(TherionReader, StationNamesGetTheirPrefixAndSuffix) {
  EXPECT_EQ(names(readings_of("station-names p. /x\ndata normal from to length compass clino\n1 2 10 0 0\n")),
            (std::set<std::string>{"s.p.1/x", "s.p.2/x"}));
}

TEST(TherionReader, StationNamesAreCompletedInEveryCommandOfTheirCentrelineAndNowhereElse) {
  const Folder folder;
  const Readings r = read_therion(folder.write(
      "s.th",
      "survey s\ncentreline\nstation-names p x\nfix 1 5 6 7\ndata normal from to length compass clino\n"
      "1 2 10 0 0\n3 4 10 0 0\nstation 4 \"\" entrance\nequate 2 3\nextend left 1 2\nendcentreline\n"
      "equate p4x p1x\nendsurvey\n"));
  EXPECT_EQ(names(r), (std::set<std::string>{"s.p1x", "s.p2x", "s.p3x", "s.p4x"}));
  EXPECT_EQ(r.stations.at(r.fixes.at(0).station).name, "s.p1x");
  EXPECT_EQ(r.legs.at(0).extend, Extend::left);
  EXPECT_TRUE(r.stations.at(r.legs.at(1).to).entrance);
  EXPECT_TRUE(r.log.notes.empty());
}

TEST(TherionReader, NoStationOfACommandIsAnonymous) {
  EXPECT_TRUE(says(refusal_of("equate 1 .\n"), "line 3: is no name of a station: '.'"));
  EXPECT_TRUE(says(refusal_of("fix - 0 0 0\n"), "line 3: is no name of a station: '-'"));
  EXPECT_TRUE(says(refusal_of("equate 1 " + std::string(2000, 'x') + "\n"), "is no name of a station"));
}

TEST(TherionReader, NamesOfSurveysHaveNoDots) {
  for (const char* name : {"a.b", "a@b", "\"\""})
    EXPECT_TRUE(says(refusal_of_text(std::string("survey ") + name + "\nendsurvey\n"),
                     "line 1: is no name of a survey"))
        << name;
}

TEST(TherionReader, AGridAngleThatIsTakenBackLeavesTheDeclinationOfTheSurveyAround) {
  const Folder folder;
  const Readings r = read_therion(
      folder.write("s.th",
                   "survey s -declination [2 degrees]\ncentreline\ngrid-angle 9 degrees\ngrid-angle -\n"
                   "data normal from to length compass clino\n1 2 10 0 0\nendcentreline\nendsurvey\n"));
  EXPECT_EQ(r.conditions.at(0).declination_deg, 2);
  EXPECT_FALSE(r.conditions.at(0).declination_from_grid) << "it counts from true north";
}

TEST(TherionReader, DeclinationsComeFromTheCentrelineTheDateOrTheSurveyAround) {
  const auto declination = [](const std::string& survey, const std::string& lines) {
    const Folder folder;
    const Readings r = read_therion(folder.write(
        "s.th", "survey s " + survey + "\ncentreline\n" + lines +
                    "data normal from to length compass clino\n1 2 10 0 0\nendcentreline\nendsurvey\n"));
    return r.conditions.at(r.legs.at(0).conditions).declination_deg;
  };
  EXPECT_FALSE(declination("", ""));
  EXPECT_EQ(declination("", "declination 3 degrees\n"), 3);
  EXPECT_DOUBLE_EQ(*declination("", "declination 10 grads\n"), 9);
  EXPECT_EQ(declination("-declination [2 degrees]", ""), 2);
  EXPECT_EQ(declination("-declination [2 degrees]", "declination -1 degrees\n"), -1);
  EXPECT_NEAR(*declination("-declination [2000 1 2010 3 degrees]", "date 2005.01.01\n"), 2, 1e-9);
  EXPECT_NEAR(*declination("", "declination [2000 1 2010 3 degrees]\ndate 2002.06.31 - 2002.06.31\n"), 1.5,
              0.01);
  EXPECT_EQ(declination("-declination [2000 1 2010 3 - 7 degrees]", ""), 7);
  EXPECT_EQ(declination("-declination [2000 1 2010 3 degrees]", ""), 2);
  EXPECT_TRUE(says(refusal_of("declination 3\n"), "line 3: a declination has a value and a unit"));
  EXPECT_TRUE(says(refusal_of("date soon\n"), "is no date: 'soon'"));
}

TEST(TherionReader, UnknownUnitsAreRefusedAndUnitsOfNothingNoted) {
  EXPECT_TRUE(says(refusal_of("units length furlongs\n"), "line 3: is no unit: 'furlongs'"));
  EXPECT_TRUE(says(refusal_of("units length degrees\n"), "is no unit of length: 'degrees'"));
  EXPECT_TRUE(says(refusal_of("units length compass metres\n"), "no unit in common"));
  EXPECT_TRUE(says(refusal_of("units compass percent\n"), "cannot be a percentage"));
  EXPECT_TRUE(says(refusal_of("calibrate tape 1 0\n"), "cannot be zero"));
  EXPECT_TRUE(says(refusal_of("sd tape 0.1\n"), "a value and a unit"));
  EXPECT_TRUE(says(refusal_of("sd tape 0 metres\n"), "line 3: is no standard deviation: '0'"));
  EXPECT_TRUE(
      notes_say(readings_of("units lenght metres\n").log.notes, "units of lenght, which is no quantity"));
}

TEST(TherionReader, ExtendsAreKept) {
  const Readings r = readings_of(
      "data normal from to length compass clino\nextend left\n1 2 10 0 0\n2 3 10 0 0\nextend vertical 3 "
      "2\nextend start 1\n");
  EXPECT_EQ(r.legs[0].extend, Extend::left);
  EXPECT_EQ(r.legs[1].extend, Extend::vertical);
  EXPECT_TRUE(says(refusal_of("extend sideways\n"), "is no direction of extend: 'sideways'"));
}

TEST(TherionReader, AFileCutAnywhereIsReadOrRefused) {
  const std::string whole =
      "encoding iso8859-1\nsurvey s -title [a b]\ncentreline\nunits length 2 feet\ncalibrate compass 1 2 3 "
      "4\n"
      "data normal from to length compass clino left [1\n1 2 10 0 0 [1 2]\nendcentreline\nendsurvey\n";
  for (std::size_t n = 0; n < whole.size(); ++n) {
    const std::string said = refusal_of_text(whole.substr(0, n));
    EXPECT_TRUE(said.empty() || says(said, "line ")) << n << ": " << said;
  }
}

}  // namespace
}  // namespace karst::survey
