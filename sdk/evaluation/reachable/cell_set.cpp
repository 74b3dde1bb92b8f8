#include "sdk/evaluation/reachable/cell_set.h"

#include <deque>
#include <stdexcept>

#include "sdk/evaluation/reachable/outside_tiles.h"

namespace karst::evaluation {
namespace {

constexpr std::uint64_t kLowX = 0x0101010101010101ull, kHighX = kLowX << 7;
constexpr std::uint64_t kLowY = 0xffull, kHighY = kLowY << 56;

/// Grows `cells` by face steps within `allowed` until nothing changes.
void fill_block(CellSet::Block& cells, const CellSet::Block& allowed) {
  for (bool grown = true; grown;) {
    grown = false;
    for (std::size_t z = 0; z < 8; ++z) {
      std::uint64_t w = cells[z] | (z > 0 ? cells[z - 1] : 0) | (z < 7 ? cells[z + 1] : 0);
      w &= allowed[z];
      for (std::uint64_t before = ~w; before != w;) {
        before = w;
        w |= (w & ~kHighX) << 1 | (w & ~kLowX) >> 1 | w << 8 | w >> 8;
        w &= allowed[z];
      }
      grown |= w != cells[z];
      cells[z] = w;
    }
  }
}

/// Cells of the neighbouring block on side `side` (-x +x -y +y -z +z) that one step from `cells` reaches.
CellSet::Block stepped_over(const CellSet::Block& cells, int side) {
  CellSet::Block out{};
  for (std::size_t z = 0; z < 8; ++z) {
    switch (side) {
      case 0:
        out[z] = (cells[z] & kLowX) << 7;
        break;
      case 1:
        out[z] = (cells[z] & kHighX) >> 7;
        break;
      case 2:
        out[z] = (cells[z] & kLowY) << 56;
        break;
      case 3:
        out[z] = (cells[z] & kHighY) >> 56;
        break;
      case 4:
        out[7] = cells[0];
        break;
      default:
        out[0] = cells[7];
    }
  }
  return out;
}

constexpr std::array<std::array<int, 3>, 6> kSides{
    {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};

}  // namespace

CellSet::CellSet(const CellKey& low, const CellKey& high)
    : first_{low.x >> 3, low.y >> 3, low.z >> 3},
      count_{(high.x >> 3) - first_.x + 1, (high.y >> 3) - first_.y + 1, (high.z >> 3) - first_.z + 1},
      tiles_{(count_.x + kTileEdge - 1) / kTileEdge, (count_.y + kTileEdge - 1) / kTileEdge,
             (count_.z + kTileEdge - 1) / kTileEdge} {
  tile_numbers_.assign(static_cast<std::size_t>(tiles_.x) * tiles_.y * tiles_.z, kNoTile);
  numbers_.assign(kTilePlaces, -1);
}

std::size_t CellSet::size() const {
  std::size_t n = 0;
  for (const Block& b : blocks_)
    for (const std::uint64_t slice : b) n += static_cast<std::size_t>(std::popcount(slice));
  return n;
}

CellSet::Block& CellSet::at(const CellKey& place) {
  std::uint32_t& tile = tile_numbers_[tile_index(tile_of(place))];
  if (tile == kNoTile) {
    const std::size_t number = numbers_.size() / kTilePlaces;
    numbers_.resize(numbers_.size() + kTilePlaces, -1);
    tile = static_cast<std::uint32_t>(number);
  }
  std::int32_t& i = numbers_[tile * kTilePlaces + inside(place)];
  if (i < 0) {
    if (blocks_.size() == kMaxBlocks) throw std::length_error("too many blocks of cells");
    blocks_.push_back({});
    i = static_cast<std::int32_t>(blocks_.size() - 1);
  }
  return blocks_[static_cast<std::size_t>(i)];
}

namespace {

enum class Filled { set, complement };

/// None if the complement extends to the outermost blocks.
std::optional<CellSet> flooded(const CellSet& set, Filled what, const CellKey& seed) {
  const bool complement = what == Filled::complement;
  const CellKey n = set.blocks_along();
  CellSet filled(set.first_cell({0, 0, 0}), set.first_cell({n.x - 1, n.y - 1, n.z - 1}));
  const auto allowed = [&](const CellKey& place) {
    CellSet::Block b{};
    if (const auto* found = set.find(place)) b = *found;
    if (complement)
      for (std::uint64_t& slice : b) slice = ~slice;
    return b;
  };
  if (!set.has_place(set.block_of(seed)) || set.contains(seed) == complement) return filled;
  std::optional<OutsideTiles> outside;
  if (complement) outside.emplace(set);
  filled.insert(seed);
  std::deque<CellKey> queue{set.block_of(seed)};
  std::vector<bool> queued{true};  // for each block of `filled`
  const auto is_queued = [&](const CellKey& place) {
    return queued[static_cast<std::size_t>(filled.number_of(place))];
  };
  while (!queue.empty()) {
    const CellKey place = queue.front();
    queue.pop_front();
    is_queued(place) = false;
    if (outside && (set.is_outermost(place) || outside->hold(place))) return std::nullopt;
    CellSet::Block& grown = filled.at(place);
    fill_block(grown, allowed(place));
    const CellSet::Block cells = grown;
    for (int side = 0; side < 6; ++side) {
      const auto& d = kSides[static_cast<std::size_t>(side)];
      const CellKey next = place + CellKey{d[0], d[1], d[2]};
      if (!set.has_place(next)) continue;
      CellSet::Block arriving = stepped_over(cells, side);
      const CellSet::Block open = allowed(next);
      bool any = false;
      for (std::size_t z = 0; z < 8; ++z) any |= (arriving[z] &= open[z]) != 0;
      if (!any) continue;
      CellSet::Block& there = filled.at(next);
      if (queued.size() < filled.block_count()) queued.push_back(false);
      bool fresh = false;
      for (std::size_t z = 0; z < 8; ++z) {
        fresh |= (arriving[z] & ~there[z]) != 0;
        there[z] |= arriving[z];
      }
      if (!fresh || is_queued(next)) continue;
      is_queued(next) = true;
      queue.push_back(next);
    }
  }
  return filled;
}

}  // namespace

CellSet flood(const CellSet& set, const CellKey& seed) { return *flooded(set, Filled::set, seed); }

std::optional<CellSet> flood_between(const CellSet& set, const CellKey& seed) {
  return flooded(set, Filled::complement, seed);
}

}  // namespace karst::evaluation
