#include "plugins/lidar_drivers/livox/frame_assembler.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "plugins/lidar_drivers/packet/range_corrected.h"

namespace karst::lidar {
namespace {

constexpr int kFrameOvertaking = 4;  // packets of the next frame that close one
constexpr core::TimeNs kFrameSilence =
    20 * core::kMillisecond;  // without a packet, after which a frame is closed
constexpr std::int64_t kMaxLostFrames = 600;
constexpr int kFrameRestart = 5;             // packets in a row of another time: the clock was set
constexpr std::size_t kMaxPoints = 400'000;  // of a frame: twenty times what a Mid-360 sends
constexpr float kFullReflectivity = 150;  // of a diffuse surface; more are retroreflectors (user manual v1.2)

/// Whether the sensor doubts a point: low confidence that it is not between two surfaces, or not rain or
/// dust.
bool is_doubtful(std::uint8_t tag) { return (tag & 3) == 2 || (tag >> 2 & 3) == 2; }

}  // namespace

core::LidarModel mid360_model(const core::Pose& T_body_sensor) {
  constexpr float kRadians = std::numbers::pi_v<float> / 180;
  core::LidarModel model;
  model.name = "mid360";
  model.elevation_rad = {52 * kRadians, -7 * kRadians};
  model.min_range_m = 0.1f;
  model.max_range_m = 70;
  model.T_body_lidar = T_body_sensor;
  return model;
}

LivoxFrameAssembler::LivoxFrameAssembler(std::shared_ptr<const core::LidarModel> model)
    : model_(std::move(model)) {}

std::optional<std::int64_t> LivoxFrameAssembler::take(PacketView packet, core::TimeNs now) {
  LivoxHeader h;
  const LivoxVerdict verdict = read_livox_header(packet, h);
  if (verdict == LivoxVerdict::foreign || (verdict == LivoxVerdict::good && h.data == LivoxData::imu)) {
    ++counts_.foreign;
    return std::nullopt;
  }
  if (verdict == LivoxVerdict::damaged) {
    ++counts_.malformed;
    return std::nullopt;
  }
  const auto begin = static_cast<std::int64_t>(h.timestamp_ns);
  const std::int64_t end = begin + h.point_ns(h.points - 1u);
  const std::int64_t first = begin / model_->period, last = end / model_->period;
  if (!open_) open_ = first;
  if (last < *open_ || first > *open_ + 1) {  // it is late, frames were lost, or the clock was set
    const bool late = last < *open_ && last >= *open_ - 2;
    if (late) {
      ++counts_.late;
      return std::nullopt;
    }
    if (++strange_ < kFrameRestart) {
      ++counts_.malformed;
      return std::nullopt;
    }
    close(*open_);
    points_.clear();
    if (first > *open_ && first - *open_ <= kMaxLostFrames)
      counts_.lost_scans += static_cast<std::uint64_t>(first - *open_);
    open_ = first;
  }
  strange_ = 0;
  if (sequence_.take(h.count) == Sequence::Arrival::duplicate) {
    ++counts_.late;
    return std::nullopt;
  }
  ++counts_.packets;
  last_packet_ = now;
  for (std::size_t i = 0; i < h.points && points_.size() < kMaxPoints; ++i) {
    const LivoxPoint p = livox_point(packet, h, i);
    const float range_m = p.position.norm();
    if (!(range_m >= model_->min_range_m) || is_doubtful(p.tag)) continue;
    const float reflectivity = std::min(static_cast<float>(p.reflectivity) / kFullReflectivity, 1.0f);
    points_.push_back(
        {begin + h.point_ns(i), p.position / range_m, range_m, reflectivity / intensity_fall_off(range_m)});
  }
  if (last > *open_ && ++packets_of_next_ >= kFrameOvertaking) close(*open_);
  return end;
}

/// The frame becomes a scan, and the next is open.
void LivoxFrameAssembler::close(std::int64_t frame) {
  const std::int64_t stamp = (frame + 1) * model_->period;
  std::stable_sort(points_.begin(), points_.end(),
                   [](const Point& a, const Point& b) { return a.sensor_ns < b.sensor_ns; });
  const auto next =
      std::find_if(points_.begin(), points_.end(), [&](const Point& p) { return p.sensor_ns >= stamp; });
  RawFrame out{stamp, {}};
  out.scan.model = model_;
  for (auto p = points_.begin(); p != next; ++p) {
    out.scan.range_m.push_back(p->range_m);
    out.scan.intensity.push_back(p->intensity);
    out.scan.direction.push_back(p->direction);
    out.scan.time_s.push_back(static_cast<float>(core::seconds(p->sensor_ns - stamp)));
  }
  points_.erase(points_.begin(), next);
  open_ = frame + 1;
  packets_of_next_ = 0;
  if (out.scan.range_m.empty()) return;
  ++counts_.scans;
  closed_.push_back(std::move(out));
}

std::vector<RawFrame> LivoxFrameAssembler::closed(core::TimeNs now) {
  if (open_ && !points_.empty() && now - last_packet_ > kFrameSilence) close(*open_);
  return std::exchange(closed_, {});
}

PacketCounts LivoxFrameAssembler::counts() const {
  PacketCounts out = counts_;
  out.lost = sequence_.lost();
  return out;
}

}  // namespace karst::lidar
