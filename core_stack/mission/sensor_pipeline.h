// From the sensors to the map: LOAM locates each scan, its pose goes into the state estimate, and its rays go
// into the map. Images are integrated at their estimated poses.
#pragma once
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/homing/landing/descent_path.h"
#include "core_stack/localization/loam.h"
#include "core_stack/mapping/occupancy/moving_bodies.h"
#include "core_stack/mission/onboard/onboard.h"
#include "core_stack/mission/state/seen_with.h"
#include "core_stack/perception/scan_clock.h"
#include "core_stack/vehicle/vehicle.h"

namespace karst::core {

/// Queries answered as soon as new rays are in the map.
struct MapQuestion {
  std::vector<Vec3> ahead;                   // the trajectory that must be clear; may be empty
  std::vector<Vec3> narrow_places;           // near which less clearance suffices
  bool touch_only = false;                   // only a collision counts, not a lack of clearance
  std::uint32_t frontier = 0;                // of the current goal; 0: none
  std::optional<DescentQuery> descent_path;  // for a vehicle that may have to land at once
};

struct MapNews {
  SeenWith seen_with = SeenWith::lidar;
  std::vector<CellChange> changes;
  std::optional<double> blocked_after_m;  // along `ahead`
  std::vector<Vec3> descent_path;         // as asked
  std::uint32_t frontier = 0;             // as asked
  bool frontier_open = true;              // it is worth flying to
  TimeNs stamp = 0;                       // of what was seen
  std::vector<Vec3> bodies;               // in the air, where there was nothing before
};

class SensorPipeline {
 public:
  struct Wiring {
    std::function<MapQuestion()> ask;
    std::function<void(const MapNews&)> tell;
    /// Other vehicles, where they were at that time: what is seen of them is no rock.
    std::function<std::vector<MovingBody>(TimeNs stamp)> others;
    /// Whether to look for vehicles whose place is not known.
    std::function<bool()> look_for_others;
  };
  SensorPipeline(Onboard& onboard, Wiring wiring);

  /// A scan of which it is not known when it was taken is not used.
  void on_lidar(std::shared_ptr<const LidarScan> scan);
  void on_depth(const std::shared_ptr<const DepthImage>& image);
  void on_rgb(const std::shared_ptr<const RgbFrame>& frame);
  /// Used only if no LiDAR locates the vehicle.
  void on_pose(const PoseSample& s);
  /// Stops mapping: the flight ends without the map.
  void close() { closed_ = true; }

  double explored_m3() const { return explored_m3_; }
  /// What of it the mission's survey lacks; none without a survey.
  const std::optional<double>& unsurveyed_m3() const { return unsurveyed_m3_; }
  /// Of the hull from the nearest obstacle, if that is near.
  const std::optional<double>& hull_clearance_m() const { return hull_clearance_m_; }
  /// Time since the last scan or image in the map.
  TimeNs blind_for() const { return onboard_.now() - last_seen_; }
  /// Resets blind_for() on the ground, where the sensors may see nothing.
  void see_nothing_needed() { last_seen_ = onboard_.now(); }
  /// Poses are of the map that the flight began with: localization has never had to begin another.
  bool located_in_first_map() const { return in_first_map_; }

 private:
  void note_gap();
  std::shared_ptr<const LidarScan> stamped_right(std::shared_ptr<const LidarScan> scan);
  void note_localization(const LoamPose& pose, bool accepted);
  void keep_picture(const std::shared_ptr<const RgbFrame>& frame, const std::string& file);
  void map_scan(const std::shared_ptr<const LidarScan>& scan);
  void integrate(SeenWith sensor, TimeNs stamp, std::function<std::vector<Ray>()> make_rays);

  Onboard& onboard_;
  Wiring wiring_;
  std::optional<LaneBound<Loam>> loam_;  // on vehicles that a LiDAR locates
  ScanClock lidar_clock_;
  TimeNs track_lost_at_ = std::numeric_limits<TimeNs>::min();  // as LOAM was told
  bool in_first_map_ = true;
  bool closed_ = false;
  double explored_m3_ = 0;
  std::optional<double> unsurveyed_m3_;
  std::optional<double> hull_clearance_m_;
  TimeNs last_seen_ = 0;             // when a scan or an image was last taken in
  int pictures_lost_ = 0;            // not kept
  unsigned sweeps_ = 0, scans_ = 0;  // that came to be located, to be mapped
  std::map<const CameraModel*, unsigned> images_;
  std::string localization_state_;  // as last noted in the events, as the next
  Hypothesis believed_ = Hypothesis::lidar;
};

}  // namespace karst::core
