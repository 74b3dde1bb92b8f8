#include "sdk/evaluation/map_error.h"

#include <cmath>
#include <limits>
#include <nanoflann.hpp>

namespace karst::evaluation {

using core::Vec3;
using core::Vec3f;

std::vector<Vec3> occupied_centres(const core::VoxelMap& map) {
  std::vector<Vec3> centres;
  centres.reserve(map.occupied_cells());
  map.for_each_known([&](const core::CellKey& k, core::Cell c, float) {
    if (c == core::Cell::occupied) centres.push_back(map.center_of(k));
  });
  return centres;
}

std::vector<double> map_errors(const std::vector<Vec3>& points,
                               const std::function<double(const Vec3&)>& distance_m) {
  std::vector<double> errors;
  errors.reserve(points.size());
  for (const Vec3& p : points)
    if (const double d = distance_m(p); std::isfinite(d)) errors.push_back(std::abs(d));
  return errors;
}

namespace {

struct Points {
  std::vector<Vec3f> points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

}  // namespace

struct NearestPoint::Tree {
  Points cloud;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>, Points, 3, std::uint32_t>
      index;
  explicit Tree(std::vector<Vec3f> p)
      : cloud{std::move(p)}, index(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(16)) {}
};

NearestPoint::NearestPoint(std::vector<Vec3f> points) : tree_(std::make_unique<Tree>(std::move(points))) {}
NearestPoint::~NearestPoint() = default;
NearestPoint::NearestPoint(NearestPoint&&) noexcept = default;

std::size_t NearestPoint::size() const { return tree_->cloud.points.size(); }

double NearestPoint::distance_m(const Vec3& p) const {
  const Vec3f query = p.cast<float>();
  if (size() == 0 || !query.allFinite()) return std::numeric_limits<double>::infinity();
  std::uint32_t index = 0;
  float squared = 0;
  tree_->index.knnSearch(query.data(), 1, &index, &squared);
  return (tree_->cloud.points[index].cast<double>() - p).norm();  // in double: floats lose millimetres
}

}  // namespace karst::evaluation
