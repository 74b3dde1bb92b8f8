// The team's radio links as known to one robot, and which robots have a route to the base.
//
// Both ends of a link report the quality at which they receive the other (TeamState::heard). The link holds
// while both reports are recent: a one-way connection is no link, because deliveries must be acknowledged. It
// costs 1 / (quality there * quality back) transmissions (ETX; De Couto et al., A High-Throughput Path Metric
// for Multi-Hop Wireless Routing, 2003).
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "core_stack/common/options.h"
#include "core_stack/team/communication/messages.h"

namespace karst::core {

struct RelayOptions {
  double link_age_s = 15.0;  // older reports do not count; grows with the number of radios
  double min_quality = 0.1;  // of a link, each way
};
void describe(OptionTable& t, RelayOptions& o);

struct RelayLink {
  RobotId a = 0, b = 0;  // a < b
  double transmissions = 1;
};

class RelayGraph {
 public:
  explicit RelayGraph(const RelayOptions& options) : options_(options) {}

  /// Takes a robot's report of its radio contacts. A report older than the known one changes nothing. A robot
  /// that is not in the report is no longer received.
  void note(const TeamState& state);
  /// When a robot was last heard, directly or through others.
  std::optional<TimeNs> last_heard_of(RobotId robot) const { return stamps_[robot]; }

  std::vector<RelayLink> links(TimeNs now) const;
  using Robots = std::array<bool, kMaxRobots>;
  /// Robots with a route to the base; the base comes first, the rest in order.
  std::vector<RobotId> connected(TimeNs now) const;
  /// Whether a robot has a route to the base through `relays` only; the base need not be among them.
  bool reaches_base(TimeNs now, RobotId robot, const Robots& relays) const {
    return reaches_base(now, robot, relays, options_.min_quality);
  }
  /// The same over links of at least `min_quality` each way.
  bool reaches_base(TimeNs now, RobotId robot, const Robots& relays, double min_quality) const;

 private:
  using Row = std::array<double, kMaxRobots>;
  /// Cost of each link in transmissions; 0: none.
  std::array<Row, kMaxRobots> costs(TimeNs now, double min_quality) const;
  std::vector<RobotId> connected(TimeNs now, const Robots& relays, double min_quality) const;
  bool fresh(RobotId robot, TimeNs now) const;

  RelayOptions options_;
  std::array<std::optional<TimeNs>, kMaxRobots> stamps_;  // of each robot's last report
  std::array<Row, kMaxRobots> heard_{};                   // [by][whom], 0..1
};

}  // namespace karst::core
