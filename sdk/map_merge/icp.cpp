#include "sdk/map_merge/icp.h"

#include <pcl/common/transforms.h>
#include <pcl/console/print.h>
#include <pcl/point_types.h>
#include <pcl/registration/icp.h>

namespace karst::map_merge {
namespace {

using core::Pose;
using core::Quat;
using core::Vec3;

using PclCloud = pcl::PointCloud<pcl::PointNormal>;

/// Every n-th point, at most `most`. Relative to the map's middle, because PCL's single precision would lose
/// centimetres far from the origin.
PclCloud::Ptr pcl_cloud(const MapPiece& piece, const Vec3& middle, std::size_t most) {
  auto cloud = std::make_shared<PclCloud>();
  const std::size_t stride = (piece.surface.size() + most - 1) / most;
  for (std::size_t i = 0; i < piece.surface.size(); i += stride) {
    pcl::PointNormal p;
    p.getVector3fMap() = (piece.surface[i].cast<double>() - middle).cast<float>();
    p.getNormalVector3fMap() = piece.normals[i];
    cloud->push_back(p);
  }
  return cloud;
}

Pose pose_of(const Eigen::Matrix4f& T) {
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>().cast<double>();
  return {T.topRightCorner<3, 1>().cast<double>(), Quat(R).normalized()};
}

}  // namespace

bool has_icp() { return true; }

struct Icp::Storage {
  Vec3 middle;
  PclCloud::Ptr target;
  pcl::search::KdTree<pcl::PointNormal>::Ptr tree = std::make_shared<pcl::search::KdTree<pcl::PointNormal>>();
};

Icp::Icp(const MapPiece& target) : storage_(std::make_unique<Storage>()) {
  storage_->middle = target.surface[target.surface.size() / 2].cast<double>();
  storage_->target = pcl_cloud(target, storage_->middle, target.surface.size());
  storage_->tree->setInputCloud(storage_->target);
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);  // its warnings are covered by our own verdict
}
Icp::~Icp() = default;

Pose Icp::refine(const MapPiece& source, const Pose& T_target_source,
                 const std::vector<IcpRound>& rounds) const {
  const Pose to_middle{-storage_->middle, Quat::Identity()};
  Pose T = to_middle * T_target_source;
  for (const IcpRound& round : rounds) {
    PclCloud::Ptr moved = pcl_cloud(source, Vec3::Zero(), round.max_points);
    for (pcl::PointNormal& p : *moved) {
      p.getVector3fMap() = (T * p.getVector3fMap().cast<double>()).cast<float>();
      p.getNormalVector3fMap() = (T.orientation * p.getNormalVector3fMap().cast<double>()).cast<float>();
    }
    pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> icp;
    icp.setSearchMethodTarget(storage_->tree, true);
    icp.setInputTarget(storage_->target);
    icp.setInputSource(moved);
    icp.setMaxCorrespondenceDistance(round.correspondence_m);
    icp.setMaximumIterations(round.iterations);
    icp.setTransformationEpsilon(1e-8);
    icp.setEuclideanFitnessEpsilon(1e-9);
    PclCloud ignored;
    icp.align(ignored);
    const Eigen::Matrix4f step = icp.getFinalTransformation();
    if (!step.allFinite()) break;
    T = pose_of(step) * T;
  }
  return to_middle.inverse() * T;
}

}  // namespace karst::map_merge
