// Procedural caves: the same recipe and seed give the same mesh, to the byte.
#pragma once
#include <functional>

#include "plugins/simulator/cave/cave.h"
#include "plugins/simulator/cave_generator/recipe.h"

namespace karst::cave {

struct GeneratedCave {
  TriangleMesh mesh;     // one closed surface, normals into the cave
  StartPose start;       // in the entrance chamber over level ground, at least 1 m from rock
  double volume_m3 = 0;  // enclosed by the mesh
  std::vector<std::vector<core::Vec3>> axes;  // centre lines, each at least kPathClearanceM from rock
  std::size_t boulders = 0, speleothems = 0;
};

constexpr double kPathClearanceM = 0.6;
/// Largest relative deviation from the recipe's volume, unless its chambers and shafts alone have more.
constexpr double kVolumeBand = 0.15;

/// Calls `progress(step, fraction done)` as it goes on. Throws InputError if a value of the recipe is out of
/// its range.
GeneratedCave generate_cave(const CaveRecipe& recipe, std::uint64_t seed,
                            const std::function<void(const char*, double)>& progress = {});

}  // namespace karst::cave
