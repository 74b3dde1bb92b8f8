// A roadmap of all places with a given clearance, and the shortest paths home along it.
//
// There is one for the mission's usual clearance. If the mission allows narrow passages, there is another one
// for these, which is used only when nothing else is left, or from inside a narrow passage.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "core_stack/homing/path_home/home.h"
#include "core_stack/planning/roadmap/roadmap.h"

namespace karst::core {

enum class Passages { usual, narrow };

class ClearanceRoadmap {
 public:
  ClearanceRoadmap(const PlanningOptions& options, Passages passages)
      : passages_(passages), roadmap_(options) {}

  /// Stores changes of the map for the next update: scans are far more frequent than queries.
  void note(std::span<const CellChange> changes);
  /// Applies the stored changes. The queries below refer to `map` and `home` as of this call.
  void update(const VoxelMap& map, const Vec3& home);

  Passages passages() const { return passages_; }
  const Roadmap& roadmap() const { return roadmap_; }
  const PlanningOptions& planning() const { return roadmap_.options(); }
  double clearance_m() const { return planning().clearance_m; }

  /// Length of the shortest path home; nothing if none is known.
  std::optional<double> home_length_m(const VoxelMap& map, const Vec3& from) const;
  /// That path, up to the approach point of home. It is raw: pass it to plan_along.
  Path path_home(const VoxelMap& map, const Vec3& from) const;

 private:
  Passages passages_;
  Roadmap roadmap_;
  PathHome path_home_;
  std::vector<CellChange> noted_;
};

/// The clearance in narrow passages; nothing if the options require the usual clearance everywhere.
std::optional<double> narrow_clearance_m(const PlanningOptions& options, double vehicle_radius_m);

/// Creates the roadmap for narrow passages, with all known cells of the map noted.
ClearanceRoadmap narrow_roadmap(const VoxelMap& map, const PlanningOptions& options, double clearance_m);

}  // namespace karst::core
