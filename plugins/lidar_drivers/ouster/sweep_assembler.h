// Joins the columns of Ouster's lidar packets to sweeps.
//
// Two sweeps are open at most: the newest, and the one before, whose last packets may have been overtaken. A
// sweep is closed when it is complete, when some packets of the next have come, or when none has come for a
// while. What is missing stays NaN, as does a pixel without a return: the sensor does not say why there is
// none.
#pragma once
#include <vector>

#include "plugins/lidar_drivers/ouster/packet_layout.h"
#include "plugins/lidar_drivers/packet/packet_counts.h"

namespace karst::lidar {

/// A sweep whose stamp is by the sensor's clock.
struct RawSweep {
  std::int64_t sensor_ns = 0;  // of the stamp
  core::LidarScan scan;        // its stamp is 0
};

class OusterSweepAssembler {
 public:
  OusterSweepAssembler(const OusterMetadata& metadata, std::shared_ptr<const core::LidarModel> model);

  /// Takes in a packet that came at `now`. Returns the time of its last column by the sensor's clock; none if
  /// the packet was ignored.
  std::optional<std::int64_t> take(PacketView packet, core::TimeNs now);
  /// The sweeps closed by now, oldest first.
  std::vector<RawSweep> closed(core::TimeNs now);
  const PacketCounts& counts() const { return counts_; }

 private:
  struct Sweep {
    std::uint16_t id = 0;
    std::vector<std::int64_t> column_ns;
    std::vector<char> came;
    int columns = 0, packets = 0;
    core::TimeNs last_packet = 0;
    core::LidarScan scan;
  };

  Sweep* sweep_of(std::uint16_t id, core::TimeNs now);
  Sweep& begin(std::uint16_t id);
  void close_oldest();
  RawSweep finished(Sweep sweep) const;

  OusterMetadata metadata_;
  OusterLayout layout_;
  std::shared_ptr<const core::LidarModel> model_;
  std::vector<Sweep> open_;  // oldest first
  std::vector<RawSweep> closed_;
  std::optional<std::uint16_t> newest_id_;  // of all that were begun
  int strange_ids_ = 0;                     // in a row: the sensor may have started anew
  std::uint16_t strange_id_ = 0;
  PacketCounts counts_;
};

}  // namespace karst::lidar
