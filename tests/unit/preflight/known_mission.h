// A mission of which everything is known, and against which nothing speaks.
#pragma once
#include "sdk/preflight/preflight.h"

namespace karst::test {

inline preflight::CaveFacts roomy_cave() {
  preflight::CaveFacts c;
  c.figures.volume_m3 = 2100;
  c.figures.length_m = 210;
  c.figures.width_m = 2.4;
  c.figures.drop_m = 12;
  c.figures.verticality = 0.1;
  c.figures.branching = 3;
  c.figures.loops = 1;
  c.passages.width_m = {2.5, 4, 7};
  c.passages.height_m = {2, 3.5, 6};
  c.start = core::Vec3(1, 2, 1.5);
  c.start_clearance_m = 1.2;
  c.explorable_m3 = c.reachable_m3 = c.hull_reachable_m3 = 2000;
  c.plan.edge_m = 0.5;
  c.plan.runs = {{0, 0, 40}, {0, 1, 40}, {10, 2, 4}};
  c.plan.start = c.start;
  return c;
}

inline preflight::PolicyFacts sure_policy() {
  preflight::PolicyFacts p;
  p.policy = "deep_cave";
  p.parameters.emplace_back("horizon", "60 m");
  p.selected = true;
  p.reason = "deep_cave is expected to do best";
  p.metric = "coverage_auc";
  p.confidence = 0.8;
  p.confidence_words = "first in 80 % of 1000 resamplings of the earlier flights";
  p.horizon_s = 480;
  p.ranking = {{"deep_cave", 0.7, 0.6, 0.8}, {"nearest", 0.6, 0.5, 0.7}};
  p.own = 0;
  p.expected = {{"coverage", "", 0.95}, {"explored_volume_m3", "m^3", 1900}, {"flight_time_s", "s", 400}};
  return p;
}

inline preflight::Preflight known_mission() {
  preflight::Preflight p;
  p.cave_file = "caves/demo.info";
  p.vehicle = preflight::VehicleFacts{"lidar_uav", 0.3, 0.55, 1.5, 1.4};
  p.cave = roomy_cave();
  preflight::TimeLimits limits;
  limits.battery_s = 480;
  p.time = preflight::time_budget(limits, 100);
  p.policy = sure_policy();
  return p;
}

}  // namespace karst::test
