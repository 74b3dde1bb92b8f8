// The way home in 5 km of passages: a winding main passage of 3 km with eight side passages of 250 m, drawn
// as free cells straight into the map (what is around them stays unknown, which keeps a vehicle out like
// rock).
#include <cmath>
#include <cstdio>

#include "core_stack/homing/path_home/home.h"
#include "core_stack/planning/planner.h"
#include "tests/benchmark/times.h"
#include "tests/unit/planning/test_maps.h"

namespace karst::core {
namespace {

using bench::cpu_ms;
using bench::Times;
using testing::noise;

/// Frees a ball; new cells are appended to `changes`.
void carve(VoxelMap& map, const Vec3& c, double radius_m, std::vector<CellChange>& changes) {
  const CellKey low = map.key_of(c - Vec3::Constant(radius_m)),
                high = map.key_of(c + Vec3::Constant(radius_m));
  for (int z = low.z; z <= high.z; ++z)
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x) {
        const CellKey k{x, y, z};
        if ((map.center_of(k) - c).squaredNorm() > radius_m * radius_m || map.at(k) != Cell::unknown)
          continue;
        map.assign(k, 1, -1.0f);
        changes.push_back({k, Cell::unknown, Cell::free});
      }
}

/// A winding passage from `p` on, 1.6 to 2.4 m in radius; returns its centre line, every half metre.
std::vector<Vec3> passage(VoxelMap& map, Vec3 p, double heading, double length_m, std::uint64_t seed,
                          std::vector<CellChange>& changes) {
  std::vector<Vec3> line;
  for (double s = 0; s <= length_m; s += 0.5) {
    carve(map, p, 2.0 + 0.4 * noise({s, 5, 0}, 6.0, seed), changes);
    line.push_back(p);
    const double turn = heading + 0.9 * noise({s, 0, 0}, 25.0, seed + 1),
                 climb = 0.3 * noise({s, 9, 0}, 30.0, seed + 2);
    p += 0.5 * Vec3(std::cos(turn) * std::cos(climb), std::sin(turn) * std::cos(climb), std::sin(climb));
  }
  return line;
}

/// Rock (or free space again) across a passage.
std::vector<CellChange> wall(VoxelMap& map, const Vec3& at, bool rock) {
  std::vector<CellChange> changes;
  const CellKey c = map.key_of(at);
  for (int z = -14; z <= 14; ++z)
    for (int y = -14; y <= 14; ++y)
      for (int x = -1; x <= 1; ++x) {
        const CellKey k = c + CellKey{x, y, z};
        const Cell before = map.at(k);
        if (before != (rock ? Cell::free : Cell::occupied)) continue;
        map.assign(k, 1, rock ? 2.0f : -2.0f);
        changes.push_back({k, before, map.at(k)});
      }
  return changes;
}

void run() {
  const PlanningOptions options;
  VoxelMap map{MapOptions{}};
  std::vector<CellChange> changes;
  std::vector<std::vector<Vec3>> lines{passage(map, Vec3::Zero(), 0, 3000, 1, changes)};
  for (std::uint64_t i = 0; i < 8; ++i)
    lines.push_back(passage(map, lines[0][600 + 650 * i], i % 2 == 0 ? 1.4 : -1.4, 250, 10 + 5 * i, changes));
  Roadmap roadmap{options};
  PathHome home;
  const Vec3 start = lines[0][4];
  const double built_ms = cpu_ms([&] { roadmap.update(map, changes); });
  const double tree_ms = cpu_ms([&] { home.update(map, roadmap, start, options); });
  std::printf(
      "5 km of passages, %.0f m^3, %zu nodes; roadmap built in %.0f ms, distances to home in %.0f ms\n",
      map.free_volume_m3(), roadmap.node_count(), built_ms, tree_ms);

  Random random(3);
  const auto place = [&] {
    const std::vector<Vec3>& line = lines[random.bits() % lines.size()];
    return line[random.bits() % line.size()];
  };
  Times length, find, search;
  double longest_m = 0, sum_m = 0, sum_search_m = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = i == 0 ? lines[0].back() : place();
    double l = 0;
    length.ms.push_back(cpu_ms([&] { l = home.length_m(map, roadmap, p).value_or(-1); }));
    longest_m = std::max(longest_m, l);
    Path path;
    find.ms.push_back(cpu_ms([&] { path = home.find(map, roadmap, p); }));
    if (i >= 40) continue;
    Path found;
    search.ms.push_back(cpu_ms([&] { found = roadmap.find(map, p, start); }));
    sum_m += path.length_m, sum_search_m += found.length_m;
  }
  std::printf("from anywhere, up to %.0f m from home\n", longest_m);
  length.print("length of the way home");
  find.print("the way home");
  search.print("the same by A* over the roadmap");
  std::printf("  the tree's ways over A*'s: %.6f\n", sum_m / sum_search_m);

  Times map_grows, tree_grows;
  const Vec3 end = lines[0].back();
  for (int i = 0; i < 200; ++i) {
    std::vector<CellChange> more;
    carve(map, end + Vec3(0.2 * i, 0.3 * std::sin(0.1 * i), 0), 2.0, more);
    map_grows.ms.push_back(cpu_ms([&] { roadmap.update(map, more); }));
    tree_grows.ms.push_back(cpu_ms([&] { home.update(map, roadmap, start, options); }));
  }
  std::printf("200 scans at the far end, 0.2 m apart\n");
  map_grows.print("roadmap update");
  tree_grows.print("update of the distances home");

  Times closed, opened;
  int cut = 0, around = 0;
  for (int i = 0; i < 30; ++i) {
    const std::size_t at = 40 + random.bits() % (lines[0].size() - 80);
    const std::vector<CellChange> fall = wall(map, lines[0][at], true);
    roadmap.update(map, fall);
    std::optional<double> l;
    closed.ms.push_back(cpu_ms([&] {
      home.update(map, roadmap, start, options);
      l = home.length_m(map, roadmap, end);
    }));
    ++(l ? around : cut);
    roadmap.update(map, wall(map, lines[0][at], false));
    opened.ms.push_back(cpu_ms([&] {
      home.update(map, roadmap, start, options);
      l = home.length_m(map, roadmap, end);
    }));
  }
  std::printf("30 rockfalls across the main passage, anywhere: %d leave no way, %d one around\n", cut,
              around);
  closed.print("update and length after the fall");
  opened.print("update and length after it is dug away");
}

}  // namespace
}  // namespace karst::core

int main() {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  karst::core::run();
}
