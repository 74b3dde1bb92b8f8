// What Survex's programs print.
#include "sdk/survey/dump3d.h"

#include "sdk/survey/err_file.h"
#include "sdk/survey/survex_file.h"
#include "tests/unit/survey/survey_files.h"

namespace karst::survey {
namespace {

using test::Folder;
using test::says;

Dump3d dump(const std::string& text) {
  const Folder folder;
  return read_dump3d(folder.write("dump.txt", text), "a.3d");
}

TEST(Dump3d, LegsNodesAndCrossSections) {
  const Dump3d d = dump(
      "TITLE \"a cave\"\nSEPARATOR '.'\n--\nMOVE 1.00 2.00 3.00\nLINE 4.00 5.00 6.00 [a] STYLE=DIVING "
      "SURFACE\n"
      "LINE 7.00 8.00 9.00 [] STYLE=NORMAL DUPLICATE SPLAY 2010.05.03\nERROR_INFO #legs 3, len 34.00m\n"
      "NODE 1.00 2.00 3.00 [a.1] UNDERGROUND ENTRANCE FIXED\nNODE 7.00 8.00 9.00 [] UNDERGROUND ANON WALL\n"
      "XSECT 1.00 -0.01 3.00 4.00 [a.1]\nXSECT_END\nXSECT 1.00 2.00 3.00 4.00 [a.2]\nSTOP\n");
  EXPECT_EQ(d.title, "a cave");
  ASSERT_EQ(d.lines.size(), 2u);
  EXPECT_EQ(d.lines[0].from_m, core::Vec3(1, 2, 3));
  EXPECT_EQ(d.lines[1].from_m, core::Vec3(4, 5, 6));
  EXPECT_TRUE(d.lines[0].surface && !d.lines[0].splay && d.lines[1].duplicate && d.lines[1].splay);
  EXPECT_EQ(d.lines[0].style, Style::diving);
  ASSERT_EQ(d.nodes.size(), 2u);
  EXPECT_TRUE(d.nodes[0].entrance && d.nodes[0].fixed && d.nodes[1].name.empty());
  ASSERT_EQ(d.sections.size(), 2u);
  EXPECT_EQ(d.sections[0].dimensions.left_m, 1);
  EXPECT_FALSE(d.sections[0].dimensions.right_m);
  EXPECT_NE(d.sections[0].series, d.sections[1].series);
}

TEST(Dump3d, ALineThatCannotBeReadIsNamed) {
  for (const char* bad : {"NODE 1 2 [a]\n", "NODE 1 2 x [a]\n", "LINE 1 2 3\n", "MOVE 1e99 0 0\n",
                          "XSECT 1 2 3 [a]\n", "NODE 1 2 3 ]a[\n"}) {
    try {
      dump(std::string("--\n") + bad);
      FAIL() << bad;
    } catch (const core::InputError& e) {
      EXPECT_TRUE(says(e.what(), "a.3d: line 2 of what dump3d prints of it")) << e.what();
    }
  }
}

TEST(Dump3d, AnExtendedElevationIsNoCave) {
  try {
    dump("TITLE \"mole\"\nVERSION 8\nEXTENDED ELEVATION\nSEPARATOR '.'\n--\nNODE 0 0 0 [a] UNDERGROUND\n");
    FAIL();
  } catch (const core::InputError& e) {
    EXPECT_TRUE(says(e.what(), "a.3d: is an extended elevation")) << e.what();
  }
  EXPECT_TRUE(dump("TITLE \"EXTENDED ELEVATION\"\n--\n").nodes.empty()) << "a title may say so";
}

TEST(ErrFile, ATraverseThatNeverMovedIsOnNoLoop) {
  const Folder folder;
  EXPECT_TRUE(read_err_file(folder.write("a.err",
                                         "1 - 2 - 3\nOriginal length  20.00m (  2 legs), moved   0.00m ( "
                                         "0.00m/leg). Error   0.00%\n0.000000\nH: 0.000000 V: 0.000000\n\n"))
                  .empty());
}

TEST(ErrFile, TraversesAreSortedByTheirError) {
  const Folder folder;
  const auto traverses =
      read_err_file(folder.write("a.err",
                                 "1 - 2 = 3 - 1\nOriginal length  34.00m (  3 legs), moved   0.19m ( "
                                 "0.06m/leg). Error   0.55%\n0.684427\n"
                                 "H: 0.909431 V: 0.000000\n\n4 - 5\nOriginal length  10.00m (  1 legs), "
                                 "moved   2.00m ( 2.00m/leg). Error  20.00%\n"
                                 "12.5\nH: 1 V: 2\n\n6 = 7\nOriginal length   0.00m"));
  ASSERT_EQ(traverses.size(), 2u);
  EXPECT_EQ(traverses[0].from + traverses[0].to, "45");
  EXPECT_EQ(traverses[0].error_m, 2);
  EXPECT_NEAR(traverses[0].error_percent, 20, 1e-9);
  EXPECT_EQ(traverses[1].legs, 3u);
  EXPECT_NEAR(*traverses[1].sigmas, 0.684427, 1e-9);
  EXPECT_TRUE(read_err_file(folder.path() / "none.err").empty());
}

TEST(ErrFile, EndsWithoutANameAndFixedPointsAreNamed) {
  const Folder folder;
  const auto traverses = read_err_file(folder.write(
      "a.err",
      "cave.1 - cave.2 - \nOriginal length   9.00m (  2 legs), moved   0.30m\n1\nH: 1 V: 1\n\n"
      "<fixed point> - a-b = 4\nOriginal length   9.00m (  2 legs), moved   0.20m\n1\nH: 1 V: 1\n\n"
      "1 - <fixed point>\nOriginal length   9.00m (  1 legs), moved   0.10m\n1\nH: 1 V: 1\n"));
  ASSERT_EQ(traverses.size(), 3u);
  EXPECT_EQ(traverses[0].from, "cave.1");
  EXPECT_EQ(traverses[0].to, "a station without a name");
  EXPECT_EQ(traverses[1].from, "<fixed point>");
  EXPECT_EQ(traverses[1].to, "4");
  EXPECT_EQ(traverses[2].to, "<fixed point>");
  EXPECT_EQ(traverses[0].stations, (std::vector<std::string>{"cave.1", "cave.2"}));
  EXPECT_EQ(traverses[1].stations, (std::vector<std::string>{"a-b", "4"}));
}

TEST(CavernMessages, AreReadWithTheirFileAndLine) {
  const auto messages = cavern_messages(
      "Survex 1.4.4\na.svx:5:18: error: Expecting numeric field\n *declination auto\n      ^\n"
      "dir:x/b.svx:7: warning: Unused fixed point \"9\"\na.svx:5: info: Declination: 0.9\n"
      "cavern: error: Survey not all connected to fixed stations\nThe following survey stations are not "
      "attached to a fixed point:\nx.m\nx.c\nx.c\n");
  ASSERT_EQ(messages.size(), 3u);
  EXPECT_EQ(messages[0].file, "a.svx");
  EXPECT_EQ(messages[0].line, 5u);
  EXPECT_TRUE(messages[0].error);
  EXPECT_EQ(messages[0].text, "Expecting numeric field");
  EXPECT_EQ(messages[1].file, "dir:x/b.svx");
  EXPECT_EQ(messages[1].line, 7u);
  EXPECT_FALSE(messages[1].error);
  EXPECT_TRUE(messages[2].file.empty());
  EXPECT_TRUE(says(messages[2].text, "not all connected to fixed stations"));
  EXPECT_EQ(messages[2].unattached, (std::vector<std::string>{"x.m", "x.c"}));
}

TEST(PlaceNames, AreReadBack) {
  for (const std::uint32_t place : {0u, 99u, 100u, 123'456u, 4'000'000'000u})
    EXPECT_EQ(place_of_name(place_name(place)), place);
  for (const char* none : {"", "1", "1.2.3", "1.2.3.x", "1.2.3.4.5", "a.b.c.d", "99999.0.0.0"})
    EXPECT_FALSE(place_of_name(none)) << none;
}

}  // namespace
}  // namespace karst::survey
