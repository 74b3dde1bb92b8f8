#include "plugins/lidar_drivers/ouster_receiver.h"

#include "plugins/lidar_drivers/ouster/imu_packet.h"

namespace karst::lidar {

OusterReceiver::OusterReceiver(const OusterMetadata& metadata, const core::Pose& T_body_sensor,
                               std::unique_ptr<PacketSource> lidar, std::unique_ptr<PacketSource> imu,
                               StampSource stamps)
    : model_(std::make_shared<const core::LidarModel>(lidar_model(metadata, T_body_sensor))),
      assembler_(metadata, model_),
      lidar_(std::move(lidar)),
      imu_(std::move(imu)),
      stamps_(std::move(stamps)),
      R_body_imu_(T_body_sensor.orientation * pose_of(metadata.imu_to_sensor).orientation) {}

void OusterReceiver::take_imu_packet(PacketView packet) {
  auto sample = read_ouster_imu(packet);
  if (!sample) {
    ++foreign_imu_;
    return;
  }
  const std::int64_t sensor_ns = std::exchange(sample->stamp, 0);
  const auto stamp = stamps_.at(sensor_ns);
  if (!stamp || sensor_ns == last_imu_ns_)
    return;  // a duplicate; or no scan has told the offset of the clock yet
  last_imu_ns_ = sensor_ns;
  imu_samples_.push_back(
      {*stamp, R_body_imu_ * sample->specific_force_mps2, R_body_imu_ * sample->body_rate_radps});
}

std::vector<std::shared_ptr<const core::LidarScan>> OusterReceiver::poll(core::TimeNs now) {
  stamps_.begin_poll(now);
  imu_samples_.clear();
  lidar_->receive([&](PacketView packet) {
    if (const auto sensor_ns = assembler_.take(packet, now)) stamps_.observe(*sensor_ns);
  });
  if (imu_) imu_->receive([this](PacketView packet) { take_imu_packet(packet); });
  std::vector<std::shared_ptr<const core::LidarScan>> scans;
  for (RawSweep& sweep : assembler_.closed(now)) {
    const auto stamp = stamps_.at(sweep.sensor_ns);
    if (!stamp) continue;
    sweep.scan.stamp = *stamp;
    scans.push_back(std::make_shared<const core::LidarScan>(std::move(sweep.scan)));
  }
  return scans;
}

PacketCounts OusterReceiver::counts() const {
  PacketCounts out = assembler_.counts();
  out.foreign += foreign_imu_;
  return out;
}

}  // namespace karst::lidar
