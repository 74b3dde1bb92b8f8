// Who can talk to whom, as one robot knows it, and so who reaches the base.
//
// A link is known by what both ends say they hear of the other (TeamState::heard), each with the time it was
// said. It stands while both are fresh: a word that is not heard back is no link, for what arrives must be
// confirmed. It costs 1 / (quality there * quality back) transmissions (ETX; De Couto et al., A
// High-Throughput Path Metric for Multi-Hop Wireless Routing, 2003).
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "core_stack/common/options.h"
#include "core_stack/team/communication/messages.h"

namespace karst::core {

struct RelayOptions {
  double link_age_s = 15.0;  // what was said longer ago no longer counts; longer in a team of many radios
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

  /// What a robot says of whom it hears; older news than what is known changes nothing. What it does not name
  /// any more it does not hear.
  void note(const TeamState& state);
  /// When a robot was last heard of, through whomever.
  std::optional<TimeNs> last_heard_of(RobotId robot) const { return stamps_[robot]; }

  std::vector<RelayLink> links(TimeNs now) const;
  using Robots = std::array<bool, kMaxRobots>;
  /// Robots that reach the base over links, itself first, the rest in order.
  std::vector<RobotId> connected(TimeNs now) const;
  /// Whether a robot does over others that are among `relays` only; the base need not be.
  bool reaches_base(TimeNs now, RobotId robot, const Robots& relays) const {
    return reaches_base(now, robot, relays, options_.min_quality);
  }
  /// And over links of at least that quality each way.
  bool reaches_base(TimeNs now, RobotId robot, const Robots& relays, double min_quality) const;

 private:
  using Row = std::array<double, kMaxRobots>;
  /// Cost of each link in transmissions; 0: none.
  std::array<Row, kMaxRobots> costs(TimeNs now, double min_quality) const;
  std::vector<RobotId> connected(TimeNs now, const Robots& relays, double min_quality) const;
  bool fresh(RobotId robot, TimeNs now) const;

  RelayOptions options_;
  std::array<std::optional<TimeNs>, kMaxRobots> stamps_;  // of what each said last
  std::array<Row, kMaxRobots> heard_{};                   // [by][whom], 0..1
};

}  // namespace karst::core
