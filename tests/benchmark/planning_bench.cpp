// How long planning takes, in synthetic winding caves, next to plain ways of doing the same. Processor time,
// so that other work on the machine counts little.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <queue>
#include <unordered_map>

#include "core_stack/mapping/obstacles/obstacle_tree.h"
#include "core_stack/planning/free_space/free_tiles.h"
#include "core_stack/planning/path/refine.h"
#include "core_stack/planning/planner.h"
#include "core_stack/planning/search/grid_planner.h"
#include "core_stack/planning/trajectory/polynomial_trajectory.h"
#include "core_stack/planning/trajectory/trajectory.h"
#include "tests/benchmark/times.h"
#include "tests/unit/planning/test_maps.h"

namespace karst::core {
namespace {

using bench::cpu_ms;
using bench::Times;
using testing::WindingCave;

/// A* as a textbook has it: hash maps, and each cell's clearance asked of `clear`, once.
template <class Clear>
double plain_a_star(const VoxelMap& map, const Vec3& start, const Vec3& goal, Clear&& clear) {
  std::unordered_map<CellKey, double, CellKeyHash> cost;
  std::unordered_map<CellKey, bool, CellKeyHash> known;
  const auto usable = [&](const CellKey& k) {
    const auto it = known.find(k);
    if (it != known.end()) return it->second;
    return known[k] = map.at(k) == Cell::free && clear(map.center_of(k));
  };
  const CellKey from = map.key_of(start), to = map.key_of(goal);
  using Entry = std::tuple<double, double, CellKey>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  cost[from] = 0;
  open.push({0, 0, from});
  while (!open.empty()) {
    const auto [f, g, k] = open.top();
    open.pop();
    if (g > cost[k]) continue;
    if (k == to) return g;
    for (int m = 0; m < 27; ++m) {
      const CellKey n = k + CellKey{m % 3 - 1, m / 3 % 3 - 1, m / 9 - 1};
      if (!usable(n)) continue;
      const double c = g + (map.center_of(n) - map.center_of(k)).norm();
      const auto it = cost.find(n);
      if (it != cost.end() && it->second <= c) continue;
      cost[n] = c;
      open.push({c + (map.center_of(to) - map.center_of(n)).norm(), c, n});
    }
  }
  return -1;
}

void paths(double length_m, int caves, int plans_a_cave, bool compare) {
  std::printf("\npaths of %.0f m\n", length_m);
  Times whole, find, refine, grid, grid_optimal, brute, kd_tree, trajectory, polynomial;
  double whole_m = 0, optimal_m = 0, plain_m = 0, speed = 0, polynomial_speed = 0;
  int failed = 0, fell_back = 0, rounds = 0;
  const PlanningOptions options;
  PlanningOptions optimal = options;
  optimal.heuristic_weight = 1.0;
  optimal.max_expansions = 10000000;
  for (int c = 0; c < caves; ++c) {
    const WindingCave cave = WindingCave::of_length(length_m + 12, static_cast<std::uint64_t>(c + 1));
    std::vector<CellChange> changes;
    const VoxelMap map = cave.map(&changes);
    Roadmap roadmap(options);
    roadmap.update(map, changes);
    for (int i = 0; i < plans_a_cave; ++i) {
      const Vec3 a = cave.line[static_cast<std::size_t>(2 + i)];
      const Vec3 b = cave.line[static_cast<std::size_t>(2 + i) + static_cast<std::size_t>(2 * length_m)];
      Path path, raw;
      whole.ms.push_back(cpu_ms([&] { path = plan(map, roadmap, a, b, options); }));
      if (!path.found()) {
        ++failed;
        continue;
      }
      find.ms.push_back(cpu_ms([&] { raw = roadmap.find(map, a, b); }));
      refine.ms.push_back(cpu_ms([&] { refine_path(map, raw.points, options); }));
      trajectory.ms.push_back(cpu_ms([&] {
        speed += path.length_m /
                 seconds(sample_trajectory(path.points, 0, 0, MotionLimits{}, HeadingPlan{}).end());
      }));
      polynomial.ms.push_back(cpu_ms([&] {
        const PolynomialTrajectory t = polynomial_trajectory(
            path.points, {}, 0, MotionLimits{}, HeadingPlan{}, [&](const Vec3& from, const Vec3& to) {
              return segment_clear(map, from, to, options.clearance_m);
            });
        polynomial_speed += path.length_m / seconds(t.trajectory.end());
        rounds += t.rounds;
        if (!t.fell_back.empty()) ++fell_back;
      }));
      grid.ms.push_back(cpu_ms([&] { plan_on_grid(map, a, b, options); }));
      if (!compare || i > 0) continue;
      Path best;
      grid_optimal.ms.push_back(cpu_ms([&] { best = plan_on_grid(map, a, b, optimal); }));
      whole_m += path.length_m, optimal_m += best.length_m;
      brute.ms.push_back(cpu_ms([&] {
        plain_m +=
            plain_a_star(map, a, b, [&](const Vec3& p) { return is_clear(map, p, options.clearance_m); });
      }));
      kd_tree.ms.push_back(cpu_ms([&] {
        Vec3 low = a, high = a;
        for (const Vec3& p : cave.line) low = low.cwiseMin(p), high = high.cwiseMax(p);
        const ObstacleTree tree(map, low - Vec3::Constant(6), high + Vec3::Constant(6));
        plain_a_star(map, a, b, [&](const Vec3& p) { return !tree.any_within(p, options.clearance_m); });
      }));
    }
  }
  whole.print("plan(): search, refine, last look");
  find.print("  of which search on the roadmap");
  refine.print("  of which refining");
  trajectory.print("sample_trajectory");
  polynomial.print("polynomial_trajectory");
  grid.print("plan_on_grid, weight 1.2, tiles of bits");
  grid_optimal.print("plan_on_grid, weight 1");
  brute.print("plain A*, clearance from 100 look-ups a cell");
  kd_tree.print("plain A*, clearance from the KD-tree");
  std::printf("  not found: %d; mean speed along the trajectories %.2f m/s\n", failed,
              speed / static_cast<double>(std::max<std::size_t>(1, trajectory.ms.size())));
  std::printf("  polynomials: %.2f m/s, %.1f rounds, %d of %zu fell back to sampling\n",
              polynomial_speed / static_cast<double>(std::max<std::size_t>(1, polynomial.ms.size())),
              rounds / static_cast<double>(std::max<std::size_t>(1, polynomial.ms.size())), fell_back,
              polynomial.ms.size());
  if (compare && optimal_m > 0)
    std::printf(
        "  plan() is %.3f as long as the shortest way on the grid; plain A* (KD-tree) takes %.1f times as "
        "long\n",
        whole_m / optimal_m, kd_tree.at(0.5) / whole.at(0.5));
}

void feasibility() {
  std::printf("\nclearance of every free cell in a cave, ns a cell\n");
  const WindingCave cave = WindingCave::of_length(40, 1);
  const VoxelMap map = cave.map();
  std::vector<CellKey> cells;
  map.for_each_known([&](const CellKey& k, Cell c, float) {
    if (c == Cell::free) cells.push_back(k);
  });
  const double clearance = PlanningOptions{}.clearance_m, n = static_cast<double>(cells.size());
  long a = 0, b = 0, c = 0;
  Vec3 low = Vec3::Constant(1e9), high = -low;
  for (const CellKey& k : cells) low = low.cwiseMin(map.center_of(k)), high = high.cwiseMax(map.center_of(k));
  const double look_ups = cpu_ms([&] {
    for (const CellKey& k : cells) a += is_clear(map, map.center_of(k), clearance);
  });
  const double tree = cpu_ms([&] {
    const ObstacleTree t(map, low - Vec3::Constant(1), high + Vec3::Constant(1));
    for (const CellKey& k : cells) b += !t.any_within(map.center_of(k), clearance);
  });
  const double bits = cpu_ms([&] {
    FreeTiles free(map.resolution_m());
    free.load(map, map.key_of(low - Vec3::Constant(4)), map.key_of(high + Vec3::Constant(4)));
    const ClearanceRule rule(clearance / map.resolution_m());
    TileTable done;
    for (const CellKey& k : cells)
      if (done.find(tile_of(k)) == TileTable::none) {
        done.add(tile_of(k));
        for (const std::uint32_t row : free.clear_cells(tile_of(k), rule)) c += __builtin_popcount(row);
      }
  });
  std::printf(
      "  look-ups %.0f, KD-tree (built) %.0f, tiles of bits (loaded) %.1f; clear: %ld, %ld, %ld of %.0f\n",
      1e6 * look_ups / n, 1e6 * tree / n, 1e6 * bits / n, a, b, c, n);
}

void roadmap_updates() {
  const WindingCave cave = WindingCave::of_length(190, 2, 3.4);
  std::vector<CellChange> changes;
  const VoxelMap map = cave.map(&changes);
  // The cave is drawn along its line: equal shares of its changes are what scans at 2 m/s and 10 Hz would
  // bring.
  const auto scans = static_cast<std::size_t>(190 / 0.2);
  const std::size_t fraction = changes.size() / scans;
  std::printf("\nroadmap, %.0f m^3, %zu changes a scan\n", map.free_volume_m3(), fraction);
  Roadmap roadmap{PlanningOptions{}};
  Times update, query;
  for (std::size_t i = 0; i + fraction <= changes.size(); i += fraction)
    update.ms.push_back(cpu_ms([&] { roadmap.update(map, std::span(changes).subspan(i, fraction)); }));
  std::vector<Vec3> goals;
  for (std::size_t i = 0; i < 100; ++i) goals.push_back(cave.line[cave.line.size() * i / 100]);
  std::size_t reached = 0;
  for (int i = 0; i < 20; ++i)
    query.ms.push_back(cpu_ms([&] {
      reached = 0;
      for (const double d : roadmap.distances(map, cave.line[6], goals, 0.2)) reached += std::isfinite(d);
    }));
  update.print("update, a scan");
  query.print("distances to 100 goals");
  std::printf("  %zu nodes, %zu goals reached\n", roadmap.node_count(), reached);
}

}  // namespace
}  // namespace karst::core

int main() {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  karst::core::feasibility();
  karst::core::paths(60, 5, 10, true);
  karst::core::paths(140, 2, 8, true);
  karst::core::roadmap_updates();
}
