#include "sdk/evaluation/reachable/open_cave.h"

#include <algorithm>
#include <array>
#include <deque>
#include <optional>

#include "sdk/evaluation/reachable/outside_tiles.h"

namespace karst::evaluation {
namespace {

constexpr std::array<CellKey, 6> kSteps{
    {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};

/// Once the path is outside, it is followed to the outermost blocks in this many blocks only: 1.3e5 m^3 in
/// cells of 0.2 m. The space around a large cave is ten thousand times as much.
constexpr std::size_t kMostBlocks = std::size_t{1} << 15;

/// For each visited cell the step (1..6) that led to it, 0 if unvisited.
class Trail {
 public:
  explicit Trail(const CellSet& shape)
      : visited_(shape.first_cell({}), shape.first_cell(shape.blocks_along()) + CellKey{-1, -1, -1}) {}
  std::uint8_t& at(const CellKey& k) {
    const CellKey place = visited_.block_of(k);
    std::int32_t number = visited_.number_of(place);
    if (number < 0) {
      visited_.at(place);
      number = static_cast<std::int32_t>(steps_.size());
      steps_.emplace_back();
    }
    return steps_[static_cast<std::size_t>(number)]
                 [static_cast<std::size_t>((k.z & 7) * 64 + (k.y & 7) * 8 + (k.x & 7))];
  }
  std::size_t block_count() const { return steps_.size(); }

 private:
  CellSet visited_;  // numbers the blocks
  std::deque<std::array<std::uint8_t, 512>> steps_;
};

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
  const OutsideTiles outside(rock);
  std::optional<CellKey> first_outside;
  while (!queue.empty()) {
    end = queue.front();
    queue.pop_front();
    const CellKey place = rock.block_of(end);
    if (rock.is_outermost(place)) break;
    if (!first_outside && outside.hold(place)) first_outside = end;
    if (first_outside && trail.block_count() > kMostBlocks) {
      end = *first_outside;
      break;
    }
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
