// A link between two ends in memory that is late and loses messages, on the executive's time.
#pragma once
#include <array>
#include <deque>
#include <functional>
#include <memory>

#include "core_stack/common/options.h"
#include "core_stack/common/random.h"
#include "core_stack/common/time.h"
#include "plugins/mavlink/link/byte_link.h"

namespace karst::sim {

struct SimulatedLinkOptions {
  double latency_s = 0.02;                 // one way
  double jitter_s = 0.005;                 // added: uniform from 0; the order is kept
  double loss = 0;                         // fraction of messages
  double garbage = 0;                      // fraction of messages that come behind up to 40 bytes of noise
  double corruption = 0;                   // fraction of messages of which a byte is wrong
  double lost_from_s = 0, lost_for_s = 0;  // the whole link, once
};
void describe(core::OptionTable& t, SimulatedLinkOptions& o);

class SimulatedLink {
 public:
  SimulatedLink(const SimulatedLinkOptions& options, std::uint64_t seed, std::function<core::TimeNs()> now);

  enum class End { core, autopilot };
  /// It may live longer than this object.
  std::unique_ptr<mavlink::ByteLink> open(End end);
  /// Nothing is sent, or arrives, until then.
  void lose_until(core::TimeNs until);

 private:
  struct Line;
  class Port;
  std::shared_ptr<Line> line_;
};

}  // namespace karst::sim
