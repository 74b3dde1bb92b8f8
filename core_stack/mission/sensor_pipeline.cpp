#include "core_stack/mission/sensor_pipeline.h"

#include <array>
#include <cstdio>

#include "core_stack/mission/recording/picture_file.h"
#include "core_stack/perception/intensity_filter.h"

namespace karst::core {
namespace {

/// The latency from a scan's arrival to its pose: with the sensor's own delay of 20 ms, the scan ended 80 ms
/// before the estimate receives the pose.
constexpr TimeNs kLocalizationBudget = 60 * kMillisecond;
/// In real time, when mapping falls behind, messages beyond this queue length are not mapped. In lockstep no
/// more than a budget's worth waits.
constexpr int kMaxWaiting = 16;
/// Returns within this margin around the hull belong to the vehicle itself.
constexpr double kSelfMargin_m = 0.05;

}  // namespace

SensorPipeline::SensorPipeline(Onboard& onboard, Wiring wiring)
    : onboard_(onboard), wiring_(std::move(wiring)) {
  const CoreOptions& o = onboard.options;
  if (onboard.vehicle.lidar && o.localization.source == PoseSource::lidar)
    loam_.emplace(onboard.executive, Lane::localization, o.localization.loam, onboard.vehicle.T_world_start);
}

void SensorPipeline::on_lidar(std::shared_ptr<const LidarScan> scan) {
  scan = stamped_right(std::move(scan));
  if (!scan) return;
  const Estimator& estimator = onboard_.flight.estimator();
  if (scan->stamp - scan->model->period < estimator.track_lost_at()) return;
  if (!loam_) {
    if (!estimator.guesses()) map_scan(scan);  // else it would draw rock where there is none
    return;
  }
  note_gap();
  if (onboard_.executive.under_way("localization") > 1)
    return;  // in real time, when localization falls behind: late scans are useless
  if (sweeps_++ % 2 == 1 && onboard_.load.sheds(Relief::half_the_sweeps)) return;
  const double self_m = onboard_.vehicle.radius_m + kSelfMargin_m;
  loam_->job(
      "localization", kLocalizationBudget,
      [scan, history = onboard_.flight.estimator().history(), self_m, filter = onboard_.options.perception,
       effort =
           onboard_.load.sheds(Relief::half_the_features) ? LoamEffort::half : LoamEffort::full](Loam& loam) {
        // Only the paper's rule: robust matching copes with the remaining dust. The stricter filter of the
        // map loses true returns at edges and bumps, and triples the drift (docs/localization.md).
        LidarScan filtered = *scan;
        drop_weakest_returns(filtered, filter.percentile, filter.radius_m);
        return loam.process(to_sweep(filtered, self_m), history, effort);
      },
      [this, scan](const LoamPose& pose) {
        const bool accepted =
            pose.valid && onboard_.flight.on_lidar_pose({pose.stamp, pose.T_world_body, pose.covariance});
        note_localization(pose, accepted);
        // Without a known pose the scan would corrupt the map.
        if (accepted) map_scan(scan);
      });
}

/// Tells LOAM if since the last sweep nobody measured for a while what was flown.
void SensorPipeline::note_gap() {
  const TimeNs lost_at = onboard_.flight.estimator().track_lost_at();
  if (std::exchange(track_lost_at_, lost_at) != lost_at)
    loam_->job("gap", kLocalizationBudget, [](Loam& loam) { loam.note_gap(); });
}

/// The scan with a stamp that can be right; null if there is none.
std::shared_ptr<const LidarScan> SensorPipeline::stamped_right(std::shared_ptr<const LidarScan> scan) {
  const TimeNs before = lidar_clock_.correction();
  const std::optional<TimeNs> taken = lidar_clock_.taken_at(scan->stamp, onboard_.now());
  if (!taken) return nullptr;
  if (lidar_clock_.correction() != before)
    onboard_.recorder.write(
        onboard_.now(),
        event::Log{.text = lidar_clock_.correction() == 0
                               ? "the LiDAR's clock is right again"
                               : "the LiDAR's clock was set: the stamps of its scans are corrected",
                   .correction_s = seconds(lidar_clock_.correction())});
  if (*taken == scan->stamp) return scan;
  auto corrected = std::make_shared<LidarScan>(*scan);
  corrected->stamp = *taken;
  return corrected;
}

void SensorPipeline::on_pose(const PoseSample& s) {
  if (!loam_ && s.stamp <= onboard_.now()) onboard_.flight.on_pose(s);
}

/// Records the state in the events whenever it changes.
void SensorPipeline::note_localization(const LoamPose& pose, bool accepted) {
  const std::string state = !pose.valid                ? pose.problem
                            : !accepted                ? "the pose contradicts the IMU"
                            : pose.anew                ? pose.problem
                            : pose.free_directions > 0 ? std::to_string(pose.free_directions) +
                                                             " directions held from the prediction"
                                                       : "";
  in_first_map_ = in_first_map_ && !pose.anew;
  const Estimator& e = onboard_.flight.estimator();
  const Hypothesis believed = e.believed();
  onboard_.recorder.located({onboard_.now(), pose, accepted, e.active().position_sigma_m(),
                             e.active().heading_sigma_rad(), believed});
  if (state == localization_state_ && believed == believed_) return;
  localization_state_ = state;
  believed_ = believed;
  onboard_.recorder.write(onboard_.now(), event::Localization{.reason = state,
                                                              .valid = pose.valid,
                                                              .accepted = accepted,
                                                              .free_directions = pose.free_directions,
                                                              .believed = believed});
}

void SensorPipeline::map_scan(const std::shared_ptr<const LidarScan>& scan) {
  const unsigned every = onboard_.load.sheds(Relief::quarter_the_scans) ? 4
                         : onboard_.load.sheds(Relief::half_the_scans)  ? 2
                                                                        : 1;
  if (scans_++ % every != 0) return;
  integrate(SeenWith::lidar, scan->stamp,
            [scan, history = onboard_.flight.estimator().history(), filter = onboard_.options.perception,
             range_m = onboard_.options.mission.mapping_range_m,
             self_m = onboard_.vehicle.radius_m + kSelfMargin_m] {
              LidarScan filtered = *scan;
              filter_low_intensity(filtered, filter);
              return to_rays(filtered, history, self_m, range_m);
            });
}

void SensorPipeline::on_depth(const std::shared_ptr<const DepthImage>& image) {
  if (images_[image->model.get()]++ % 2 == 1 && onboard_.load.sheds(Relief::half_the_images)) return;
  if (onboard_.flight.estimator().guesses()) return;
  integrate(
      SeenWith::camera, image->stamp,
      [image, history = onboard_.flight.estimator().history(),
       self_m = onboard_.vehicle.radius_m + kSelfMargin_m] { return to_rays(*image, history, self_m); });
}

/// By now the pose is as accurate as it gets: scans of that moment have been located.
void SensorPipeline::on_rgb(const std::shared_ptr<const RgbFrame>& frame) {
  if (frame->stamp > onboard_.now() || !frame->model || closed_) return;
  if (onboard_.load.sheds(Relief::no_pictures) ||
      onboard_.executive.under_way("imaged surface") >= kMaxWaiting)
    return;
  const Pose T_world_camera =
      onboard_.flight.estimator().history().pose_at(frame->stamp) * frame->model->camera.T_body_camera;
  onboard_.map.job("imaged surface", kMappingBudget,
                   [T_world_camera](Explorer& explorer) { explorer.note_picture(T_world_camera); });
  std::string file;
  if (!frame->rgb.empty() && onboard_.executive.under_way("picture file") < kMaxWaiting) {
    std::array<char, 40> name;
    std::snprintf(name.data(), name.size(), "frames/%09.3f.jpg", seconds(frame->stamp));
    file = name.data();
    keep_picture(frame, file);
  } else if (!frame->rgb.empty() && pictures_lost_++ == 0) {
    onboard_.recorder.write(onboard_.now(),
                            event::Log{"pictures come faster than they can be written: some are not kept"});
  }
  onboard_.recorder.frame(*frame, T_world_camera, file);
}

/// Nothing waits for the picture; a write error costs the picture and a warning, not the flight.
void SensorPipeline::keep_picture(const std::shared_ptr<const RgbFrame>& frame, const std::string& file) {
  auto problem = std::make_shared<std::string>();
  onboard_.executive.job(
      "picture file", Lane::pictures, kSecond / 2,
      [frame, path = onboard_.recorder.directory() / file, problem] {
        try {
          write_jpeg(path, *frame);
        } catch (const std::exception& e) {
          *problem = e.what();
        }
      },
      [this, problem] {
        if (!problem->empty() && pictures_lost_++ == 0)
          onboard_.recorder.write(onboard_.now(), event::Log{*problem});
      });
}

void SensorPipeline::integrate(SeenWith sensor, TimeNs stamp, std::function<std::vector<Ray>()> make_rays) {
  if (closed_ || stamp > onboard_.now() || onboard_.executive.under_way("mapping") >= kMaxWaiting) return;
  struct Mapped {
    MapNews news;
    double explored_m3 = 0;
    std::optional<double> unsurveyed_m3;
    std::optional<double> hull_clearance_m;
  };
  onboard_.map.job(
      "mapping", kMappingBudget,
      [make_rays = std::move(make_rays), sensor, stamp, others = wiring_.others(stamp),
       look_for_others = wiring_.look_for_others(), here = onboard_.flight.state().position,
       question = wiring_.ask()](Explorer& explorer) {
        Mapped out;
        MapNews& news = out.news;
        std::vector<Ray> rays = make_rays();
        news.seen_with = sensor;
        news.stamp = stamp;
        if (look_for_others) news.bodies = bodies_in_the_air(explorer.map(), rays);
        leave_out(rays, others);
        news.changes = explorer.integrate(rays);
        out.explored_m3 = explorer.map().free_volume_m3();
        out.unsurveyed_m3 = explorer.unsurveyed_m3();
        const std::vector<Vec3>& ahead = question.ahead;
        if (ahead.size() > 1) {
          const int blocked = question.touch_only ? explorer.touching_segment(ahead)
                                                  : explorer.blocked_segment(ahead, question.narrow_places);
          if (blocked >= 0)
            news.blocked_after_m = path_length_m({ahead.begin(), ahead.begin() + blocked + 1});
        }
        out.hull_clearance_m = explorer.hull_clearance_m(here);
        if (question.descent_path) news.descent_path = descent_path(explorer.map(), *question.descent_path);
        news.frontier = question.frontier;
        if (news.frontier != 0) news.frontier_open = explorer.cluster_alive(news.frontier);
        return out;
      },
      [this](const Mapped& mapped) {
        explored_m3_ = mapped.explored_m3;
        unsurveyed_m3_ = mapped.unsurveyed_m3;
        hull_clearance_m_ = mapped.hull_clearance_m;
        last_seen_ = onboard_.now();
        wiring_.tell(mapped.news);
      });
}

}  // namespace karst::core
