#include "sdk/evaluation/reachable/open_cave.h"

#include <algorithm>
#include <deque>

namespace karst::evaluation {
namespace {

constexpr std::array<CellKey, 6> kSteps{
    {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};

/// For each visited cell the step (1..6) that led to it, 0 if unvisited.
class Trail {
 public:
  explicit Trail(const CellSet& shape) : shape_(shape) {
    const CellKey n = shape.blocks_along();
    blocks_.resize(static_cast<std::size_t>(n.x) * n.y * n.z);
  }
  std::uint8_t& at(const CellKey& k) {
    std::vector<std::uint8_t>& b = blocks_[shape_.index_of(shape_.block_of(k))];
    if (b.empty()) b.assign(512, 0);
    return b[static_cast<std::size_t>((k.z & 7) * 64 + (k.y & 7) * 8 + (k.x & 7))];
  }

 private:
  const CellSet& shape_;
  std::vector<std::vector<std::uint8_t>> blocks_;
};

bool outermost(const CellSet& shape, const CellKey& k) {
  const CellKey p = shape.block_of(k), n = shape.blocks_along();
  return p.x <= 0 || p.y <= 0 || p.z <= 0 || p.x >= n.x - 1 || p.y >= n.y - 1 || p.z >= n.z - 1;
}

/// Number of the 26 straight lines out of a cell that end at rock.
int sides_with_rock(const CellSet& rock, const CellKey& k) {
  int n = 0;
  for (int i = 0; i < 27; ++i) {
    const CellKey step{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
    if (step == CellKey{}) continue;
    for (CellKey c = k; rock.has_place(rock.block_of(c)); c = c + step)
      if (rock.contains(c)) {
        ++n;
        break;
      }
  }
  return n;
}

}  // namespace

CellKey find_opening(const CellSet& rock, const CellKey& start) {
  Trail trail(rock);
  trail.at(start) = 7;
  std::deque<CellKey> queue{start};
  CellKey end = start;
  while (!queue.empty()) {
    end = queue.front();
    queue.pop_front();
    if (outermost(rock, end)) break;
    for (std::size_t s = 0; s < kSteps.size(); ++s) {
      const CellKey next = end + kSteps[s];
      if (rock.contains(next) || trail.at(next)) continue;
      trail.at(next) = static_cast<std::uint8_t>(s + 1);
      queue.push_back(next);
    }
  }
  std::vector<CellKey> path{end};
  while (path.back() != start) {
    const CellKey& d = kSteps[trail.at(path.back()) - 1u];
    path.push_back(path.back() + CellKey{-d.x, -d.y, -d.z});
  }
  std::reverse(path.begin(), path.end());
  const auto open = std::find_if(path.begin(), path.end(), [&](const CellKey& k) {
    return sides_with_rock(rock, k) < 18;  // in the plane of a hole in a wall 17 lead out or along, 9 back in
  });
  return open == path.end() ? end : *open;
}

}  // namespace karst::evaluation
