#include "sdk/cave_drawing/free_runs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "core_stack/common/error.h"

namespace karst::cave_drawing {
namespace {

constexpr double kLeastRock_m = 0.5;

bool is_before(const Column& c, const std::pair<std::int32_t, std::int32_t>& yx) {
  return std::tie(c.y, c.x) < std::tie(yx.first, yx.second);
}

/// Free cells in columns, from below.
std::vector<Column> columns_of(const core::VoxelMap& map) {
  std::vector<core::CellKey> cells;
  map.for_each_known([&](const core::CellKey& k, core::Cell c, float) {
    if (c == core::Cell::free) cells.push_back(k);
  });
  std::sort(cells.begin(), cells.end(), [](const core::CellKey& a, const core::CellKey& b) {
    return std::tie(a.y, a.x, a.z) < std::tie(b.y, b.x, b.z);
  });
  // The most cells that are thinner than rock.
  const auto gap = static_cast<std::int32_t>(std::ceil(kLeastRock_m / map.resolution_m() - 1e-9)) - 1;
  std::vector<Column> columns;
  for (const core::CellKey& k : cells) {
    if (columns.empty() || columns.back().x != k.x || columns.back().y != k.y)
      columns.push_back({k.x, k.y, {}});
    std::vector<Run>& runs = columns.back().runs;
    if (!runs.empty() && k.z - runs.back().high - 1 <= gap)
      runs.back().high = k.z;
    else
      runs.push_back({k.z, k.z});
  }
  return columns;
}

/// Numbers the connected parts; `first` is the number of the first run of each column. Returns the part of
/// each run.
std::vector<std::int32_t> parts_of(const FreeRuns& free, const std::vector<std::size_t>& first) {
  std::vector<std::int32_t> part(first.back(), -1);
  std::vector<std::pair<std::size_t, std::size_t>> open;  // column, run in it
  std::int32_t parts = 0;
  for (std::size_t c = 0; c < free.columns.size(); ++c)
    for (std::size_t r = 0; r < free.columns[c].runs.size(); ++r) {
      if (part[first[c] + r] >= 0) continue;
      part[first[c] + r] = parts;
      open.assign(1, {c, r});
      while (!open.empty()) {
        const auto [at, run] = open.back();
        open.pop_back();
        const Column& here = free.columns[at];
        for (const auto& [dx, dy] : std::array<std::pair<int, int>, 4>{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}}) {
          const Column* beside = free.find(here.x + dx, here.y + dy);
          if (beside == nullptr) continue;
          const auto b = static_cast<std::size_t>(beside - free.columns.data());
          for (std::size_t i = 0; i < beside->runs.size(); ++i)
            if (part[first[b] + i] < 0 && beside->runs[i].touches(here.runs[run])) {
              part[first[b] + i] = parts;
              open.emplace_back(b, i);
            }
        }
      }
      ++parts;
    }
  return part;
}

}  // namespace

const Column* FreeRuns::find(std::int32_t x, std::int32_t y) const {
  const auto it = std::lower_bound(columns.begin(), columns.end(), std::pair(y, x), is_before);
  return it != columns.end() && it->x == x && it->y == y ? &*it : nullptr;
}

FreeRuns free_runs(const core::VoxelMap& map, const std::string& file) {
  FreeRuns all;
  all.cell_m = map.resolution_m();
  all.columns = columns_of(map);
  if (all.columns.empty())
    throw core::InputError(file, "", "the map has no free cell: there is nothing to draw");
  std::vector<std::size_t> first{0};
  for (const Column& c : all.columns) first.push_back(first.back() + c.runs.size());
  const std::vector<std::int32_t> part = parts_of(all, first);
  std::vector<std::size_t> size(static_cast<std::size_t>(*std::max_element(part.begin(), part.end())) + 1, 0);
  for (std::size_t c = 0; c < all.columns.size(); ++c)
    for (std::size_t r = 0; r < all.columns[c].runs.size(); ++r) {
      const Run& run = all.columns[c].runs[r];
      size[static_cast<std::size_t>(part[first[c] + r])] += static_cast<std::size_t>(run.high - run.low + 1);
    }
  const auto largest = static_cast<std::int32_t>(std::max_element(size.begin(), size.end()) - size.begin());

  FreeRuns out;
  out.cell_m = all.cell_m;
  out.low_x = out.low_y = out.low_z = std::numeric_limits<std::int32_t>::max();
  out.high_x = out.high_y = out.high_z = std::numeric_limits<std::int32_t>::min();
  for (std::size_t c = 0; c < all.columns.size(); ++c) {
    Column kept{all.columns[c].x, all.columns[c].y, {}};
    for (std::size_t r = 0; r < all.columns[c].runs.size(); ++r)
      if (part[first[c] + r] == largest) kept.runs.push_back(all.columns[c].runs[r]);
    if (kept.runs.empty()) continue;
    out.low_x = std::min(out.low_x, kept.x);
    out.high_x = std::max(out.high_x, kept.x);
    out.low_y = std::min(out.low_y, kept.y);
    out.high_y = std::max(out.high_y, kept.y);
    out.low_z = std::min(out.low_z, kept.runs.front().low);
    out.high_z = std::max(out.high_z, kept.runs.back().high);
    out.columns.push_back(std::move(kept));
  }
  return out;
}

}  // namespace karst::cave_drawing
