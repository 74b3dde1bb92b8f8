#include "core_stack/mapping/obstacles/thinned_out.h"

#include <algorithm>

#include "core_stack/mapping/occupancy/packed_cell.h"

namespace karst::core {

std::vector<Vec3f> thinned_out(const std::vector<Vec3f>& points, double cell_m) {
  struct Entry {
    PackedCell cell;
    std::uint32_t index;
  };
  std::vector<Entry> entries;
  entries.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d k = (points[i].cast<double>() / cell_m).array().floor();
    if (!points[i].allFinite() || k.cwiseAbs().maxCoeff() >= kPackedLimit) continue;
    entries.push_back({pack({static_cast<int>(k.x()), static_cast<int>(k.y()), static_cast<int>(k.z())}), i});
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.cell != b.cell ? a.cell < b.cell : a.index < b.index;
  });
  std::vector<Vec3f> thin;
  for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
    Vec3 sum = Vec3::Zero();
    for (; end < entries.size() && entries[end].cell == entries[begin].cell; ++end)
      sum += points[entries[end].index].cast<double>();
    thin.push_back((sum / static_cast<double>(end - begin)).cast<float>());
  }
  return thin;
}

}  // namespace karst::core
