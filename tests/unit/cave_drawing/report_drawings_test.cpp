#include "sdk/cave_drawing/report_drawings.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <string>

#include "core_stack/mapping/octomap/octomap_io.h"
#include "tests/unit/cave_drawing/box_maps.h"
#include "tests/unit/replay/folder.h"

namespace karst::cave_drawing {
namespace {

/// A passage 30 m long, from west to east, with a side passage that leads up.
void write_passage_map(const test::Folder& run) {
  core::write_octomap(test::map_of_boxes({{{0, 0, 0}, {150, 9, 9}}, {{80, 5, 5}, {89, 60, 20}}}),
                      (run.path() / "map").string());
}

TEST(ReportDrawings, OfARunArePlanExtendedAndProjectedProfileWithWhatItFound) {
  const test::Folder run;
  write_passage_map(run);
  run.write("mission.info", "cave\n{\n    file caves/berger.info\n}\n");
  run.write("trajectory.tum", "0 1 1 1 0 0 0 1\n1 20 1 1 0 0 0 1\n");
  run.write("objects.json", R"({"found": [{"number": 1, "what": "helmet", "position": [15, 1, 1]}]})");
  const evaluation::ReportDrawings drawn = report_drawings(run.path());
  EXPECT_EQ(drawn.note, "");
  ASSERT_EQ(drawn.pages.size(), 3u);
  EXPECT_EQ(drawn.pages[0].title, "Plan");
  EXPECT_EQ(drawn.pages[1].title, "Extended profile");
  EXPECT_EQ(drawn.pages[2].title, "Projected profile");
  std::size_t size_bytes = 0;
  for (const evaluation::ReportDrawing& page : drawn.pages) {
    EXPECT_EQ(page.svg.find("<svg "), 0u) << page.title << ": one element, without a prologue";
    EXPECT_NE(page.svg.find("aria-label=\"berger: " + page.title), std::string::npos);
    EXPECT_NE(page.svg.find("helmet"), std::string::npos) << page.title;
    size_bytes += page.svg.size();
  }
  EXPECT_LT(size_bytes, 300'000u);
}

TEST(ReportDrawings, WithoutAMapAreASentence) {
  const test::Folder run;
  const evaluation::ReportDrawings drawn = report_drawings(run.path());
  EXPECT_TRUE(drawn.pages.empty());
  EXPECT_EQ(drawn.note, "No drawings: the run holds no map.bt, which a flight writes at its end.");
}

TEST(ReportDrawings, OfADamagedMapOrRecordAreASentenceAndNoError) {
  const test::Folder run;
  run.write("map.bt", "no map");
  const evaluation::ReportDrawings damaged = report_drawings(run.path());
  EXPECT_TRUE(damaged.pages.empty());
  EXPECT_EQ(damaged.note.find("No drawings: "), 0u) << damaged.note;
  EXPECT_NE(damaged.note.find("map.bt"), std::string::npos) << damaged.note;
  write_passage_map(run);
  run.write("objects.json", "[7]");
  const evaluation::ReportDrawings bad_find = report_drawings(run.path());
  EXPECT_TRUE(bad_find.pages.empty());
  EXPECT_NE(bad_find.note.find("objects.json"), std::string::npos) << bad_find.note;
}

TEST(ReportDrawings, OfAMapWithoutFreeSpaceAreASentence) {
  const test::Folder run;
  core::VoxelMap rock{core::MapOptions{}};
  rock.assign({0, 0, 0}, 1, 2.0f);
  core::write_octomap(rock, (run.path() / "map").string());
  const evaluation::ReportDrawings drawn = report_drawings(run.path());
  EXPECT_TRUE(drawn.pages.empty());
  EXPECT_EQ(drawn.note.find("No drawings: "), 0u) << drawn.note;
}

}  // namespace
}  // namespace karst::cave_drawing
