#include "sdk/evaluation/reachable/outside_tiles.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <set>

namespace {

using namespace karst::evaluation;

constexpr std::int32_t kBlocks = CellSet::kTileEdge, kCells = CellSet::kEdge * kBlocks;

RC_GTEST_PROP(OutsideTiles, AreThoseThatEmptyTilesJoinToTheBorder, ()) {
  const CellKey n{*rc::gen::inRange(1, 7), *rc::gen::inRange(1, 7), *rc::gen::inRange(1, 7)};
  const int percent = *rc::gen::inRange(20, 90);
  // The last tile along each axis is cut by the bounds.
  CellSet rock({0, 0, 0}, {n.x * kCells - 9, n.y * kCells - 9, n.z * kCells - 9});
  std::set<CellKey> empty, outside;
  for (CellKey t; t.z < n.z; ++t.z)
    for (t.y = 0; t.y < n.y; ++t.y)
      for (t.x = 0; t.x < n.x; ++t.x)
        if (*rc::gen::inRange(0, 100) < percent)
          rock.insert({t.x * kCells + 3, t.y * kCells + 5, t.z * kCells + 7});
        else
          empty.insert(t);
  for (bool grown = true; grown;) {
    grown = false;
    for (const CellKey& t : empty) {
      bool leads = t.x == 0 || t.y == 0 || t.z == 0 || t.x == n.x - 1 || t.y == n.y - 1 || t.z == n.z - 1;
      for (const CellKey& step : {CellKey{1, 0, 0}, CellKey{-1, 0, 0}, CellKey{0, 1, 0}, CellKey{0, -1, 0},
                                  CellKey{0, 0, 1}, CellKey{0, 0, -1}})
        leads = leads || outside.count(t + step);
      if (leads) grown |= outside.insert(t).second;
    }
  }
  const OutsideTiles tiles(rock);
  for (CellKey t; t.z < n.z; ++t.z)
    for (t.y = 0; t.y < n.y; ++t.y)
      for (t.x = 0; t.x < n.x; ++t.x) {
        RC_ASSERT(tiles.hold({t.x * kBlocks, t.y * kBlocks, t.z * kBlocks}) == (outside.count(t) > 0));
        RC_ASSERT(tiles.hold({t.x * kBlocks + 14, t.y * kBlocks + 14, t.z * kBlocks + 14}) ==
                  (outside.count(t) > 0));
      }
}

}  // namespace
