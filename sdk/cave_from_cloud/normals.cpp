#include "sdk/cave_from_cloud/normals.h"

#include "core_stack/mapping/obstacles/plane_normal.h"

namespace karst::from_cloud {

using core::Vec3f;

Neighbours::Neighbours(const core::PointTree& tree, std::size_t each) : each_(each) {
  all_.reserve(each * tree.points().size());
  for (const Vec3f& p : tree.points())
    for (const std::uint32_t i : tree.nearest_few(p.cast<double>(), each)) all_.push_back(i);
}

std::vector<Vec3f> plane_normals(const std::vector<Vec3f>& points, const Neighbours& neighbours) {
  std::vector<Vec3f> normals;
  normals.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    normals.push_back(core::plane_normal(points, neighbours.of(i), points[i]));
  return normals;
}

double agreement(const std::vector<Vec3f>& normals, const Neighbours& neighbours) {
  std::size_t agree = 0;
  for (std::size_t i = 0; i < normals.size(); ++i)
    if (normals[i].dot(normals[neighbours.of(i)[1]]) >= 0) ++agree;
  return static_cast<double>(agree) / static_cast<double>(normals.size());
}

}  // namespace karst::from_cloud
