// How well two maps fit when one is transformed to the other.
#pragma once
#include "core_stack/mapping/registration/map_piece.h"

namespace karst::core {

/// Counts of one piece's surface points in the other map: `near` its rock, `in_free` in its known free space;
/// the rest lies in space unknown to the other map.
struct OverlayCounts {
  std::size_t points = 0, near = 0, in_free = 0;
  double squares_m2 = 0;  // sum of the squared near distances
};

struct Overlay {
  OverlayCounts source_in_target, target_in_source;

  /// Fractions of each map's rock that lies on the other's.
  double source_overlap() const;
  double target_overlap() const;
  double overlap() const { return std::max(source_overlap(), target_overlap()); }  // of the smaller part
  /// Of the rock in space known to the other map, the fraction that agrees; 1 if neither knows free space.
  double agreement() const;
  double residual_m() const;  // root mean square of the near distances
  std::size_t near() const { return source_in_target.near + target_in_source.near; }
  /// Near rock less rock in free space, which has a larger weight.
  double score() const;
};

struct OverlayOptions {
  double near_cells = 1.75;  // of the coarser map: nearer rock counts as the same
  double free_cells = 3.0;   // rock in a free cell and this far from rock contradicts
  // ... only if the six cells beside the free one are free, too: rays that graze rock free cells of it
  // where the scans of one place have not hit it.
  bool free_beside = false;
  std::size_t max_points = 20000;  // of each map, evenly picked
};

Overlay overlay(const MapPiece& target, const MapPiece& source, const Pose& T_target_source,
                const OverlayOptions& options);

/// A quick score for very many poses: the target's thickened rock and its free space, in cells of `cell_m`.
class RoughTarget {
 public:
  RoughTarget(const MapPiece& target, double cell_m);
  /// (points in rock - 2 * points in free space) / number of points.
  double score(const std::vector<Vec3>& source_points, const Pose& T_target_source) const;

 private:
  VoxelMap cells_;
};

}  // namespace karst::core
