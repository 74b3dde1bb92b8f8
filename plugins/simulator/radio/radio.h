// The team's radio: omnidirectional, short-range, slow, lossy. One channel for all vehicles of a cave.
//
// A packet is received by every radio where it is strong enough, given all positions when it is sent. There
// is one channel: a sender waits while it hears another transmission (carrier sense) and while it transmits
// itself, so radios in range of each other share the bandwidth. Not modelled: collisions of two senders that
// do not hear each other, and capture.
//
// The outcome of a packet at a receiver depends only on the seed, the sender, the packet's number and the
// receiver, from which it is drawn at random. Traffic elsewhere, or the order in which vehicles are polled,
// changes no outcome.
#pragma once
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "core_stack/common/time.h"
#include "plugins/simulator/radio/radio_link.h"

namespace karst::sim {

struct RadioOptions {
  LinkOptions link;
  double bandwidth_kbps = 64;
  double latency_ms = 5, jitter_ms = 5;         // added to the time on the air; jitter is uniform
  double loss = 0;                              // fraction of packets lost irrespective of distance
  double corrupt = 0;                           // fraction of packets that arrive with wrong or missing bytes
  double queue_bytes = 8000;                    // capacity of a sender's queue; packets beyond are dropped
  double silent_after_s = 0, silent_for_s = 0;  // packets sent during this period are lost
};
void describe(core::OptionTable& t, RadioOptions& o);

struct RadioPacket {
  core::TimeNs stamp = 0;  // of arrival
  int from = 0;
  std::vector<std::uint8_t> bytes;
  double margin_db = 0;  // as received
};

/// Packets and bytes by outcome. A packet is sent once and reaches every other radio: the bytes sent, times
/// the number of other radios, are the sum of heard, weak, lost and deaf.
struct RadioCounts {
  std::uint64_t packets_sent = 0, bytes_sent = 0;
  std::uint64_t packets_dropped = 0, bytes_dropped = 0;          // the sender's queue was full, or it was off
  std::uint64_t packets_heard = 0, bytes_heard = 0;              // by this receiver, the corrupted among them
  std::uint64_t bytes_weak = 0, bytes_lost = 0, bytes_deaf = 0;  // for this receiver; deaf: it was off
  std::uint64_t packets_corrupted = 0;
};

class Radio {
 public:
  Radio(const RadioOptions& options, std::uint64_t seed) : options_(options), seed_(seed) {}

  /// Sets the position (world, m) of a radio: robot, base station or dropped node. Call it after each motion.
  void place(int radio, const core::Vec3& position) { radios_[radio].position = position; }
  /// A radio that is off neither transmits nor receives.
  void switch_off(int radio) { radios_.at(radio).on = false; }
  void switch_on(int radio) { radios_.at(radio).on = true; }

  /// Transmits a packet as soon as the channel is free; stamps must not decrease. Throws std::out_of_range if
  /// the radio was never placed.
  void send(const cave::RayScene& scene, int from, std::span<const std::uint8_t> bytes, core::TimeNs stamp);
  /// Packets that arrived at a radio up to `until` and were not returned yet, in the order of arrival.
  std::vector<RadioPacket> receive(int to, core::TimeNs until);

  /// Link margin in dB between two radios at their present positions, without fading.
  double margin_db(const cave::RayScene& scene, int a, int b) const;
  const RadioCounts& counts(int radio) const { return radios_.at(radio).counts; }

 private:
  struct Arrival {
    RadioPacket packet;
    std::uint64_t number;
  };
  struct Station {
    core::Vec3 position = core::Vec3::Zero();
    bool on = true;
    core::TimeNs busy_until = 0;  // due to its own packets, or others' that it hears
    std::uint64_t sent = 0;
    std::vector<Arrival> arriving;
    RadioCounts counts;
  };

  void arrive(const cave::RayScene& scene, int from, int to, std::span<const std::uint8_t> bytes,
              core::TimeNs end, std::uint64_t number);

  RadioOptions options_;
  std::uint64_t seed_;
  std::map<int, Station> radios_;
};

}  // namespace karst::sim
