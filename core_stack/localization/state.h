// The recent history of the state estimate: scans and poses arrive late and are matched at their stamp.
#pragma once
#include <boost/circular_buffer.hpp>

#include "core_stack/common/geometry.h"
#include "core_stack/common/options.h"
#include "core_stack/common/time.h"
#include "core_stack/vehicle/command.h"

namespace karst::core {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

enum class Health { good, degraded, lost };

/// The last seconds of states, oldest first, stamps strictly increasing. Allocates memory only if it holds
/// more states than ever before.
class StateHistory {
 public:
  explicit StateHistory(TimeNs length = 2 * kSecond) : states_(kUsual), length_(length) {}
  /// Appends `s`. Drops states at its stamp or later first: a correction in the past pushes the replayed
  /// states over the ones they replace.
  void push(const State& s);
  /// Interpolated pose T_world_body at `t`: linear in position, spherical in rotation; outside the range the
  /// nearest end. The identity while the history is empty.
  Pose pose_at(TimeNs t) const;
  const boost::circular_buffer<State>& states() const { return states_; }

 private:
  static constexpr std::size_t kUsual = 512;  // 2 s at 200 Hz, with a margin
  boost::circular_buffer<State> states_;
  TimeNs length_;
};

}  // namespace karst::core
