#include "core_stack/localization/state.h"

#include "core_stack/common/pose_track.h"

namespace karst::core {

void StateHistory::push(const State& s) {
  while (!states_.empty() && states_.back().stamp >= s.stamp) states_.pop_back();
  if (states_.full()) states_.set_capacity(2 * states_.capacity());
  states_.push_back(s);
  while (states_.front().stamp < s.stamp - length_) states_.pop_front();
}

Pose StateHistory::pose_at(TimeNs t) const {
  return states_.empty() ? Pose{} : pose_on_track(states_, t, &State::stamp, &State::pose);
}

}  // namespace karst::core
