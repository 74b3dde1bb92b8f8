#include "plugins/simulator/cave_generator/generate_cave.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "plugins/simulator/cave_generator/plan.h"
#include "plugins/simulator/cave_generator/surface_net.h"

namespace karst::cave {
namespace {

constexpr double kStartClearanceM = 1.0;

/// Values set in code are checked by the same table as those of a file.
void check(const CaveRecipe& recipe) {
  CaveRecipe copy = recipe;
  core::OptionTable table;
  describe(table, copy);
  for (const auto& row : table.rows()) table.set("cave recipe", row.key, core::value_text(row));
}

Samples sample(const CavePlan& plan, double grid_m, double way_radius_m) {
  Samples s(CaveField(plan, Samples::kEdge * grid_m, way_radius_m), grid_m);
  separate_sheets(s);
  keep_one_cave(s, plan.start);
  return s;
}

/// Finds the length of passages, then the scale of their cross-sections, that give the volume wanted. Volumes
/// are measured on a grid twice as coarse as the mesh's.
CavePlan fitted_plan(const CaveRecipe& recipe, std::uint64_t seed, double way_radius_m,
                     const std::function<void(const char*, double)>& progress) {
  const double section_m2 = 0.7 * recipe.passage_width_m * recipe.passage_width_m;
  double length_m = std::max(20.0, 0.8 * recipe.volume_m3 / section_m2), scale = 1;
  CavePlan best;
  double best_error = std::numeric_limits<double>::infinity();
  constexpr int kRounds = 9;
  for (int round = 0; round < kRounds && best_error > 0.03; ++round) {
    progress("laying out passages", static_cast<double>(round) / kRounds);
    CavePlan plan = lay_out(recipe, seed, length_m, scale);
    furnish(plan, recipe, seed);
    const double ratio = hollow_volume_m3(sample(plan, 2 * recipe.grid_m, way_radius_m)) / recipe.volume_m3;
    const double error = std::abs(std::log(ratio));
    if (error < best_error) best_error = error, best = std::move(plan);
    // The length changes in steps of whole branches: near the goal the cross-sections do the rest.
    if (round < 5 && error > 0.12)
      length_m = std::clamp(length_m / std::clamp(ratio, 0.5, 2.0), 15.0, 20000.0);
    else
      scale = std::clamp(scale / std::pow(std::clamp(ratio, 0.7, 1.4), 0.6), 0.7, 1.4);
  }
  return best;
}

double least_clearance_m(const RayScene& scene, const CavePlan& plan) {
  double least = 10;
  for (const Passage& passage : plan.passages)
    for (std::size_t i = 0; i + 1 < passage.size(); ++i)
      for (int k = 0; k <= 4; ++k) {
        const core::Vec3 p = passage[i].center + 0.25 * k * (passage[i + 1].center - passage[i].center);
        least = std::min(least, scene.distance_to_rock(p, least));
      }
  return least;
}

}  // namespace

GeneratedCave generate_cave(const CaveRecipe& recipe, std::uint64_t seed,
                            const std::function<void(const char*, double)>& progress) {
  check(recipe);
  const auto tell = [&](const char* step, double share) {
    if (progress) progress(step, share);
  };
  // Meshing rounds corners off by up to half a grid step: widen the way until it is as free as promised.
  double way_radius_m = kWayClearanceM + 0.2;
  const CavePlan plan = fitted_plan(recipe, seed, way_radius_m, tell);
  for (int attempt = 0; attempt < 4; ++attempt, way_radius_m += 0.1) {
    tell("sampling rock", 0);
    const Samples samples = sample(plan, recipe.grid_m, way_radius_m);
    tell("meshing", 0);
    GeneratedCave cave;
    cave.mesh = surface_net(samples);
    tell("checking clearance", 0);
    const RayScene scene(cave.mesh);
    if (least_clearance_m(scene, plan) < kWayClearanceM ||
        scene.distance_to_rock(plan.start, 2 * kStartClearanceM) < kStartClearanceM)
      continue;
    cave.start = {plan.start, plan.start_heading_rad};
    cave.volume_m3 = enclosed_volume_m3(cave.mesh);
    for (const Passage& passage : plan.passages) {
      cave.ways.emplace_back();
      for (const Station& s : passage) cave.ways.back().push_back(s.center);
    }
    cave.boulders = plan.boulders.size();
    cave.speleothems = plan.speleothems.size();
    tell("done", 1);
    return cave;
  }
  throw std::runtime_error("cave generator: seed " + std::to_string(seed) +
                           " leaves no way with enough clearance; take another seed or a wider passage");
}

}  // namespace karst::cave
