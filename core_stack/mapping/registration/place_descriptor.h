// Rotation-invariant descriptor of the rock around a place, to find a place of one map in another or again in
// its own.
//
// About an axis through the place, space is divided into rings of width dr, slices of height dz and sectors;
// each cell holds how full of rock it is. With known gravity the axis is up; without, it is the rock's
// normal. A rotation about the axis shifts the sectors, so
// - the magnitudes of the Fourier series over the sectors are invariant: comparing them finds candidates;
// - the shift with the best agreement of two descriptors is their rotation. One match gives a full pose.
// (Shape contexts: Belongie et al. 2002; in 3D Frome et al. 2004; scan context: Kim and Kim 2018.)
#pragma once
#include <array>

#include "core_stack/common/geometry.h"
#include "core_stack/mapping/obstacles/point_tree.h"

namespace karst::core {

struct PlaceFrame {
  Vec3 position;
  Quat orientation;  // its z axis is the descriptor's axis
};

class PlaceDescriptor {
 public:
  static constexpr int kRings = 6, kSlices = 8, kSectors = 24, kHarmonics = 5;
  static constexpr int kCells = kRings * kSlices * kSectors;
  static constexpr int kInvariants = kRings * kSlices * kHarmonics;

  /// Uses those of `points` (evenly thinned) that lie around the frame: dr and dz are both `cell_m`.
  PlaceDescriptor(const PointTree& points, const PlaceFrame& frame, double cell_m);

  /// Unit length; invariant to rotations about the axis.
  const Eigen::Matrix<float, kInvariants, 1>& invariants() const { return invariants_; }
  /// Number of points in the cells.
  int count() const { return count_; }

  struct Turn {
    double angle_rad, agreement;  // agreement: the cosine, 1 if identical
  };
  /// The rotation of `other` about its axis that agrees best with this descriptor.
  Turn turn_of(const PlaceDescriptor& other) const;

 private:
  Eigen::Matrix<float, kRings * kSlices, kSectors> cells_;  // of unit norm
  Eigen::Matrix<float, kInvariants, 1> invariants_;
  int count_ = 0;
};

}  // namespace karst::core
