#include "sdk/evaluation/reachable/surface.h"

namespace karst::evaluation {

std::vector<CellKey> surface_cells(const Reachable& r) {
  constexpr std::array<CellKey, 6> kFaces{
      {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};
  const CellKey blocks = r.free.blocks_along();
  CellSet surface(r.free.first_cell({0, 0, 0}),
                  r.free.first_cell(blocks) + CellKey{-1, -1, -1});  // the same bounds
  r.reachable.for_each([&](const CellKey& k) {
    // Free space is everything but rock that faces lead to: what is not free beside a free cell is rock.
    for (const CellKey& face : kFaces)
      if (!r.free.contains(k + face)) surface.insert(k + face);
  });
  std::vector<CellKey> cells;
  surface.for_each([&](const CellKey& k) { cells.push_back(k); });
  return cells;
}

}  // namespace karst::evaluation
