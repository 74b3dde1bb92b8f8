// The additional hardware of a vehicle in a team: a radio, and communication nodes to drop. Nothing else
// passes between it and the others.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core_stack/common/time.h"

namespace karst::core {

/// One radio. Times are the team's.
class RadioPort {
 public:
  virtual ~RadioPort() = default;
  virtual void send(std::span<const std::uint8_t> frame, TimeNs now) = 0;
  /// The frames received up to `until`, each once.
  virtual std::vector<std::vector<std::uint8_t>> receive(TimeNs until) = 0;
};

/// The port of a member that flies.
class TeamPort : public RadioPort {
 public:
  /// Drops a communication node, whose radio has the number `radio` from now on.
  virtual void drop_node(std::size_t radio) = 0;
};

}  // namespace karst::core
