#include "plugins/lidar_drivers/livox_receiver.h"

namespace karst::lidar {

LivoxReceiver::LivoxReceiver(const core::Pose& T_body_sensor, std::unique_ptr<PacketSource> points,
                             std::unique_ptr<PacketSource> imu, StampSource stamps)
    : model_(std::make_shared<const core::LidarModel>(mid360_model(T_body_sensor))),
      assembler_(model_),
      points_(std::move(points)),
      imu_(std::move(imu)),
      stamps_(std::move(stamps)) {}

void LivoxReceiver::take_imu_packet(PacketView packet) {
  LivoxHeader header;
  const bool good = read_livox_header(packet, header) == LivoxVerdict::good;
  const auto sample = good ? livox_imu(packet, header) : std::nullopt;
  if (!sample) {
    ++foreign_imu_;
    return;
  }
  const auto stamp = stamps_.at(sample->stamp);
  if (!stamp || sample->stamp == last_imu_ns_)
    return;  // a duplicate; or no point has told the offset of the clock
  last_imu_ns_ = sample->stamp;
  const core::Quat& R_body_imu = model_->T_body_lidar.orientation;
  imu_samples_.push_back(
      {*stamp, R_body_imu * sample->specific_force_mps2, R_body_imu * sample->body_rate_radps});
}

std::vector<std::shared_ptr<const core::LidarScan>> LivoxReceiver::poll(core::TimeNs now) {
  stamps_.begin_poll(now);
  imu_samples_.clear();
  points_->receive([&](PacketView packet) {
    if (const auto sensor_ns = assembler_.take(packet, now)) stamps_.observe(*sensor_ns);
  });
  if (imu_) imu_->receive([this](PacketView packet) { take_imu_packet(packet); });
  std::vector<std::shared_ptr<const core::LidarScan>> scans;
  for (RawFrame& frame : assembler_.closed(now)) {
    const auto stamp = stamps_.at(frame.sensor_ns);
    if (!stamp) continue;
    frame.scan.stamp = *stamp;
    scans.push_back(std::make_shared<const core::LidarScan>(std::move(frame.scan)));
  }
  return scans;
}

PacketCounts LivoxReceiver::counts() const {
  PacketCounts out = assembler_.counts();
  out.foreign += foreign_imu_;
  return out;
}

}  // namespace karst::lidar
