// The roadmap of the places that are clear by one clearance, with the shortest paths home along it.
//
// There is one for the mission's usual clearance. Where the mission allows narrow passages, there is one for
// those too: it is used only when nothing else is left, or from a place inside a narrow passage.
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

  /// Keeps changes of the map for the next update: scans are far more frequent than questions.
  void note(std::span<const CellChange> changes);
  /// Takes in the changes noted. The answers below hold for `map` and `home` as they are now.
  void update(const VoxelMap& map, const Vec3& home);

  Passages passages() const { return passages_; }
  const Roadmap& roadmap() const { return roadmap_; }
  const PlanningOptions& planning() const { return roadmap_.options(); }
  double clearance_m() const { return planning().clearance_m; }

  /// Length of the shortest path home; nothing if none is known.
  std::optional<double> home_length_m(const VoxelMap& map, const Vec3& from) const;
  /// That path, to where home is approached; raw: pass it to plan_along.
  Path path_home(const VoxelMap& map, const Vec3& from) const;

 private:
  Passages passages_;
  Roadmap roadmap_;
  PathHome path_home_;
  std::vector<CellChange> noted_;
};

/// The clearance in narrow passages; nothing if the options do not allow for less than the usual.
std::optional<double> narrow_clearance_m(const PlanningOptions& options, double vehicle_radius_m);

/// The roadmap for narrow passages; it has all known cells of the map noted.
ClearanceRoadmap narrow_roadmap(const VoxelMap& map, const PlanningOptions& options, double clearance_m);

}  // namespace karst::core
