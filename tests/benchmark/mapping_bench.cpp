// Mapping against stock OctoMap on the same scans, in one run: a LiDAR flown along a noisy elliptical tunnel.
#include <octomap/octomap.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <functional>

#include "core_stack/common/random.h"
#include "core_stack/mapping/frontiers/frontiers.h"
#include "core_stack/mapping/obstacles/obstacle_tree.h"
#include "core_stack/mapping/octomap/octomap_io.h"

namespace {

using namespace karst::core;

/// Processor time: the ratios then hold on a busy machine as well.
double milliseconds(const std::function<void()>& f) {
  const auto now = [] {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
  };
  const double begin = now();
  f();
  return now() - begin;
}

struct Timing {
  std::vector<double> ms;
  double sum() const {
    double s = 0;
    for (const double v : ms) s += v;
    return s;
  }
  double mean() const { return ms.empty() ? 0 : sum() / static_cast<double>(ms.size()); }
  double quantile(double q) const {
    std::vector<double> sorted = ms;
    std::sort(sorted.begin(), sorted.end());
    return sorted.empty() ? 0 : sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
  }
};

/// A tunnel along x, 8 x 6 m with bulges, walls rough by 5 cm; range noise 2 cm; one pose a scan.
struct Tunnel {
  int channels, columns;
  double max_range_m;
  Random random{7};

  static double inside(const Vec3& p) {  // > 0 in the tunnel
    const double bulge =
        1.0 + 0.25 * std::sin(0.21 * p.x()) + 0.012 * std::sin(7 * p.x()) * std::sin(9 * p.z());
    const double y = (p.y() - 3.0 * std::sin(0.05 * p.x())) / (4.0 * bulge), z = p.z() / (3.0 * bulge);
    return 1.0 - y * y - z * z;
  }
  static Vec3 axis(double x) { return {x, 3.0 * std::sin(0.05 * x), 0.1}; }

  double range(const Vec3& origin, const Vec3& d) const {
    double t = 0, step = 0.4;
    while (t < max_range_m && inside(origin + d * (t + step)) > 0) t += step;
    for (int i = 0; i < 12; ++i) {
      step /= 2;
      if (inside(origin + d * (t + step)) > 0) t += step;
    }
    return t;
  }

