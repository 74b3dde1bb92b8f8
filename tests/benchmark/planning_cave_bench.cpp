// Planning in the largest of the real caves, next to OMPL's planners on the same state space and validity
// checker: time, length over the shortest known, clearance. `planning_cave_bench [PAIRS
// [times]]`; `times` leaves out lengths and OMPL.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "core_stack/planning/free_space/free_tiles.h"
#include "core_stack/planning/path/refine.h"
#include "core_stack/planning/planner.h"
#include "core_stack/planning/search/grid_planner.h"
#include "core_stack/planning/search/ompl_search.h"
#include "tests/benchmark/cave_map.h"
#include "tests/benchmark/taut_string.h"
#include "tests/benchmark/times.h"

namespace karst::core {
namespace {

using bench::cpu_ms;
using bench::Times;

struct World {
  const bench::CaveMap& cave;
  const Roadmap& roadmap;
  const FreeTiles& free;
};

struct Pair {
  Vec3 from, to;
};

/// Pairs of clear places whose way on the roadmap, which zigzags some per cent, is about `length_m` long.
std::vector<Pair> draw_pairs(const World& w, double length_m, int count, std::uint64_t seed) {
  Random random(seed);
  const PlanningOptions options;
  const auto place = [&] {
    for (;;) {
      const CellKey k = w.cave.free[random.bits() % w.cave.free.size()];
      const Vec3 p = w.cave.map.center_of(k);
      if (w.free.is_clear(p, options.clearance_m)) return p;
    }
  };
  std::vector<Pair> out;
  while (static_cast<int>(out.size()) < count) {
    const Vec3 from = place();
    std::vector<Vec3> goals;
    for (int i = 0; i < 40; ++i) goals.push_back(place());
    const std::vector<double> lengths = w.roadmap.distances(w.cave.map, from, goals, 0);
    int taken = 0;
    for (std::size_t i = 0; i < goals.size() && static_cast<int>(out.size()) < count && taken < 2; ++i)
      if (lengths[i] > 1.0 * length_m && lengths[i] < 1.12 * length_m)
        out.push_back({from, goals[i]}), ++taken;
  }
  return out;
}

/// The shortest way known between a pair at the bare clearance: the grid's shortest and the roadmap's, each
/// drawn taut, and whatever else is handed in.
double shortest_m(const World& w, const Pair& pair, const std::vector<std::vector<Vec3>>& others) {
  PlanningOptions optimal;
  optimal.heuristic_weight = 1.0;
  optimal.max_expansions = 100000000;
  std::vector<std::vector<Vec3>> paths = others;
  paths.push_back(plan_on_grid(w.cave.map, pair.from, pair.to, optimal).points);
  double best = std::numeric_limits<double>::infinity();
  for (const std::vector<Vec3>& points : paths)
    if (points.size() >= 2)
      best = std::min(best, path_length_m(bench::taut_string(w.free, optimal.clearance_m, points, 6000)));
  return best;
}

/// Mean distance of a path's points from the nearest obstacle, up to 2 m.
double mean_clearance_m(const World& w, const std::vector<Vec3>& points) {
  double sum = 0, length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double l = (points[i] - points[i - 1]).norm();
    sum += l * w.free.nearest(points[i], 2.0).distance_m, length += l;
  }
  return sum / length;
}
double min_clearance_m(const World& w, const Path& path) {
  double least = 2;
  for (std::size_t i = path.escape_points; i < path.points.size(); ++i)
    least = std::min(least, w.free.nearest(path.points[i], 2.0).distance_m);
  return least;
}

void row(const World& w, const std::vector<Pair>& pairs, const std::vector<double>& best_m,
         const PlanningOptions& options, const char* name) {
  Times search, whole, ratio, raw_ratio;
  double clearance = 0, least = 2;
  int failed = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Pair& p = pairs[i];
    Path raw, path;
    if (options.planner != Planner::grid)
      search.ms.push_back(cpu_ms([&] {
        raw = search_with_ompl(w.cave.map, w.roadmap, p.from, p.to, options,
                               search_clearance_m(options, w.cave.map.resolution_m()));
      }));
    else
      search.ms.push_back(cpu_ms([&] { raw = w.roadmap.find(w.cave.map, p.from, p.to); }));
    whole.ms.push_back(cpu_ms([&] { path = plan(w.cave.map, w.roadmap, p.from, p.to, options); }));
    if (!path.found()) {
      ++failed;
      continue;
    }
    raw_ratio.ms.push_back(raw.length_m / best_m[i]);
    ratio.ms.push_back(path.length_m / best_m[i]);
    clearance += mean_clearance_m(w, path.points), least = std::min(least, min_clearance_m(w, path));
  }
  if (ratio.ms.empty()) {
    std::printf("  %-22s none of %zu found\n", name, pairs.size());
    return;
  }
  std::printf("  %-22s %8.1f %8.1f %8.1f %8.1f   %6.3f   %6.3f %6.3f %6.3f   %5.2f %5.2f   %d of %zu\n", name,
              search.at(0.5), whole.at(0.5), whole.at(0.99), whole.at(1.0), raw_ratio.mean(), ratio.mean(),
              ratio.at(0.95), ratio.at(1.0), clearance / static_cast<double>(ratio.ms.size()), least, failed,
              pairs.size());
}

