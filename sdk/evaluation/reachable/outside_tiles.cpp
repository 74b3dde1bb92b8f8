#include "sdk/evaluation/reachable/outside_tiles.h"

namespace karst::evaluation {

OutsideTiles::OutsideTiles(const CellSet& rock) : count_(rock.tiles_along()) {
  outside_.assign(static_cast<std::size_t>(count_.x) * count_.y * count_.z, false);
  std::vector<CellKey> open;
  const auto reach = [&](const CellKey& t) {
    if (t.x < 0 || t.y < 0 || t.z < 0 || t.x >= count_.x || t.y >= count_.y || t.z >= count_.z) return;
    if (outside_[index_of(t)] || rock.has_tile(t)) return;
    outside_[index_of(t)] = true;
    open.push_back(t);
  };
  const auto spread = [&] {
    while (!open.empty()) {
      const CellKey t = open.back();
      open.pop_back();
      for (const int step : {-1, 1}) {
        reach(t + CellKey{step, 0, 0});
        reach(t + CellKey{0, step, 0});
        reach(t + CellKey{0, 0, step});
      }
    }
  };
  for (CellKey t; t.z < count_.z; ++t.z)
    for (t.y = 0; t.y < count_.y; ++t.y)
      for (t.x = 0; t.x < count_.x; ++t.x) {
        if (t.x > 0 && t.y > 0 && t.z > 0 && t.x < count_.x - 1 && t.y < count_.y - 1 && t.z < count_.z - 1)
          continue;
        reach(t);
        spread();
      }
}

}  // namespace karst::evaluation
