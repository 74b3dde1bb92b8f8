// The cave as a signed distance field, negative in free space.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "plugins/simulator/cave_generator/shapes.h"

namespace karst::cave {

/// Divides space into cubes with the elements of the plan that matter in each. The plan must outlive it.
class CaveField {
 public:
  CaveField(const CavePlan& plan, double cube_m, double path_radius_m);

  struct Cube {
    std::vector<std::int32_t> segments, chambers, boulders, speleothems;
    bool any() const { return !segments.empty() || !chambers.empty(); }
    bool solids() const { return !boulders.empty() || !speleothems.empty(); }
  };
  /// Number of cubes along each axis. Cubes without elements, and those at the border, are solid rock.
  const std::array<std::int32_t, 3>& cubes_along() const { return count_; }
  const core::Vec3& low() const { return low_; }
  const Cube& cube(std::int32_t x, std::int32_t y, std::int32_t z) const;

  /// In metres; near the surface approximately the distance to it. `cube` contains p, or touches it.
  double value(const core::Vec3& p, const Cube& cube) const;
  double value(const core::Vec3& p) const;

  /// A value whose sign is right for all points within `radius_m` of p, or 0 if there is none.
  double value_around(const core::Vec3& p, double radius_m, const Cube& cube) const;

 private:
  struct Smooth {
    double hollow, path;  // distances to the passages' and chambers' walls, and to the nearest centre line
  };
  Smooth smooth(const core::Vec3& p, const Cube& cube) const;
  double roughness(const core::Vec3& p) const;

  const CavePlan& plan_;
  std::vector<Segment> segments_;         // passage by passage
  std::vector<std::int32_t> passage_of_;  // of each segment
  double cube_m_, path_radius_m_;
  double max_roughness_m_;  // largest displacement of a wall by roughness
  core::Vec3 low_ = core::Vec3::Zero();
  std::array<std::int32_t, 3> count_{};
  std::vector<Cube> cubes_;
};

}  // namespace karst::cave
