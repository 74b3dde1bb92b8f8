// Points in the form that nanoflann expects.
#pragma once
#include <cstdint>
#include <nanoflann.hpp>
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::core {

struct KdPoints {
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

using KdIndex = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, KdPoints>, KdPoints,
                                                    3, std::uint32_t>;

}  // namespace karst::core
