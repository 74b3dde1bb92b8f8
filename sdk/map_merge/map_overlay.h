// How well two maps fit when one is laid on the other.
#pragma once
#include "sdk/map_merge/map_piece.h"

namespace karst::map_merge {

/// One piece's surface in the other: `near` its rock, `in_free` space where the other knows there is none,
/// and the rest where it has not looked.
struct OverlayCounts {
  std::size_t points = 0, near = 0, in_free = 0;
  double squares_m2 = 0;  // of the distances of the near ones
};

struct Overlay {
  OverlayCounts source_in_target, target_in_source;

  /// Shares of each map's rock that lies on the other's.
  double source_overlap() const;
  double target_overlap() const;
  double overlap() const { return std::max(source_overlap(), target_overlap()); }  // of the smaller part
  /// Of the rock that the other map can judge, the share it agrees with; 1 if neither knows free space.
  double agreement() const;
  double residual_m() const;  // root mean square of the near distances
  std::size_t near() const { return source_in_target.near + target_in_source.near; }
  /// Rock in place less rock in free space, which weighs more.
  double score() const;
};

struct OverlayOptions {
  double near_cells = 1.75;        // of the coarser map: rock so near to rock is the same
  double free_cells = 3.0;         // rock in a free cell, and so far from rock, contradicts
  std::size_t max_points = 20000;  // of each map, evenly picked
};

Overlay overlay(const MapPiece& target, const MapPiece& source, const core::Pose& T_target_source,
                const OverlayOptions& options);

/// A quick look for very many poses: the target's rock thickened and its free space, in cells of `cell_m`.
class RoughTarget {
 public:
  RoughTarget(const MapPiece& target, double cell_m);
  /// Points in rock less those in free space, which weigh double, over the number of points.
  double score(const std::vector<core::Vec3>& source_points, const core::Pose& T_target_source) const;

 private:
  core::VoxelMap cells_;
};

}  // namespace karst::map_merge