  std::vector<Ray> scan(double x) {
    std::vector<Ray> rays;
    const Vec3 origin = axis(x);
    for (int j = 0; j < columns; ++j)
      for (int c = 0; c < channels; ++c) {
        const double azimuth = 2 * std::numbers::pi * j / columns;
        const double elevation = (c / (channels - 1.0) - 0.5) * 1.57;
        const Vec3 d(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                     std::sin(elevation));
        const double r = range(origin, d);
        const bool hit = r < max_range_m;
        const double measured = hit ? r + 0.02 * random.normal() : max_range_m;
        rays.push_back({origin.cast<float>(), (origin + d * measured).cast<float>(), hit});
      }
    return rays;
  }
};

/// Stock OctoMap's insertPointCloud. A ray without a hit is given as a point beyond the range, as OctoMap
/// wants it.
double insert_stock(octomap::OcTree& tree, const std::vector<Ray>& rays, double max_range_m,
                    bool discretize) {
  octomap::Pointcloud cloud;
  const Vec3f o = rays.front().origin;
  for (const Ray& r : rays) {
    const Vec3f p = r.hit ? r.end : Vec3f(o + (r.end - o) * 1.5f);
    cloud.push_back(p.x(), p.y(), p.z());
  }
  const bool lazy = true;  // inner nodes are summed up once, at the end
  return milliseconds([&] {
    tree.insertPointCloud(cloud, octomap::point3d(o.x(), o.y(), o.z()), max_range_m, lazy, discretize);
  });
}

double agreement(const VoxelMap& map, const octomap::OcTree& tree) {
  std::size_t same = 0, cells = 0;
  map.for_each_known([&](const CellKey& k, Cell cell, float) {
    const auto key = [](std::int32_t v) { return static_cast<octomap::key_type>(v + 32768); };
    const auto* node = tree.search(octomap::OcTreeKey(key(k.x), key(k.y), key(k.z)));
    const Cell other = node == nullptr             ? Cell::unknown
                       : tree.isNodeOccupied(node) ? Cell::occupied
                                                   : Cell::free;
    ++cells, same += other == cell;
  });
  // Cells that only OctoMap knows.
  for (auto it = tree.begin_leafs(); it != tree.end_leafs(); ++it) {
    const int edge = 1 << (16 - it.getDepth());
    const auto k = it.getIndexKey();
    for (int x = 0; x < edge; ++x)
      for (int y = 0; y < edge; ++y)
        for (int z = 0; z < edge; ++z)
          cells += map.at(CellKey{k[0] + x - 32768, k[1] + y - 32768, k[2] + z - 32768}) == Cell::unknown;
  }
  return 100.0 * static_cast<double>(same) / static_cast<double>(cells);
}

void compare_insertion(int channels, int columns, double max_range_m, int scans) {
  Tunnel tunnel{channels, columns, max_range_m};
  std::vector<std::vector<Ray>> recorded;
  for (int i = 0; i < scans; ++i) recorded.push_back(tunnel.scan(0.2 * i));

  VoxelMap map({0.2, 0.7, 0.4, 0.12, 0.97});  // OctoMap's defaults
  Timing ours, stock, discretized;
  for (const auto& rays : recorded) ours.ms.push_back(milliseconds([&] { map.insert(rays); }));
  std::unique_ptr<octomap::OcTree> converted;
  const double conversion = milliseconds([&] { converted = to_octree(map); });

  octomap::OcTree tree(0.2), rough(0.2);
  for (const auto& rays : recorded) stock.ms.push_back(insert_stock(tree, rays, max_range_m, false));
  for (const auto& rays : recorded) discretized.ms.push_back(insert_stock(rough, rays, max_range_m, true));
  const auto finish = [](octomap::OcTree& t) {
    t.updateInnerOccupancy();
    t.prune();
  };
  const double finishing = milliseconds([&] { finish(tree); });
  finish(rough);
  const double per_scan = 1.0 / scans;
  std::printf(
      "%2dx%d, %2.0f m | %6.1f ms %5.1f ms %5.1fx | %6.1f ms %5.1f ms %5.1fx | %7.3f %% | %6.1f ms %5.1fx "
      "%7.3f %%\n",
      channels, columns, max_range_m, stock.mean(), ours.mean(), stock.mean() / ours.mean(),
      stock.mean() + finishing * per_scan, ours.mean() + conversion * per_scan,
      (stock.sum() + finishing) / (ours.sum() + conversion), agreement(map, tree), discretized.mean(),
      discretized.mean() / ours.mean(), agreement(map, rough));
}

/// Flies on until so much is mapped; prints what the updates cost over the last 25 scans.
void frontier_cost() {
  std::printf(
      "\nFrontier update after a 16x1024 scan, 0.2 m a scan, mean over the 25 scans before the volume is "
      "reached\n");
  Tunnel tunnel{16, 1024, 20.0};
  VoxelMap map{MapOptions{}};
  Frontiers frontiers{FrontierOptions{}};
  Timing updates, trees;
  double x = 0;
  for (const double volume : {1000.0, 5000.0, 20000.0}) {
    updates.ms.clear();
    std::size_t changes = 0;
    while (map.free_volume_m3() < volume) {
      const auto changed = map.insert(tunnel.scan(x));
      updates.ms.push_back(milliseconds([&] { frontiers.update(map, changed); }));
      changes = changed.size();
      x += 0.2;
    }
    Timing last;
    last.ms.assign(updates.ms.end() - 25, updates.ms.end());
    std::printf(
        "  %6.0f m^3: %5.2f ms mean, %5.2f ms worst; %zu changes, %zu frontier cells in %zu clusters\n",
        map.free_volume_m3(), last.mean(), last.quantile(1.0), changes, frontiers.cell_count(),
        frontiers.clusters().size());
  }
  std::printf("\nObstacle tree of a 20 x 20 x 10 m box\n");
  const Vec3 at = Tunnel::axis(x / 2);
  const Vec3 half(10, 10, 5);
  std::unique_ptr<ObstacleTree> tree;
  for (int i = 0; i < 20; ++i)
    trees.ms.push_back(
        milliseconds([&] { tree = std::make_unique<ObstacleTree>(map, at - half, at + half); }));
  std::printf("  build %.2f ms for %zu obstacle cells\n", trees.mean(), tree->size());
  Random random(3);
  std::vector<Vec3> queries;
  for (int i = 0; i < 200000; ++i) {  // coherent, as along a path
    const double s = i / 200000.0;
    queries.push_back(at + Vec3(16 * s - 8, 2 * std::sin(20 * s) + 0.2 * random.uniform(), std::sin(33 * s)));
  }
  double sum = 0;
  const double nearest = milliseconds([&] {
    for (const Vec3& q : queries) sum += tree->distance(q);
  });
  std::size_t near = 0;
  const double within = milliseconds([&] {
    for (const Vec3& q : queries) near += tree->any_within(q, 0.8);
  });
  std::printf("  nearest %.0f ns, within 0.8 m %.0f ns a query (mean distance %.2f m, %.0f %% within)\n",
              nearest * 5, within * 5, sum / 2e5, static_cast<double>(near) / 2e3);
}

}  // namespace

int main() {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  std::printf("Insertion, mean of 100 scans, processor time; \"same\": cells of the same class in both\n");
  std::printf(
      "scan, range    | OctoMap    karst   ratio | with the final tree made    | same      | OctoMap "
      "discretized\n");
  compare_insertion(16, 1024, 20.0, 100);
  compare_insertion(64, 1024, 20.0, 100);
  compare_insertion(64, 1024, 60.0, 100);
  frontier_cost();
  return 0;
}
