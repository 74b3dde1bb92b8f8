// What the rock around a place looks like, whichever way one faces: to find a place of one map in another.
//
// About an axis through the place, space is cut into rings of width dr, slices of height dz and sectors; each
// cell says how full of rock it is. With gravity known the axis is up; without, it is the rock's normal.
// Turning about the axis shifts the sectors, so
// - the magnitudes of the Fourier series over the sectors do not change: comparing them finds candidates;
// - the shift at which two descriptors agree best is the turn between them. One match is a full pose.
// (Shape contexts: Belongie et al. 2002; in 3D Frome et al. 2004; scan context: Kim and Kim 2018.)
#pragma once
#include <array>

#include "sdk/map_merge/map_piece.h"

namespace karst::map_merge {

struct PlaceFrame {
  core::Vec3 position;
  core::Quat orientation;  // its z axis is the axis
};

class PlaceDescriptor {
 public:
  static constexpr int kRings = 6, kSlices = 8, kSectors = 24, kHarmonics = 5;
  static constexpr int kCells = kRings * kSlices * kSectors;
  static constexpr int kInvariants = kRings * kSlices * kHarmonics;

  /// Of `points` (thinned out evenly), those around the frame: dr and dz are both `cell_m`.
  PlaceDescriptor(const core::PointTree& points, const PlaceFrame& frame, double cell_m);

  /// Unit length; unchanged by turns about the axis.
  const Eigen::Matrix<float, kInvariants, 1>& invariants() const { return invariants_; }
  /// Points that fell into the cells.
  int count() const { return count_; }

  struct Turn {
    double angle_rad, agreement;  // agreement: the cosine, 1 if the same
  };
  /// By how much `other` has to turn about its axis to look like this.
  Turn turn_of(const PlaceDescriptor& other) const;

 private:
  Eigen::Matrix<float, kRings * kSlices, kSectors> cells_;  // of unit norm
  Eigen::Matrix<float, kInvariants, 1> invariants_;
  int count_ = 0;
};

}  // namespace karst::map_merge
