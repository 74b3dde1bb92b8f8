// What the sensors say: scans are located, then they and depth images go into the map.
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core_stack/mapping/moving_bodies.h"
#include "core_stack/mission/mission_control.h"
#include "core_stack/mission/picture_file.h"
#include "core_stack/perception/intensity_filter.h"

namespace karst::core {
namespace {

/// A scan's pose counts this long after the scan came in: with the sensor's own delay of 20 ms the estimate
/// rests on a scan that ended 80 ms ago when the pose arrives.
constexpr TimeNs kLocalizationBudget = 60 * kMillisecond;
/// In real time, where mapping falls behind: what is seen beyond so many waiting messages is not mapped. In
/// lockstep no more than a budget's worth waits.
constexpr int kMostWaiting = 16;
/// Returns within this margin around the vehicle are the vehicle.
constexpr double kSelfMargin_m = 0.05;

}  // namespace

void MissionControl::on_lidar(std::shared_ptr<const LidarScan> scan) {
  if (scan->stamp > now()) return;  // of a clock gone wrong
  if (!loam_) return map_scan(std::move(scan));
  if (executive_.under_way("localization") > 1)
    return;  // in real time, where it falls behind: the newest scans are of no use if they are late
  auto pose = std::make_shared<LoamPose>();
  executive_.job(
      "localization", Lane::localization, kLocalizationBudget,
      [this, scan, pose, history = flight_.estimator().history(),
       self_m = description_.radius_m + kSelfMargin_m] {
        // Only the paper's rule: robust matching copes with the dust that is left. What makes the map clean
        // costs true returns at edges and bumps, and the drift grows threefold (docs/localization.md).
        LidarScan filtered = *scan;
        drop_weakest_returns(filtered, options_.perception.percentile, options_.perception.radius_m);
        *pose = loam_->process(to_sweep(filtered, self_m), history);
      },
      [this, scan, pose] {
        const bool accepted =
            pose->valid && flight_.on_lidar_pose({pose->stamp, pose->T_world_body, pose->covariance});
        note_localization(*pose, accepted);
        // What is not known where it was seen would spoil the map.
        if (accepted) map_scan(scan);
      });
}

/// Into the events, whenever it changes.
void MissionControl::note_localization(const LoamPose& pose, bool accepted) {
  const std::string state = !pose.valid                ? pose.problem
                            : !accepted                ? "the pose contradicts the IMU"
                            : pose.free_directions > 0 ? std::to_string(pose.free_directions) +
                                                             " directions held from the prediction"
                                                       : "";
  const Estimator& e = flight_.estimator();
  const std::string believed = e.believed();
  recorder_.located(
      {now(), pose, accepted, e.active().position_sigma_m(), e.active().heading_sigma_rad(), believed});
  if (state == localization_state_ && believed == believed_) return;
  localization_state_ = state, believed_ = believed;
  recorder_.event(now(), "localization",
                  {{"valid", pose.valid},
                   {"accepted", accepted},
                   {"free_directions", pose.free_directions},
                   {"believed", believed},
                   {"reason", state}});
}

void MissionControl::map_scan(std::shared_ptr<const LidarScan> scan) {
  integrate([scan, history = flight_.estimator().history(), options = options_,
             others = others_at(scan->stamp), self_m = description_.radius_m + kSelfMargin_m] {
    LidarScan filtered = *scan;
    filter_low_intensity(filtered, options.perception);
    std::vector<Ray> rays = to_rays(filtered, history, self_m, options.mission.mapping_range_m);
    leave_out(rays, others);
    return rays;
  });
}

void MissionControl::on_depth(std::shared_ptr<const DepthImage> image) {
  integrate([image, history = flight_.estimator().history(), others = others_at(image->stamp),
             radius = description_.radius_m] {
    std::vector<Ray> rays = to_rays(*image, history, radius + kSelfMargin_m);
    leave_out(rays, others);
    return rays;
  });
}

/// Where it was taken is known as well as it can be: scans of that moment have been located since.
void MissionControl::on_rgb(std::shared_ptr<const RgbFrame> frame) {
  if (frame->stamp > now() || !frame->model || emergency_) return;
  const Pose T_world_camera =
      flight_.estimator().history().pose_at(frame->stamp) * frame->model->camera.T_body_camera;
  executive_.job(
      "imaged surface", Lane::map, kMappingBudget,
      [this, T_world_camera] { explorer_.note_picture(T_world_camera); }, [] {});
  std::string file;
  if (!frame->rgb.empty() && executive_.under_way("picture file") < kMostWaiting) {
    std::array<char, 40> name;
    std::snprintf(name.data(), name.size(), "frames/%09.3f.jpg", seconds(frame->stamp));
    file = name.data();
    keep_picture(frame, file);
  } else if (!frame->rgb.empty() && pictures_lost_++ == 0) {
    recorder_.event(now(), "log",
                    {{"text", "pictures come faster than they can be written: some are not kept"}});
  }
  recorder_.frame(*frame, T_world_camera, file);
}

/// Nothing waits for it; a disk that refuses costs the picture and a warning, not the flight.
void MissionControl::keep_picture(const std::shared_ptr<const RgbFrame>& frame, const std::string& file) {
  auto problem = std::make_shared<std::string>();
  executive_.job(
      "picture file", Lane::pictures, kSecond / 2,
      [frame, path = recorder_.directory() / file, problem] {
        try {
          write_jpeg(path, *frame);
        } catch (const std::exception& e) {
          *problem = e.what();
        }
      },
      [this, problem] {
        if (!problem->empty() && pictures_lost_++ == 0) recorder_.event(now(), "log", {{"text", *problem}});
      });
}

void MissionControl::integrate(std::function<std::vector<Ray>()> make_rays) {
  if (emergency_ || executive_.under_way("mapping") >= kMostWaiting) return;
  struct Result {
    std::vector<CellChange> changes;
    double explored_m3 = 0;
    std::optional<double> blocked_after_m, hull_clearance_m;
    bool goal_alive = true;
  };
  auto result = std::make_shared<Result>();
  const std::uint32_t frontier = goal_ ? goal_->frontier_id : 0;
  const bool check = phase_ == Phase::takeoff || phase_ == Phase::explore || phase_ == Phase::home;
  executive_.job(
      "mapping", Lane::map, kMappingBudget,
      [this, result, frontier, make_rays = std::move(make_rays), here = flight_.state().position,
       ahead = check ? path_ahead() : std::vector<Vec3>{}, narrow = narrow_places_,
       as_come = flying_as_come_] {
        result->changes = explorer_.integrate(make_rays());
        result->explored_m3 = explorer_.map().free_volume_m3();
        if (ahead.size() > 1)
          if (const int blocked =
                  as_come ? explorer_.touching_segment(ahead) : explorer_.blocked_segment(ahead, narrow);
              blocked >= 0)
            result->blocked_after_m = path_length_m({ahead.begin(), ahead.begin() + blocked + 1});
        result->hull_clearance_m = explorer_.hull_clearance_m(here);
        if (frontier != 0) result->goal_alive = explorer_.cluster_alive(frontier);
      },
      [this, result, frontier] {
        explored_m3_ = result->explored_m3;
        hull_clearance_m_ = result->hull_clearance_m;
        last_seen_ = now();
        const bool same_goal = goal_ && goal_->frontier_id == frontier;
        on_map_update(result->changes, result->blocked_after_m, result->goal_alive || !same_goal);
      });
}

}  // namespace karst::core
