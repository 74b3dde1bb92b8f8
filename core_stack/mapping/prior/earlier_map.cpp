#include "core_stack/mapping/prior/earlier_map.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core_stack/common/format_text.h"
#include "core_stack/mapping/registration/rock_surface.h"
#include "core_stack/mapping/registration/upright_icp.h"

namespace karst::core {
namespace {

constexpr float kSeenFree = -1, kSeenOccupied = 1;  // classes only

float log_odds_of(double probability) {
  return static_cast<float>(std::log(probability / (1 - probability)));
}

/// From a pose that may be off by most of a cell, and its neighbour's plane beyond.
FinishedPose finished(const MapPiece& earlier, const MapPiece& seen, const Pose& T_earlier_seen) {
  const double cell_m = std::max(earlier.resolution_m, seen.resolution_m);
  const Pose T =
      upright_icp(earlier, seen, T_earlier_seen, {{2.5 * cell_m, 20, 4000}, {1.5 * cell_m, 20, 4000}});
  return {T, surface_residual_m(earlier, seen, T, OverlayOptions{}.near_cells * cell_m)};
}

}  // namespace

std::shared_ptr<const EarlierMap> earlier_map_of(std::string name, std::shared_ptr<const VoxelMap> cells) {
  if (cells->occupied_cells() == 0) throw std::invalid_argument("holds no rock");
  if (cells->free_cells() == 0) throw std::invalid_argument("knows no free space");
  MapPiece piece = piece_of(std::move(cells));
  MapPiece surface = on_rock_surface(piece);
  return std::make_shared<const EarlierMap>(
      EarlierMap{std::move(name), std::move(piece), std::move(surface)});
}

std::shared_ptr<const VoxelMap> surroundings(const VoxelMap& map, const Vec3& place, double reach_m) {
  MapOptions options;
  options.resolution_m = map.resolution_m();
  auto seen = std::make_shared<VoxelMap>(options);
  const Vec3 reach = Vec3::Constant(reach_m);
  map.for_each_in_box(map.key_of(place - reach), map.key_of(place + reach), [&](const CellKey& k, Cell cell) {
    seen->assign(k, 1, cell == Cell::free ? kSeenFree : kSeenOccupied);
  });
  return seen;
}

MapRegistrationOptions localization_limits() {
  MapRegistrationOptions o;
  o.quick = {{2.0, 8, 800}, {1.0, 8, 800}};
  o.thorough = {{1.0, 15, 2000}, {0.4, 20, 4000}};
  o.finalists = 6;
  // Wrong caves reached an overlap of 0.92 and a residual of 0.75 cells (docs/results/earlier_map.md).
  o.limits.min_overlap = 0.85;
  o.limits.max_residual_cells = 0.7;
  // Rock that is seen from one place has gaps, through which rays that graze it free cells of it.
  o.overlay.free_beside = true;
  o.limits.min_agreement = 0.99;
  return o;
}

MapRegistration locate_in(const EarlierMap& earlier, std::shared_ptr<const VoxelMap> seen,
                          const MapRegistrationOptions& options) {
  if (seen->occupied_cells() == 0) {
    MapRegistration nothing;
    nothing.reason = "no rock is seen";
    return nothing;
  }
  const MapPiece piece = piece_of(std::move(seen)), surface = on_rock_surface(piece);
  MapRegistration found = register_maps(
      earlier.piece, piece, options,
      [&earlier](const MapPiece& source, const Pose& T, const std::vector<IcpRound>& rounds) {
        return upright_icp(earlier.piece, source, T, rounds);
      },
      [&earlier, &surface](const Pose& T) { return finished(earlier.surface, surface, T); });
  // All of a small earlier map may lie on what is seen: that most of what is seen lies on it counts here.
  if (const double shared = found.overlay.source_overlap();
      found.trusted && shared < options.limits.min_overlap) {
    found.trusted = false;
    found.reason = format_text(
        "only %.2f %% of the rock that is seen lies on rock of the earlier map; at least %.2f %% must",
        100 * shared, 100 * options.limits.min_overlap);
  }
  return found;
}

std::vector<CellValue> moved_cells(const EarlierMap& earlier, const Pose& T_world_earlier,
                                   const MapOptions& options) {
  const VoxelMap& from = *earlier.piece.cells;
  VoxelMap to(options);
  const float free = 2 * log_odds_of(options.miss_probability),
              occupied = log_odds_of(options.hit_probability);
  const Pose T_earlier_world = T_world_earlier.inverse();
  from.for_each_known([&](const CellKey& k, Cell cell, float) {
    const CellKey near = to.key_of(T_world_earlier * from.center_of(k));
    if (cell == Cell::occupied) to.assign(near, 1, occupied);
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const CellKey there = near + CellKey{dx, dy, dz};
          if (from.key_of(T_earlier_world * to.center_of(there)) != k) continue;
          if (cell == Cell::occupied)
            to.assign(there, 1, occupied);
          else if (to.at(there) == Cell::unknown)
            to.assign(there, 1, free);
        }
  });
  std::vector<CellValue> cells;
  cells.reserve(to.free_cells() + to.occupied_cells());
  to.for_each_known([&](const CellKey& k, Cell, float log_odds) { cells.push_back({k, log_odds}); });
  return cells;
}

}  // namespace karst::core
