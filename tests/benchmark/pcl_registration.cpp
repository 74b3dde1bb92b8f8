#include "tests/benchmark/pcl_registration.h"

#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/ndt.h>

#include <deque>

namespace karst::bench {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;

constexpr float kSourceLeaf = 0.5f, kTargetLeaf = 0.3f;  // m
constexpr double kKeyframeDistance = 1.0;                // m
constexpr std::size_t kKeyframes = 15;                   // in the map

Cloud::Ptr filtered(const Cloud::Ptr& cloud, float leaf) {
  pcl::VoxelGrid<Point> grid;
  grid.setLeafSize(leaf, leaf, leaf);
  grid.setInputCloud(cloud);
  Cloud::Ptr out(new Cloud);
  grid.filter(*out);
  return out;
}

Eigen::Matrix4f matrix(const core::Pose& T) {
  Eigen::Matrix4f m = Eigen::Matrix4f::Identity();
  m.topLeftCorner<3, 3>() = T.orientation.toRotationMatrix().cast<float>();
  m.topRightCorner<3, 1>() = T.position.cast<float>();
  return m;
}

core::Pose pose(const Eigen::Matrix4f& m) {
  return {m.topRightCorner<3, 1>().cast<double>(),
          core::Quat(Eigen::Matrix3d(m.topLeftCorner<3, 3>().cast<double>())).normalized()};
}

std::unique_ptr<pcl::Registration<Point, Point>> registration(const std::string& method) {
  if (method == "GICP") {
    auto gicp = std::make_unique<pcl::GeneralizedIterativeClosestPoint<Point, Point>>();
    gicp->setMaxCorrespondenceDistance(1.0);
    gicp->setMaximumIterations(20);
    gicp->setTransformationEpsilon(1e-4);
    return gicp;
  }
  auto ndt = std::make_unique<pcl::NormalDistributionsTransform<Point, Point>>();
  ndt->setResolution(1.0f);
  ndt->setStepSize(0.1);
  ndt->setTransformationEpsilon(1e-3);
  ndt->setMaximumIterations(20);
  return ndt;
}

}  // namespace

struct PclOdometry::State {
  std::unique_ptr<pcl::Registration<Point, Point>> method;
  core::Pose T_world_body;
  std::deque<std::pair<core::Vec3, Cloud::Ptr>> keyframes;  // in the world

  void add_keyframe(const Cloud::Ptr& body) {
    Cloud::Ptr world(new Cloud);
    const Eigen::Matrix4f T = matrix(T_world_body);
    for (const Point& p : *body) {
      const Eigen::Vector4f q = T * Eigen::Vector4f(p.x, p.y, p.z, 1);
      world->push_back({q.x(), q.y(), q.z()});
    }
    keyframes.emplace_back(T_world_body.position, world);
    if (keyframes.size() > kKeyframes) keyframes.pop_front();
    Cloud::Ptr map(new Cloud);
    for (const auto& [place, cloud] : keyframes) *map += *cloud;
    method->setInputTarget(filtered(map, kTargetLeaf));
  }
};

PclOdometry::PclOdometry(const std::string& method, const core::Pose& T_world_start)
    : state_(new State{registration(method), T_world_start, {}}) {}
PclOdometry::~PclOdometry() = default;
PclOdometry::PclOdometry(PclOdometry&&) noexcept = default;

core::Pose PclOdometry::process(const std::vector<core::Vec3f>& points_body, const core::Pose& guess) {
  Cloud::Ptr cloud(new Cloud);
  for (const core::Vec3f& p : points_body) cloud->push_back({p.x(), p.y(), p.z()});
  State& s = *state_;
  if (s.keyframes.empty()) {
    s.T_world_body = guess;
  } else {
    Cloud aligned;
    s.method->setInputSource(filtered(cloud, kSourceLeaf));
    s.method->align(aligned, matrix(guess));
    s.T_world_body = pose(s.method->getFinalTransformation());
  }
  if (s.keyframes.empty() || (s.keyframes.back().first - s.T_world_body.position).norm() > kKeyframeDistance)
    s.add_keyframe(filtered(cloud, kTargetLeaf));
  return s.T_world_body;
}

}  // namespace karst::bench
