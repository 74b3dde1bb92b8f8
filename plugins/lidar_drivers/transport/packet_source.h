// Where a sensor's packets come from.
#pragma once
#include <functional>
#include <utility>

#include "plugins/lidar_drivers/packet/little_endian_bytes.h"

namespace karst::lidar {

class PacketSource {
 public:
  virtual ~PacketSource() = default;
  /// Hands over what has come since the last call, in that order. Does not wait.
  virtual void receive(const std::function<void(PacketView)>& take) = 0;
};

/// Packets from the same process: of tests, and of a simulated sensor.
class PacketQueue final : public PacketSource {
 public:
  void push(Packet packet) { packets_.push_back(std::move(packet)); }
  void receive(const std::function<void(PacketView)>& take) override {
    std::vector<Packet> packets;
    packets.swap(packets_);
    for (const Packet& p : packets) take(p);
  }

 private:
  std::vector<Packet> packets_;
};

}  // namespace karst::lidar
