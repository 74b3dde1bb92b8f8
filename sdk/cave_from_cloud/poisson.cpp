#include "sdk/cave_from_cloud/poisson.h"

#include <pcl/console/print.h>
#include <pcl/point_types.h>
#include <pcl/surface/poisson.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace karst::from_cloud {
namespace {

using PclCloud = pcl::PointCloud<pcl::PointNormal>;

PclCloud::Ptr pcl_cloud(const PointCloud& cloud) {
  auto out = std::make_shared<PclCloud>();
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    pcl::PointNormal p;
    p.getVector3fMap() = cloud.points[i];
    p.getNormalVector3fMap() = cloud.normals[i];
    out->push_back(p);
  }
  return out;
}

double side_m_of(const PointCloud& cloud) {
  Eigen::AlignedBox3f box;
  for (const core::Vec3f& p : cloud.points) box.extend(p);
  return static_cast<double>(box.sizes().maxCoeff());
}

}  // namespace

bool has_poisson() { return true; }

cave::TriangleMesh poisson_surface(const PointCloud& cloud, double cell_m) {
  constexpr int kShallowest = 5, kFullDepth = 4;
  constexpr float kPointsPerNode = 1.5f;
  const double side_m = side_m_of(cloud);
  const int depth =
      std::clamp(static_cast<int>(std::ceil(std::log2(kMargin * side_m / cell_m))), kShallowest, kDeepest);
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  pcl::Poisson<pcl::PointNormal> poisson;
  poisson.setThreads(1);
  poisson.setDepth(depth);
  poisson.setMinDepth(kFullDepth);
  poisson.setScale(static_cast<float>(std::max(kMargin, (1 << depth) * cell_m / side_m)));
  poisson.setSamplesPerNode(kPointsPerNode);
  poisson.setInputCloud(pcl_cloud(cloud));
  PclCloud vertices;
  std::vector<pcl::Vertices> polygons;
  poisson.performReconstruction(vertices, polygons);

  cave::TriangleMesh mesh;
  for (const pcl::PointNormal& v : vertices) mesh.vertices.emplace_back(v.x, v.y, v.z);
  for (const pcl::Vertices& p : polygons)
    for (std::size_t k = 2; k < p.vertices.size(); ++k)
      mesh.triangles.push_back({static_cast<std::uint32_t>(p.vertices[0]),
                                static_cast<std::uint32_t>(p.vertices[k - 1]),
                                static_cast<std::uint32_t>(p.vertices[k])});
  return mesh;
}

}  // namespace karst::from_cloud
