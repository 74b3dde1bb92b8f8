// Experiences by formula, for tests.
#pragma once
#include <cmath>

#include "core_stack/common/random.h"
#include "sdk/selection/experience.h"

namespace karst::test {

/// A cave whose every figure follows from two numbers: how large and how steep it is.
inline selection::CaveFigures cave_figures(double log_size, double steepness) {
  selection::CaveFigures f;
  f.volume_m3 = 5000 * std::exp(log_size);
  f.length_m = 300 * std::exp(log_size / 3);
  f.width_m = 4 * std::exp(log_size / 3);
  f.width_spread = 2;
  f.height_m = f.width_m;
  f.drop_m = 10 + 100 * steepness;
  f.verticality = steepness;
  f.branching = 3;
  f.loops = 1;
  f.tortuosity = 1.5;
  return f;
}

inline selection::Condition condition(const std::string& vehicle = "lidar_uav", double endurance_s = 300) {
  selection::Condition c;
  c.horizon_s = c.endurance_s = endurance_s;
  c.vehicle = vehicle;
  c.profile = "campaign";
  c.mission = {{"simulator.vehicle", vehicle}, {"motion.max_speed", "1.5 m/s"}};
  complete(c, "", "test");
  return c;
}

/// `n` caves of various sizes and slopes. "steep" does well in steep caves, "level" in level ones, "both" is
/// never best but never bad either; `crossing` is how much they differ, `noise` of each mean.
inline selection::Experience experience(int n, double crossing, double noise, std::uint64_t seed) {
  core::Random random(seed);
  selection::Experience e;
  e.conditions = {condition()};
  for (const char* name : {"steep", "level", "both"}) e.contestants.push_back({name, name, "1.0.0", {}});
  e.contestants[0].parameters.put("reach", "3 m");
  std::vector<double> steepness;
  for (int c = 0; c < n; ++c) {
    steepness.push_back(random.uniform(0.0, 0.8));
    e.caves.push_back({"cave" + std::to_string(c), cave_figures(random.uniform(-1, 1), steepness.back())});
  }
  lay_out(e, all_sites(e));
  for (std::size_t c = 0; c < e.caves.size(); ++c) {
    const double s = (steepness[c] - 0.4) / 0.4, level = random.uniform(0.4, 0.6);
    const double advantage[] = {crossing * s, -crossing * s, -0.15 * crossing};
    for (std::size_t k = 0; k < 3; ++k)
      e.at(k, c, 0) = {10, level * (1 + advantage[k] + noise * random.normal()), 0.01};
  }
  return e;
}

}  // namespace karst::test
