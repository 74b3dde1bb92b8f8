#include "core_stack/planning/search/grid_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core_stack/planning/search/search_heap.h"

namespace karst::core {
namespace {

constexpr std::uint8_t kRoot = 26;  // a start cell, which has no parent
constexpr std::uint8_t kClosed = 128;
constexpr std::uint32_t kGoal = ~std::uint32_t{0};

struct Move {
  std::int8_t dx, dy, dz;
  float cost;
};

std::array<Move, 26> all_moves() {
  std::array<Move, 26> out{};
  std::size_t n = 0;
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (dx != 0 || dy != 0 || dz != 0)
          out[n++] = {static_cast<std::int8_t>(dx), static_cast<std::int8_t>(dy),
                      static_cast<std::int8_t>(dz),
                      static_cast<float>(std::sqrt(dx * dx + dy * dy + dz * dz))};
  return out;
}

struct SearchTile {
  TileBits clear;
  CellKey corner;
  std::array<float, kTileCells> cost;
  std::array<std::uint32_t, kTileCells> place;  // index in the heap
  std::array<std::uint8_t, kTileCells>
      parent;  // index of the move that led here, or kRoot; kClosed when final
};

class Search {
 public:
  Search(const VoxelMap& map, FreeTiles& free, const ClearanceRule& rule, const GridQuery& query)
      : map_(map), free_(free), rule_(rule), query_(query), weight_(static_cast<float>(query.weight)) {}

  GridSearchResult run() {
    for (const CellKey& k : query_.starts)
      reach(tile_at(tile_of(k)), k, static_cast<float>(octile_cells(Vec3(k.x, k.y, k.z) - query_.from)),
            kRoot);
    GridSearchResult result;
    while (!heap_.empty()) {
      const OpenNode top = heap_.pop();
      if (top.node == kGoal) {
        result.end = GridSearchResult::End::found;
        result.cells = trace();
        return result;
      }
      SearchTile& tile = *tiles_[top.node / kTileCells];
      tile.parent[top.node % kTileCells] |= kClosed;
      if (++result.expansions > query_.max_expansions) {
        result.end = GridSearchResult::End::gave_up;
        return result;
      }
      expand(top);
    }
    return result;
  }

 private:
  std::uint32_t tile_at(const TileKey& t) {
    std::uint32_t i = table_.find(t);
    if (i != TileTable::none) return i;
    i = table_.add(t);
    tiles_.push_back(std::make_unique<SearchTile>());
    SearchTile& tile = *tiles_.back();
    tile.corner = corner_of(t);
    const CellKey margin{16, rule_.extent(), rule_.extent()};
    const CellKey far = tile.corner + CellKey{kTileX - 1, kTileY - 1, kTileZ - 1};
    free_.load(map_, {tile.corner.x - margin.x, tile.corner.y - margin.y, tile.corner.z - margin.z},
               far + margin);
    tile.clear = free_.clear_cells(t, rule_);
    tile.cost.fill(std::numeric_limits<float>::infinity());
    tile.parent.fill(0);
    tile.place.fill(0);
    return i;
  }

  float to_go(const CellKey& k) const {
    return static_cast<float>(octile_cells(query_.to - Vec3(k.x, k.y, k.z)));
  }

  void reach(std::uint32_t tile_index, const CellKey& k, float cost, std::uint8_t by) {
    SearchTile& tile = *tiles_[tile_index];
    const std::uint32_t i = index_in_tile(k);
    if (!(tile.clear[i >> 5] >> (i & 31) & 1) || tile.parent[i] & kClosed || cost >= tile.cost[i]) return;
    tile.cost[i] = cost;
    tile.parent[i] = by;
    heap_.push_or_lower({cost + weight_ * to_go(k), cost, tile_index * kTileCells + i});
  }

  void expand(const OpenNode& at) {
    static const std::array<Move, 26> moves = all_moves();
    const std::uint32_t here = at.node / kTileCells;
    const TileKey home = table_.keys()[here];
    const CellKey k = cell_in_tile(tiles_[here]->corner, at.node % kTileCells);
    const float cost = tiles_[here]->cost[at.node % kTileCells];
    const std::vector<CellKey>& goals = query_.goals;
    if (std::find(goals.begin(), goals.end(), k) != goals.end() && cost + to_go(k) < goal_cost_) {
      goal_cost_ = cost + to_go(k);
      goal_cell_ = k;
      heap_.push_or_lower({goal_cost_, goal_cost_, kGoal});
    }
    for (std::uint8_t m = 0; m < std::uint8_t{moves.size()}; ++m) {
      const CellKey n = k + CellKey{moves[m].dx, moves[m].dy, moves[m].dz};
      const TileKey t = tile_of(n);
      reach(t == home ? here : tile_at(t), n, cost + moves[m].cost, m);
    }
  }

  std::vector<CellKey> trace() const {
    static const std::array<Move, 26> moves = all_moves();
    std::vector<CellKey> out{goal_cell_};
    for (;;) {
      const CellKey& k = out.back();
      const std::uint8_t by = tiles_[table_.find(tile_of(k))]->parent[index_in_tile(k)] & 127;
      if (by == kRoot) break;
      out.push_back(k + CellKey{-moves[by].dx, -moves[by].dy, -moves[by].dz});
    }
    std::reverse(out.begin(), out.end());
    return out;
  }

  const VoxelMap& map_;
  FreeTiles& free_;
  const ClearanceRule& rule_;
  const GridQuery& query_;
  float weight_;
  TileTable table_;
  std::vector<std::unique_ptr<SearchTile>> tiles_;
  struct HeapIndexOf {  // node: tile index * kTileCells + index in tile, or kGoal
    Search* search;
    std::uint32_t& operator()(std::uint32_t node) const {
      return node == kGoal ? search->goal_place_
                           : search->tiles_[node / kTileCells]->place[node % kTileCells];
    }
  };
  SearchHeap<HeapIndexOf> heap_{HeapIndexOf{this}};
  std::uint32_t goal_place_ = 0;
  float goal_cost_ = std::numeric_limits<float>::infinity();
  CellKey goal_cell_;
};

}  // namespace

double octile_cells(const Vec3& displacement) {
  const Vec3 d = displacement.cwiseAbs();
  const double most = d.maxCoeff(), least = d.minCoeff(), middle = d.sum() - most - least;
  return (most - middle) + std::numbers::sqrt2 * (middle - least) + std::numbers::sqrt3 * least;
}

GridSearchResult search_grid(const VoxelMap& map, FreeTiles& free, const ClearanceRule& rule,
                             const GridQuery& query) {
  return Search(map, free, rule, query).run();
}

}  // namespace karst::core
