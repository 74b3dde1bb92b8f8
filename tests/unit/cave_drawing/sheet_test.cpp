#include "sdk/cave_drawing/sheet.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/cave_drawing/drawn_lines.h"

namespace karst::cave_drawing {
namespace {

TEST(Sheet, TheDrawingIsInsideItsFrameAndTheFrameOnThePage) {
  for (const Paper paper : {Paper::a4, Paper::a3})
    for (const Point& size : {Point(3, 200), Point(200, 3), Point(1, 1), Point(4000, 2500), Point(0, 0)}) {
      const Extent extent{Point(-7, 12), Point(-7, 12) + size};
      const Sheet sheet = fitted_sheet(extent, {paper, {}, 0}, "map");
      const Frame& f = sheet.frame;
      for (const Point& p : {f.at(extent.low), f.at(extent.high)}) {
        EXPECT_GE(p.x(), f.left_mm);
        EXPECT_LE(p.x(), f.left_mm + f.width_mm);
        EXPECT_GE(p.y(), f.top_mm);
        EXPECT_LE(p.y(), f.top_mm + f.height_mm);
      }
      EXPECT_GE(f.left_mm, 10);
      EXPECT_LE(f.left_mm + f.width_mm, sheet.width_mm - 10);
      EXPECT_LT(f.top_mm + f.height_mm, sheet.title_top_mm);
    }
}

TEST(Sheet, TallCavesAreUprightAndLargerPaperIsALargerScale) {
  const Extent tall{{0, 0}, {20, 100}}, wide{{0, 0}, {100, 20}};
  EXPECT_EQ(fitted_sheet(tall, {}, "map").width_mm, 210);
  EXPECT_EQ(fitted_sheet(wide, {}, "map").width_mm, 297);
  EXPECT_LT(fitted_sheet(wide, {Paper::a3, {}, 0}, "map").frame.scale,
            fitted_sheet(wide, {}, "map").frame.scale);
}

TEST(Sheet, AScaleIsForcedOrRefusedWithOneThatFits) {
  const Extent extent{{0, 0}, {100, 20}};
  EXPECT_EQ(fitted_sheet(extent, {Paper::a4, 1000, 0}, "map").frame.scale, 1000);
  const std::string refusal = test::refusal_by([&] { fitted_sheet(extent, {Paper::a4, 100, 0}, "a.bt"); });
  EXPECT_NE(refusal.find("a.bt: does not fit on a4 at 1:100; it does at 1:400"), std::string::npos)
      << refusal;
  EXPECT_FALSE(test::refusal_by([&] {
                 fitted_sheet(extent, {Paper::a4, std::numeric_limits<double>::quiet_NaN(), 0}, "");
               }).empty());
}

TEST(Sheet, GridAndBarAreRoundMetres) {
  EXPECT_EQ(grid_step_m(500, 15), 10) << "20 mm";
  EXPECT_EQ(grid_step_m(1000, 15), 20);
  EXPECT_EQ(grid_step_m(50, 15), 1);
  EXPECT_EQ(bar_length_m(500, 50), 20) << "40 mm";
  EXPECT_EQ(bar_length_m(200, 50), 10);
}

TEST(Sheet, NothingAndWhatIsNoNumberAreRefused) {
  Drawing drawing;
  EXPECT_NE(test::refusal_by([&] { extent_of(drawing, "a.bt"); }).find("nothing to draw"), std::string::npos);
  drawing.walls = {{{0, 0}, {std::numeric_limits<double>::quiet_NaN(), 1}}};
  EXPECT_NE(test::refusal_by([&] { extent_of(drawing, "a.bt"); }).find("not a number"), std::string::npos);
}

}  // namespace
}  // namespace karst::cave_drawing
