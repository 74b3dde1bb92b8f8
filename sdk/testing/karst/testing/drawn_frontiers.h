// The frontiers of a drawn map, as the core would find them: free cells with an unknown face neighbour,
// grouped by adjacency (faces, edges and corners).
#pragma once
#include <set>
#include <vector>

#include <karst/testing/drawn_map.h>

namespace karst::testing {

/// Clusters of at least `min_cells` cells, with ids from 1 in the order of their first cell (x, then y, then
/// z). A drawing of a single layer is a floor plan: cells above and below it do not count. The viewpoint is
/// the centre of the cluster's cell nearest its centroid, with the heading of the normal; the path to it is
/// measured from `from` (world, m).
inline std::vector<Frontier> find_frontiers(const DrawnMap& map, const Vec3& from,
                                            std::uint32_t min_cells = 1) {
  const bool plan = map.layers() == 1;
  const auto unknown_side = [&](const Index& i) {
    Vec3 sum;
    const Index faces[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (const Index& f : faces)
      if (!(plan && f.z != 0) && map.at(Index{i.x + f.x, i.y + f.y, i.z + f.z}) == Cell::unknown)
        sum = sum + Vec3(f.x, f.y, f.z);
    return sum;
  };
  const auto is_frontier = [&](const Index& i) {
    if (map.at(i) != Cell::free) return false;
    const Index faces[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (const Index& f : faces)
      if (!(plan && f.z != 0) && map.at(Index{i.x + f.x, i.y + f.y, i.z + f.z}) == Cell::unknown) return true;
    return false;
  };
  std::set<Index> left;
  for (const auto& [i, cell] : map.known())
    if (is_frontier(i)) left.insert(i);

  std::vector<Frontier> out;
  while (!left.empty()) {
    std::vector<Index> cluster{*left.begin()};
    left.erase(left.begin());
    for (std::size_t next = 0; next < cluster.size(); ++next)
      for (int dx = -1; dx <= 1; ++dx)
        for (int dy = -1; dy <= 1; ++dy)
          for (int dz = -1; dz <= 1; ++dz) {
            const Index n{cluster[next].x + dx, cluster[next].y + dy, cluster[next].z + dz};
            if (left.erase(n) > 0) cluster.push_back(n);
          }
    if (cluster.size() < min_cells) continue;
    Frontier f;
    f.id = static_cast<std::uint32_t>(out.size() + 1);
    f.cells = static_cast<std::uint32_t>(cluster.size());
    f.low = f.high = map.center_of(cluster.front());
    for (const Index& i : cluster) {
      const Vec3 c = map.center_of(i);
      f.centroid = f.centroid + (1.0 / static_cast<double>(cluster.size())) * c;
      f.normal = f.normal + unknown_side(i);
      f.low = {std::min(f.low.x, c.x), std::min(f.low.y, c.y), std::min(f.low.z, c.z)};
      f.high = {std::max(f.high.x, c.x), std::max(f.high.y, c.y), std::max(f.high.z, c.z)};
    }
    f.normal = norm(f.normal) > 1e-9 ? (1.0 / norm(f.normal)) * f.normal : Vec3();
    f.viewpoint = map.center_of(cluster.front());
    for (const Index& i : cluster)
      if (distance(map.center_of(i), f.centroid) < distance(f.viewpoint, f.centroid))
        f.viewpoint = map.center_of(i);
    f.viewpoint_heading_rad = std::atan2(f.normal.y, f.normal.x);
    f.path_length_m = map.path_length_m(from, f.viewpoint);
    out.push_back(f);
  }
  return out;
}

}  // namespace karst::testing
