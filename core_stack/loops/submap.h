// Submaps: the rock around a few metres of the flown path, each in a frame of its own.
//
// A recording becomes a chain of submaps. What the vehicle saw within one is taken as rigid; what has drifted
// lies between them. Only sweeps from new places are added, so that a vehicle that hovers costs nothing.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core_stack/common/options.h"
#include "core_stack/common/time.h"
#include "core_stack/mapping/registration/place_descriptor.h"

namespace karst::core {

struct SubmapOptions {
  double length_m = 2;          // of the path in one submap
  double keyframe_m = 0.4;      // between sweeps that are added
  double range_m = 20;          // of the points, from the sensor
  double voxel_m = 0.2;         // one point is kept in each
  double place_distance_m = 1;  // along the path, between described places
  double place_cell_m = 1.5;    // of the descriptors
};
void describe(OptionTable& t, SubmapOptions& o);

/// A described place of a submap.
struct Place {
  Vec3 position;  // frame of the submap
  PlaceDescriptor descriptor;
};

/// Frame: the body's position and heading at the first sweep, z up.
struct Submap {
  Pose T_world_submap;  // by odometry
  Pose T_submap_body;   // at the first sweep: roll and pitch
  TimeNs first = 0, last = 0;
  double path_begin_m = 0, path_end_m = 0;  // along the whole flown path
  double uncertainty_m = 0;                 // of the odometry, accumulated up to here
  bool observed = true;                     // false: a direction was not observed on the way to the next one
  std::vector<std::array<std::int16_t, 3>> packed;  // points in centimetres
  std::vector<Vec3f> flown;                         // positions of the sensor at the sweeps
  std::vector<Place> places;

  std::vector<Vec3f> points() const;
  std::size_t bytes() const;
};

/// Points in the frame of the submap; those farther than 327 m are lost.
std::vector<std::array<std::int16_t, 3>> packed(const std::vector<Vec3f>& points);

/// The places along `flown`, with enough rock around. Each lies in the middle of the rock around it (mean
/// shift), so that it does not depend on which side of the passage the vehicle flew.
std::vector<Place> described_places(const std::vector<Vec3f>& points, const std::vector<Vec3f>& flown,
                                    const SubmapOptions& options);

/// Cuts what is seen along the path into submaps.
class SubmapBuilder {
 public:
  explicit SubmapBuilder(const SubmapOptions& options) : options_(options) {}

  struct Seen {
    TimeNs stamp = 0;
    Pose T_world_body;
    bool observed = true;              // in all directions
    double further_uncertainty_m = 0;  // since the last one
    const std::vector<Vec3f>* points_world = nullptr;
  };
  /// The submap that is complete with this sweep, if one is.
  std::optional<Submap> add(const Seen& seen);
  /// The submap that has been begun, if it holds a sweep.
  std::optional<Submap> finish();

 private:
  Submap completed();

  SubmapOptions options_;
  std::optional<Submap> open_;
  std::vector<Vec3f> points_;  // of the open submap, in its frame
  std::optional<Vec3> last_;
  double path_m_ = 0, uncertainty_m_ = 0, keyframe_path_m_ = 0;
};

}  // namespace karst::core
