#include "plugins/simulator/cave_generator/generate_cave.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "plugins/simulator/cave/mesh_volume.h"
#include "plugins/simulator/cave_generator/plan.h"
#include "plugins/simulator/cave_generator/surface_net.h"

namespace karst::cave {
namespace {

constexpr double kStartClearanceM = 1.0;

/// Checks values set in code by the same table as those of a file.
void check(const CaveRecipe& recipe) {
  CaveRecipe copy = recipe;
  core::OptionTable table;
  describe(table, copy);
  for (const auto& row : table.rows()) table.set("cave recipe", row.key, core::value_text(row));
}

Samples sample(const CavePlan& plan, double grid_m, double path_radius_m) {
  Samples s(CaveField(plan, Samples::kEdge * grid_m, path_radius_m), grid_m);
  separate_sheets(s);
  keep_one_cave(s, plan.start);
  return s;
}

struct Fit {
  double length_m = 0;  // of all passages
  double scale = 1;     // of their cross-sections
};

CavePlan plan_for(const CaveRecipe& recipe, std::uint64_t seed, const Fit& fit) {
  CavePlan plan = lay_out(recipe, seed, fit.length_m);
  scale_sections(plan, fit.scale);
  furnish(plan, recipe, seed);
  return plan;
}

/// The next scale when this one gave `ratio` of the target volume: an area grows with its square, but
/// passages already at their minimum width do not shrink.
double next_scale(double scale, double ratio) {
  return std::clamp(scale / std::pow(std::clamp(ratio, 0.5, 2.0), 0.55), 0.6, 1.6);
}

/// Finds the length of passages, then the scale of their cross-sections, that give the target volume: the
/// length changes in steps of whole branches, the scale corrects the remainder. Volumes are measured on a
/// coarser grid than the mesh's.
Fit fitted(const CaveRecipe& recipe, std::uint64_t seed, double path_radius_m,
           const std::function<void(const char*, double)>& progress) {
  constexpr int kRounds = 4;
  constexpr double kGoodEnough = 0.04;
  const double grid_m = std::min(0.6, 2 * recipe.grid_m);
  int measured = 0;
  const auto ratio = [&](const Fit& fit) {
    progress("laying out passages", 0.5 * measured++ / kRounds);
    return hollow_volume_m3(sample(plan_for(recipe, seed, fit), grid_m, path_radius_m)) / recipe.volume_m3;
  };
  const double section_m2 = 0.7 * recipe.passage_width_m * recipe.passage_width_m;
  Fit fit{std::max(20.0, 0.8 * recipe.volume_m3 / section_m2), 1}, best = fit;
  double best_error = std::numeric_limits<double>::infinity(), best_ratio = 1;
  const auto measure = [&] {
    const double r = ratio(fit), error = std::abs(std::log(r));
    if (error < best_error) {
      best_error = error;
      best_ratio = r;
      best = fit;
    }
    return r;
  };
  for (int round = 0; round < kRounds && best_error > 0.15; ++round)
    fit.length_m = std::clamp(fit.length_m / std::clamp(measure(), 0.5, 2.0), 15.0, 20000.0);
  for (int round = 0; round < kRounds && best_error > kGoodEnough; ++round) {
    fit = best;
    fit.scale = next_scale(fit.scale, best_ratio);
    measure();
  }
  return best;
}

double min_clearance_m(const RayScene& scene, const CavePlan& plan) {
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
  const auto tell = [&](const char* step, double fraction) {
    if (progress) progress(step, fraction);
  };
  // Meshing rounds corners off by up to half a grid step: widens the path until its clearance is reached.
  double path_radius_m = kPathClearanceM + 0.2;
  Fit fit = fitted(recipe, seed, path_radius_m, tell);
  for (int attempt = 0; attempt < 5; ++attempt) {
    tell("making rock", 0.2 * attempt);
    const CavePlan plan = plan_for(recipe, seed, fit);
    GeneratedCave cave;
    cave.mesh = surface_net(sample(plan, recipe.grid_m, path_radius_m));
    cave.volume_m3 = enclosed_volume_m3(cave.mesh);
    const double ratio = cave.volume_m3 / recipe.volume_m3, scale = next_scale(fit.scale, ratio);
    if (std::abs(ratio - 1) > 0.8 * kVolumeBand && scale != fit.scale && attempt < 3) {
      fit.scale = scale;
      continue;
    }
    tell("checking clearance", 0.9);
    const RayScene scene(cave.mesh);
    if (min_clearance_m(scene, plan) < kPathClearanceM ||
        scene.distance_to_rock(plan.start, 2 * kStartClearanceM) < kStartClearanceM) {
      path_radius_m += 0.1;
      continue;
    }
    cave.start = {plan.start, plan.start_heading_rad};
    for (const Passage& passage : plan.passages) {
      cave.axes.emplace_back();
      for (const Station& s : passage) cave.axes.back().push_back(s.center);
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
