// The empty surroundings of a cave, tile by tile, to tell at once that space leads outside.
#pragma once
#include <vector>

#include "sdk/evaluation/reachable/cell_set.h"

namespace karst::evaluation {

/// The tiles without a block of `rock` from which faces lead to the border of its bounds through such tiles
/// only. Each of their cells is 6-connected to the outermost blocks through cells that are not in `rock`.
class OutsideTiles {
 public:
  explicit OutsideTiles(const CellSet& rock);
  /// Whether a block, which must lie within the bounds, is in one of these tiles.
  bool hold(const CellKey& place) const { return outside_[index_of(CellSet::tile_of(place))]; }

 private:
  std::size_t index_of(const CellKey& t) const {
    return (static_cast<std::size_t>(t.z) * count_.y + t.y) * count_.x + t.x;
  }

  CellKey count_;
  std::vector<bool> outside_;
};

}  // namespace karst::evaluation
