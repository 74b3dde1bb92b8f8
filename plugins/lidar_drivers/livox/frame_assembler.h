// Joins the points of Livox packets to frames of a fixed length: the Mid-360 has no revolutions to tell where
// a sweep ends. Frame k holds the points measured from k T on, until (k + 1) T, by the sensor's clock.
#pragma once
#include <vector>

#include "plugins/lidar_drivers/livox/packet.h"
#include "plugins/lidar_drivers/packet/packet_counts.h"
#include "plugins/lidar_drivers/packet/sequence.h"

namespace karst::lidar {

/// The Mid-360: 360 x 59 degrees, 0.1 to 70 m; frames of a tenth of a second.
core::LidarModel mid360_model(const core::Pose& T_body_sensor);

/// A frame whose stamp is by the sensor's clock.
struct RawFrame {
  std::int64_t sensor_ns = 0;  // of the stamp
  core::LidarScan scan;        // its stamp is 0
};

class LivoxFrameAssembler {
 public:
  explicit LivoxFrameAssembler(std::shared_ptr<const core::LidarModel> model);

  /// Takes in a packet of points that came at `now`. Returns the time of its last point by the sensor's
  /// clock; none if the packet was ignored.
  std::optional<std::int64_t> take(PacketView packet, core::TimeNs now);
  /// The frames closed by now, oldest first.
  std::vector<RawFrame> closed(core::TimeNs now);
  PacketCounts counts() const;

 private:
  struct Point {
    std::int64_t sensor_ns;
    core::Vec3f direction;
    float range_m, intensity;
  };

  void close(std::int64_t frame);

  std::shared_ptr<const core::LidarModel> model_;
  Sequence sequence_;
  std::vector<Point> points_;         // of the open frame, and of what has come of the next
  std::optional<std::int64_t> open_;  // number of the open frame
  std::vector<RawFrame> closed_;
  int packets_of_next_ = 0, strange_ = 0;
  core::TimeNs last_packet_ = 0;
  PacketCounts counts_;
};

}  // namespace karst::lidar
