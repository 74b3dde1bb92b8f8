#include "sdk/cave_drawing/cell_mask.h"

#include <gtest/gtest.h>

#include "tests/unit/cave_drawing/drawn_lines.h"

namespace karst::cave_drawing {
namespace {

CellMask box_of(int width, int height) {
  CellMask mask("test", 0, 0, 19, 19);
  for (int y = 2; y < 2 + height; ++y)
    for (int x = 2; x < 2 + width; ++x) mask.set(x, y);
  return mask;
}

TEST(CellMask, AnOpeningKeepsWhatIsTwoCellsWideAndTakesWhatIsOneCellThin) {
  CellMask mask = box_of(5, 2);
  EXPECT_EQ(opened(mask).count(), 10u);
  for (int x = 7; x < 15; ++x) mask.set(x, 3);  // as a ray through a crack leaves it
  EXPECT_EQ(opened(mask).count(), 10u);
}

TEST(CellMask, SmallPiecesAndSmallHolesGoAndLargeOnesStay) {
  CellMask mask = box_of(10, 10);
  mask.set(4, 4, false);                               // a hole of one cell
  for (int x = 7; x < 10; ++x) mask.set(x, 8, false);  // one of three
  mask.set(16, 16), mask.set(17, 16);                  // a piece of two
  EXPECT_EQ(without_specks(mask, 3).count(), 97u);
  EXPECT_EQ(without_specks(mask, 4).count(), 100u);
  EXPECT_EQ(without_specks(mask, 1).count(), mask.count());
}

TEST(CellMask, TooManyCellsAndNoneAreRefused) {
  EXPECT_NE(test::refusal_by([] { CellMask("a.bt", 0, 0, 1'000'000, 1'000'000); }).find("a.bt"),
            std::string::npos);
  EXPECT_NE(test::refusal_by([] { CellMask("a.bt", 1, 0, 0, 0); }).find("nothing to draw"),
            std::string::npos);
}

}  // namespace
}  // namespace karst::cave_drawing
