#include "core_stack/localization/state.h"

#include <algorithm>

namespace karst::core {

void StateHistory::push(const State& s) {
  while (!states_.empty() && states_.back().stamp >= s.stamp) states_.pop_back();
  states_.push_back(s);
  while (states_.front().stamp < s.stamp - length_) states_.pop_front();
}

Pose StateHistory::pose_at(TimeNs t) const {
  if (states_.empty()) return {};
  const auto after = std::lower_bound(states_.begin(), states_.end(), t,
                                      [](const State& s, TimeNs time) { return s.stamp < time; });
  if (after == states_.begin()) return states_.front().pose();
  if (after == states_.end()) return states_.back().pose();
  const State& a = *std::prev(after);
  const State& b = *after;
  const double share = static_cast<double>(t - a.stamp) / static_cast<double>(b.stamp - a.stamp);
  return {a.position + share * (b.position - a.position),
          a.orientation.slerp(share, b.orientation).normalized()};
}

}  // namespace karst::core
