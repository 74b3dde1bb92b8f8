#include "plugins/simulator/radio/radio.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core_stack/common/random.h"

namespace karst::sim {
namespace {

using core::Random;
using core::TimeNs;

Random fate_of(std::uint64_t seed, int from, std::uint64_t number, int to) {
  Random r = Random::stream(seed, "radio");
  std::uint64_t h = r.bits();
  for (const std::uint64_t part : {static_cast<std::uint64_t>(from), number, static_cast<std::uint64_t>(to)})
    h = Random(h ^ part * 0x9e3779b97f4a7c15ull).bits();
  return Random(h);
}

bool silent(const RadioOptions& o, TimeNs t) {
  const double since_s = core::seconds(t) - o.silent_after_s;
  return since_s >= 0 && since_s < o.silent_for_s;
}

/// Flips one to four bits; some packets also lose their end.
void corrupt(std::vector<std::uint8_t>& bytes, Random& random) {
  if (bytes.empty()) return;
  for (std::uint64_t k = 1 + random.bits() % 4; k > 0; --k)
    bytes[random.bits() % bytes.size()] ^= static_cast<std::uint8_t>(1u << random.bits() % 8);
  if (random.uniform() < 0.25) bytes.resize(random.bits() % bytes.size());
}

}  // namespace

void describe(core::OptionTable& t, RadioOptions& o) {
  describe(t, o.link);
  t.add("bandwidth", o.bandwidth_kbps, "", 0.1, 1e6, "kbit/s, shared by all who hear one another");
  t.add("latency", o.latency_ms, "", 0, 10000, "ms behind the time on the air");
  t.add("jitter", o.jitter_ms, "", 0, 10000, "ms at most on top of the latency");
  t.add("loss", o.loss, "", 0, 1, "share of packets lost at random");
  t.add("corrupt", o.corrupt, "", 0, 1, "share of packets that arrive corrupted");
  t.add("queue", o.queue_bytes, "", 100, 1e9, "bytes a sender holds back while the channel is busy");
  t.add("silent_after", o.silent_after_s, "s", 0, 86400, "for tests: when all radios fall silent");
  t.add("silent_for", o.silent_for_s, "s", 0, 86400, "and for how long; 0: they never do");
}

void Radio::send(const cave::RayScene& scene, int from, std::span<const std::uint8_t> bytes, TimeNs stamp) {
  Station& sender = radios_.at(from);
  const double bytes_per_ns = options_.bandwidth_kbps * 1e3 / 8 / 1e9;
  const double waiting = bytes_per_ns * static_cast<double>(std::max<TimeNs>(sender.busy_until - stamp, 0));
  const std::uint64_t number = sender.sent++;
  if (!sender.on || waiting > options_.queue_bytes) {
    ++sender.counts.packets_dropped;
    sender.counts.bytes_dropped += bytes.size();
    return;
  }
  ++sender.counts.packets_sent;
  sender.counts.bytes_sent += bytes.size();
  const TimeNs begin = std::max(stamp, sender.busy_until);
  const TimeNs end = begin + std::llround(static_cast<double>(bytes.size()) / bytes_per_ns);
  sender.busy_until = end;
  for (auto& [to, station] : radios_)
    if (to != from) arrive(scene, from, to, bytes, end, number);
}

void Radio::arrive(const cave::RayScene& scene, int from, int to, std::span<const std::uint8_t> bytes,
                   TimeNs end, std::uint64_t number) {
  Station& receiver = radios_.at(to);
  RadioCounts& counts = receiver.counts;
  if (!receiver.on) {
    counts.bytes_deaf += bytes.size();
    return;
  }
  Random random = fate_of(seed_, from, number, to);
  const double fading_db = options_.link.fading_db * random.normal();
  const double margin_db =
      link_margin_db(options_.link, scene, radios_.at(from).position, receiver.position) + fading_db;
  const bool lost = random.uniform() < options_.loss || silent(options_, end);
  if (!(margin_db >= 0)) {
    counts.bytes_weak += bytes.size();
    return;
  }
  // A receiver in range keeps silent meanwhile, even if the packet is lost to it.
  receiver.busy_until = std::max(receiver.busy_until, end);
  if (lost) {
    counts.bytes_lost += bytes.size();
    return;
  }
  RadioPacket packet{
      end + core::from_seconds(1e-3 * (options_.latency_ms + options_.jitter_ms * random.uniform())),
      from,
      {bytes.begin(), bytes.end()},
      margin_db};
  if (random.uniform() < options_.corrupt) {
    corrupt(packet.bytes, random);
    ++counts.packets_corrupted;
  }
  ++counts.packets_heard;
  counts.bytes_heard += bytes.size();
  receiver.arriving.push_back({std::move(packet), number});
}

std::vector<RadioPacket> Radio::receive(int to, TimeNs until) {
  std::vector<Arrival>& all = radios_.at(to).arriving;
  const auto later = std::stable_partition(all.begin(), all.end(),
                                           [until](const Arrival& a) { return a.packet.stamp <= until; });
  std::sort(all.begin(), later, [](const Arrival& a, const Arrival& b) {
    return std::tie(a.packet.stamp, a.packet.from, a.number) <
           std::tie(b.packet.stamp, b.packet.from, b.number);
  });
  std::vector<RadioPacket> out;
  for (auto a = all.begin(); a != later; ++a) out.push_back(std::move(a->packet));
  all.erase(all.begin(), later);
  return out;
}

double Radio::margin_db(const cave::RayScene& scene, int a, int b) const {
  return link_margin_db(options_.link, scene, radios_.at(a).position, radios_.at(b).position);
}

}  // namespace karst::sim
