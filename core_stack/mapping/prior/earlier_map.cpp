#include "core_stack/mapping/prior/earlier_map.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "core_stack/common/format_text.h"
#include "core_stack/mapping/registration/upright_icp.h"

namespace karst::core {
namespace {

constexpr float kSeenFree = -1, kSeenOccupied = 1;  // classes only

float log_odds_of(double probability) {
  return static_cast<float>(std::log(probability / (1 - probability)));
}

}  // namespace

std::shared_ptr<const EarlierMap> earlier_map_of(std::string name, std::shared_ptr<const VoxelMap> cells) {
  if (cells->occupied_cells() == 0) throw std::invalid_argument("holds no rock");
  if (cells->free_cells() == 0) throw std::invalid_argument("knows no free space");
  return std::make_shared<const EarlierMap>(EarlierMap{std::move(name), piece_of(std::move(cells))});
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
  return o;
}

MapRegistration locate_in(const EarlierMap& earlier, std::shared_ptr<const VoxelMap> seen,
                          const MapRegistrationOptions& options) {
  if (seen->occupied_cells() == 0) {
    MapRegistration nothing;
    nothing.reason = "no rock is seen";
    return nothing;
  }
  MapRegistration found =
      register_maps(earlier.piece, piece_of(std::move(seen)), options,
                    [&earlier](const MapPiece& source, const Pose& T, const std::vector<IcpRound>& rounds) {
                      return upright_icp(earlier.piece, source, T, rounds);
                    });
  // All of a small earlier map may lie on what is seen: that most of what is seen lies on it counts here.
  if (const double shared = found.overlay.source_overlap();
      found.trusted && shared < options.limits.min_overlap) {
    found.trusted = false;
    found.reason =
        format_text("only %.0f %% of the rock that is seen lies on rock of the earlier map", 100 * shared);
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
