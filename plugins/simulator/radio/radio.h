// The team's radio: omnidirectional, short of range, slow, lossy. One for all vehicles of a cave.
//
// A packet is heard by every radio it is strong enough for where it is and where they are when it is sent.
// The channel is one: a sender waits while it hears another sending (carrier sense) and while it sends
// itself, so all around one another share the bandwidth. Not modelled: collisions of two that do not hear
// each other, and capture.
//
// What happens to a packet at a receiver is drawn from the seed, the sender, the packet's number and the
// receiver, and from nothing else: traffic elsewhere, or the order in which vehicles are asked, changes no
// outcome.
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
  double latency_ms = 5, jitter_ms = 5;         // behind the time on the air; jitter is uniform
  double loss = 0;                              // share of packets lost for no reason of distance
  double corrupt = 0;                           // share of packets that arrive with wrong or missing bytes
  double queue_bytes = 8000;                    // what a sender holds back; beyond that packets are dropped
  double silent_after_s = 0, silent_for_s = 0;  // nothing arrives that was sent then
};
void describe(core::OptionTable& t, RadioOptions& o);

struct RadioPacket {
  core::TimeNs stamp = 0;  // of arrival
  int from = 0;
  std::vector<std::uint8_t> bytes;
  double margin_db = 0;  // as received
};

/// Bytes by what became of them. A packet is sent once and meets every other radio: what was sent, times
/// their number, is the sum of heard, weak, lost and deaf.
struct RadioCounts {
  std::uint64_t packets_sent = 0, bytes_sent = 0;
  std::uint64_t packets_dropped = 0, bytes_dropped = 0;  // by the sender's full queue, or it being off
  std::uint64_t packets_heard = 0, bytes_heard = 0;      // by this receiver, the corrupted among them
  std::uint64_t bytes_weak = 0, bytes_lost = 0, bytes_deaf = 0;  // for this receiver; deaf: it was off
  std::uint64_t packets_corrupted = 0;
};

class Radio {
 public:
  Radio(const RadioOptions& options, std::uint64_t seed) : options_(options), seed_(seed) {}

  /// A radio by its number; to be called again whenever it has moved. Base stations and dropped nodes, too.
  void place(int radio, const core::Vec3& position) { radios_[radio].position = position; }
  /// A radio that is off neither sends nor hears.
  void switch_off(int radio) { radios_.at(radio).on = false; }
  void switch_on(int radio) { radios_.at(radio).on = true; }

  /// Puts a packet on the air as soon as the channel is free; stamps must not go back. Throws
  /// std::out_of_range if the radio was never placed.
  void send(const cave::RayScene& scene, int from, std::span<const std::uint8_t> bytes, core::TimeNs stamp);
  /// What has arrived at a radio up to `until` and was not taken yet, in the order of arrival.
  std::vector<RadioPacket> receive(int to, core::TimeNs until);

  /// What the receiver would have above its need now, without fading.
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
    core::TimeNs busy_until = 0;  // by its own packets, or others' that it hears
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
