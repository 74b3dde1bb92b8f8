#include "sdk/cave_drawing/map_plan.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include "sdk/cave_drawing/smooth_line.h"
#include "sdk/cave_drawing/wall_trace.h"

namespace karst::cave_drawing {
namespace {

constexpr double kLeastPiece_m2 = 0.2;  // of the outline: smaller ones are gaps between rays
constexpr double kLeastWall_m = 3.0;    // within the outline: shorter ones are ledges
constexpr double kLeastStorey_m2 = 3.0;
constexpr double kSimplified = 0.08;  // cells
constexpr int kWallCells = 2;         // beside free cells: rock no farther away is their wall
constexpr double kLeastRock = 0.3;    // of a wall's height: less is the floor that goes on, or the roof

using RunName = std::tuple<std::int32_t, std::int32_t, std::size_t>;  // y, x, number from below

bool is_joined(const Run& run, const Column* beside) {
  return beside != nullptr && std::any_of(beside->runs.begin(), beside->runs.end(),
                                          [&](const Run& other) { return other.touches(run); });
}

/// The runs below others, in connected pieces of a storey's size.
std::set<RunName> storeys_below(const FreeRuns& free) {
  std::set<RunName> seen, kept;
  const double cell_m2 = free.cell_m * free.cell_m;
  for (const Column& column : free.columns)
    for (std::size_t r = 0; r + 1 < column.runs.size(); ++r) {
      if (!seen.insert({column.y, column.x, r}).second) continue;
      std::vector<RunName> piece{{column.y, column.x, r}};
      for (std::size_t i = 0; i < piece.size(); ++i) {
        const auto [y, x, number] = piece[i];
        const Run run = free.find(x, y)->runs[number];
        for (std::size_t side = 0; side < 4; ++side) {
          const Column* beside = free.find(x + kBesideX[side], y + kBesideY[side]);
          if (beside == nullptr) continue;
          for (std::size_t other = 0; other + 1 < beside->runs.size(); ++other)
            if (beside->runs[other].touches(run) && seen.insert({beside->y, beside->x, other}).second)
              piece.emplace_back(beside->y, beside->x, other);
        }
      }
      if (static_cast<double>(piece.size()) * cell_m2 >= kLeastStorey_m2)
        kept.insert(piece.begin(), piece.end());
    }
  return kept;
}

void add_walls(const std::vector<CellSide>& sides, double cell_m, std::vector<Line>& walls) {
  for (const Line& line : joined(sides))
    if (static_cast<double>(line.size() - 1) * cell_m >= kLeastWall_m)
      walls.push_back(scaled(simplified(smoothed(line), kSimplified), cell_m));
}

/// Whether enough of the height of a column's runs has rock on this side.
bool has_rock_beside(const FreeRuns& free, const core::VoxelMap& map, int x, int y, std::size_t side) {
  const Column* column = free.find(x, y);
  if (column == nullptr) return true;  // a gap that was closed
  int cells = 0, rock = 0;
  for (const Run& run : column->runs)
    for (std::int32_t z = run.low; z <= run.high; ++z) {
      ++cells;
      for (int out = 1; out <= kWallCells; ++out)
        if (map.at(core::CellKey{x + out * kBesideX[side], y + out * kBesideY[side], z}) ==
            core::Cell::occupied) {
          ++rock;
          break;
        }
    }
  return rock >= kLeastRock * cells;
}

/// The same side, seen from either cell.
std::pair<std::pair<int, int>, bool> place_of(const CellSide& s) {
  const bool upright = s.heading % 2 == 1;
  return {{s.x - (s.heading == 2 ? 1 : 0), s.y - (s.heading == 3 ? 1 : 0)}, upright};
}

}  // namespace

CellMask mask_from_above(const FreeRuns& free, const std::string& file) {
  CellMask mask(file, free.low_x, free.low_y, free.high_x, free.high_y);
  for (const Column& c : free.columns) mask.set(c.x, c.y);
  return mask;
}

IsWallKnown known_by(const CellMask& rock) {
  return [&rock](int x, int y, std::size_t side) {
    for (int out = 1; out <= kWallCells; ++out)
      if (rock.at(x + out * kBesideX[side], y + out * kBesideY[side])) return true;
    return false;
  };
}

void draw_mask(const CellMask& mask, double cell_m, Drawing& drawing, const IsWallKnown& is_known) {
  const auto least = static_cast<std::size_t>(std::ceil(kLeastPiece_m2 / (cell_m * cell_m)));
  std::vector<Line> rings;
  for (const Line& ring : outlines_of(without_specks(opened(mask), least))) {
    add_ring_walls(ring, cell_m, is_known, drawing);
    rings.push_back(scaled(simplified(smoothed(ring), kSimplified), cell_m));
  }
  if (!rings.empty()) drawing.spaces.push_back(std::move(rings));
}

Drawing plan_of(const FreeRuns& free, const std::string& file, const core::VoxelMap* map) {
  Drawing plan;
  plan.view = View::plan;
  const CellMask mask = opened(mask_from_above(free, file));
  IsWallKnown is_known;
  if (map != nullptr)
    is_known = [&](int x, int y, std::size_t side) { return has_rock_beside(free, *map, x, y, side); };
  draw_mask(mask, free.cell_m, plan, is_known);
  const std::set<RunName> below = storeys_below(free);
  std::vector<CellSide> above, hidden;
  std::set<std::pair<std::pair<int, int>, bool>> drawn;
  for (const Column& c : free.columns) {
    if (!mask.at(c.x, c.y)) continue;
    for (std::uint8_t side = 0; side < 4; ++side) {
      const int bx = c.x + kBesideX[side], by = c.y + kBesideY[side];
      if (!mask.at(bx, by) || is_joined(c.runs.back(), free.find(bx, by))) continue;
      const CellSide wall = side_of(c.x, c.y, side);
      if (drawn.insert(place_of(wall)).second) above.push_back(wall);
    }
  }
  for (const RunName& name : below) {
    const auto [y, x, number] = name;
    if (!mask.at(x, y)) continue;
    const Run run = free.find(x, y)->runs[number];
    for (std::uint8_t side = 0; side < 4; ++side) {
      const int bx = x + kBesideX[side], by = y + kBesideY[side];
      if (!mask.at(bx, by) || is_joined(run, free.find(bx, by))) continue;
      const CellSide wall = side_of(x, y, side);
      if (!drawn.contains(place_of(wall))) hidden.push_back(wall);
    }
  }
  add_walls(above, free.cell_m, plan.walls);
  add_walls(hidden, free.cell_m, plan.hidden_walls);
  return plan;
}

}  // namespace karst::cave_drawing
