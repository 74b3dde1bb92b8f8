// The knowledge of the cave: the map with its frontiers, the imaged rock surface, the roadmaps, and home. It
// integrates rays and plans paths.
//
// It runs on the map lane and does not change within a decision cycle.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "core_stack/mapping/frontiers/frontiers.h"
#include "core_stack/mapping/frontiers/imaged_surface.h"
#include "core_stack/mapping/prior/unsurveyed_volume.h"
#include "core_stack/mission/options/mission_options.h"
#include "core_stack/mission/world_model/clearance_roadmap.h"

namespace karst::core {

class WorldModel {
 public:
  WorldModel(const CoreOptions& options, const VehicleDescription& vehicle);

  /// Integrates one sensor's rays into the map; returns the changed cells.
  std::vector<CellChange> integrate(const std::vector<Ray>& rays);
  std::vector<CellChange> declare_launch_site(const Vec3& hover_point);
  /// Takes cells of an earlier map in where nothing is known yet; returns the changed cells.
  std::vector<CellChange> take_earlier(std::span<const CellValue> cells);
  /// Notes a picture of the vehicle's colour camera, taken from that pose.
  void note_picture(const Pose& T_world_camera);

  const VoxelMap& map() const { return map_; }
  const Frontiers& frontiers() const { return frontiers_; }
  /// Null if the vehicle has no colour camera.
  const ImagedSurface* imaged() const { return rgb_ ? &imaged_ : nullptr; }
  /// What the policy may know of a survey; null if that is nothing.
  const SurveyedPassages* survey() const { return survey_.told_to_policy ? survey_.passages.get() : nullptr; }
  /// Of the free cells, what the mission's survey lacks; none without a survey.
  std::optional<double> unsurveyed_m3() const {
    return unsurveyed_ ? std::optional(unsurveyed_->m3()) : std::nullopt;
  }
  const Vec3& home() const { return home_; }
  void set_home(const Vec3& hover_point) { home_ = hover_point; }

  // Each of these updates the roadmap that it returns.

  const ClearanceRoadmap& usual();
  bool allows_narrow() const { return narrow_clearance_m_.has_value(); }
  /// Created on first use; null if the mission does not allow narrow passages.
  const ClearanceRoadmap* narrow();
  /// The same, but null until it has been created.
  const ClearanceRoadmap* narrow_if_made() { return narrow_ ? narrow() : nullptr; }
  /// The roadmap for plans from `from`: inside a narrow passage, the one for narrow passages.
  const ClearanceRoadmap& roadmap_at(const Vec3& from);

  /// Plans along one roadmap, which must be up to date.
  Path plan(const ClearanceRoadmap& on, const Vec3& from, const Vec3& to) const;
  /// Plans a path home or around a new obstacle; through narrow passages if there is no other path.
  Path plan_to(const Vec3& from, const Vec3& to);
  /// Whether the region's greatest path length home is exceeded at a place, or on the way along points; also
  /// if no path home is known from the last one.
  bool too_far_from_home(const ClearanceRoadmap& on, const Vec3& p) const;
  bool leads_too_far(const ClearanceRoadmap& on, const std::vector<Vec3>& points) const;
  /// Total length of the parts of `path` in narrow passages, where flight is slow.
  double narrow_length_m(const Path& path) const;

 private:
  std::vector<CellChange> take_in(std::vector<CellChange> changes);

  double launch_clear_radius_m_;
  std::shared_ptr<const RgbCameraModel> rgb_;
  VoxelMap map_;
  Frontiers frontiers_;
  ImagedSurface imaged_;
  KnownSurvey survey_;
  std::optional<UnsurveyedVolume> unsurveyed_;
  ClearanceRoadmap usual_;
  std::optional<double> narrow_clearance_m_;  // if narrow passages may be flown
  std::optional<ClearanceRoadmap> narrow_;
  Vec3 home_;
};

}  // namespace karst::core