/// Where the time of plan() goes.
void times(const World& w, const std::vector<Pair>& pairs, double length_m) {
  const PlanningOptions options;
  Times whole, find, refine, look;
  for (const Pair& p : pairs) {
    Path raw, path;
    whole.ms.push_back(cpu_ms([&] { path = plan(w.cave.map, w.roadmap, p.from, p.to, options); }));
    find.ms.push_back(cpu_ms([&] { raw = w.roadmap.find(w.cave.map, p.from, p.to); }));
    refine.ms.push_back(cpu_ms([&] { refine_path(w.cave.map, raw.points, options); }));
    look.ms.push_back(cpu_ms([&] { first_blocked_segment(w.cave.map, path.points, options.clearance_m); }));
  }
  std::printf("\n%zu paths of %.0f m\n", pairs.size(), length_m);
  whole.print("plan(): search, refine, last look");
  find.print("  of which search on the roadmap");
  refine.print("  of which refining");
  look.print("  of which the last look");
}

void table(const World& w, double length_m, int count, std::uint64_t seed, bool compare) {
  const std::vector<Pair> pairs = draw_pairs(w, length_m, count, seed);
  times(w, pairs, length_m);
  if (!compare) return;
  std::vector<double> best_m;
  double mean_m = 0;
  for (const Pair& p : pairs) {
    PlanningOptions o;
    std::vector<std::vector<Vec3>> paths{plan(w.cave.map, w.roadmap, p.from, p.to, o).points};
    if (std::getenv("KARST_BENCH_LONG")) {
      o.planner = Planner::bit_star, o.planner_iterations = 30000;
      paths.push_back(search_with_ompl(w.cave.map, w.roadmap, p.from, p.to, o, o.clearance_m).points);
    }
    best_m.push_back(shortest_m(w, p, paths));
    mean_m += best_m.back() / count;
  }
  std::printf("\n%zu paths of %.0f m (%.1f m the shortest known, mean), seed %llu\n", pairs.size(), length_m,
              mean_m, static_cast<unsigned long long>(seed));
  std::printf("  %-22s %8s %8s %8s %8s   %6s   %20s   %11s   not found\n", "", "search", "plan()", "", "",
              "raw", "length / shortest", "clearance m");
  std::printf("  %-22s %8s %8s %8s %8s   %6s   %6s %6s %6s   %5s %5s\n", "", "p50 ms", "p50 ms", "p99 ms",
              "max ms", "length", "mean", "p95", "max", "mean", "least");
  PlanningOptions options;
  row(w, pairs, best_m, options, "grid and roadmap");
  PlanningOptions bare = options;
  bare.preferred_clearance_m = bare.clearance_m;
  row(w, pairs, best_m, bare, "  bare clearance");
  const std::size_t few = std::min<std::size_t>(pairs.size(), 30);
  const std::vector<Pair> some(pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(few));
  for (const auto& [planner, iterations] : {std::pair<Planner, std::int64_t>{Planner::rrt_connect, 20000},
                                            {Planner::rrt_star, 3000},
                                            {Planner::bit_star, 5000}}) {
    options.planner = planner, options.planner_iterations = iterations;
    row(w, some, best_m, options, (std::string(name_of(planner)) + " " + std::to_string(iterations)).c_str());
  }
}

int run(int count, bool compare) {
  const std::string folder = std::string(KARST_SOURCE_DIR) + "/../shared/data/caves/develop/";
  if (!std::filesystem::exists(folder)) {
    std::printf("skipped: no ../shared\n");
    return 0;
  }
  const cave::Cave cave = cave::load_cave(folder + "darpa_cave_01.ply", "14.0 0.1 1.3");
  const bench::CaveMap known = bench::map_of_cave(cave.scene.mesh(), {14.0, 0.1, 1.3});
  std::vector<CellChange> changes;
  for (const CellKey& k : known.free) changes.push_back({k, Cell::unknown, Cell::free});
  Roadmap roadmap{PlanningOptions{}};
  const double built_ms = cpu_ms([&] { roadmap.update(known.map, changes); });
  changes.clear(), changes.shrink_to_fit();
  FreeTiles free(known.map.resolution_m());
  for (const CellKey& k : known.free) free.load(known.map, k, k);
  std::printf("darpa_cave_01: %.0f m^3 free, %zu nodes in the roadmap, built in %.1f s\n",
              known.map.free_volume_m3(), roadmap.node_count(), built_ms / 1e3);
  const World world{known, roadmap, free};
  table(world, 60, count, 1, compare);
  table(world, 150, count, 2, compare);
  return 0;
}

}  // namespace
}  // namespace karst::core

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  return karst::core::run(argc > 1 ? std::atoi(argv[1]) : 100, argc < 3);
}
