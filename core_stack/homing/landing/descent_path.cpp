#include "core_stack/homing/landing/descent_path.h"

#include <array>
#include <cmath>
#include <numbers>

#include "core_stack/homing/landing/landing_ground.h"
#include "core_stack/planning/search/grid_planner.h"

namespace karst::core {
namespace {

constexpr double kFarthest_m = 4, kRing_m = 0.5;
constexpr double kNearlyThere_m = 2;  // from its landing site: then preferred over any other ground
constexpr int kDirections = 16;
constexpr double kBesideHull_m = 0.15;  // kept free on both sides of the line, and in the column below it

/// Limits of the ground, from those of a landing site to ground that just holds a vehicle: 50 deg topples it.
constexpr std::array kGround{
    GroundOptions{.margin_m = kBesideHull_m, .max_slope_deg = 15, .max_step_m = 0.25, .max_drop_m = 20},
    GroundOptions{.margin_m = kBesideHull_m, .max_slope_deg = 30, .max_step_m = 0.4, .max_drop_m = 20}};

class Search {
 public:
  Search(const VoxelMap& map, const DescentQuery& query) : map_(map), query_(query) {}

  std::vector<Vec3> find() const {
    if (query_.landing_hover && (*query_.landing_hover - query_.from).norm() < kNearlyThere_m &&
        clear_to(*query_.landing_hover))
      return {query_.from, *query_.landing_hover};
    for (const GroundOptions& ground : kGround) {
      if (fit(query_.from, ground)) return {query_.from};
      if (auto path = straight(ground); !path.empty()) return path;
      if (auto path = back(ground); !path.empty()) return path;
    }
    return {};
  }

 private:
  bool fit(const Vec3& place, const GroundOptions& ground) const {
    return ground_below(map_, place, query_.vehicle_radius_m, ground).verdict == GroundVerdict::good;
  }

  bool clear_to(const Vec3& place) const {
    return segment_clear(map_, query_.from, place, query_.vehicle_radius_m + kBesideHull_m);
  }

  std::vector<Vec3> straight(const GroundOptions& ground) const {
    for (double r = kRing_m; r <= kFarthest_m; r += kRing_m) {
      for (int i = 0; i < kDirections; ++i) {
        const double angle = 2 * std::numbers::pi * i / kDirections;
        const Vec3 place = query_.from + r * Vec3(std::cos(angle), std::sin(angle), 0);
        if (fit(place, ground) && clear_to(place)) return {query_.from, place};
      }
    }
    return {};
  }

  std::vector<Vec3> back(const GroundOptions& ground) const {
    std::vector<Vec3> path{query_.from};
    for (const Vec3& pose : query_.flown_back) {
      path.push_back(pose);
      if (fit(pose, ground)) return path;
    }
    return {};
  }

  const VoxelMap& map_;
  const DescentQuery& query_;
};

}  // namespace

std::vector<Vec3> descent_path(const VoxelMap& map, const DescentQuery& query) {
  return Search(map, query).find();
}

}  // namespace karst::core
