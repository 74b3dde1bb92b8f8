// How a vehicle yields to another that comes near: it stops, makes room, and goes on once the other has
// passed.
#pragma once
#include <optional>

#include "core_stack/team/right_of_way/separation.h"

namespace karst::core {

class YieldState {
 public:
  enum class Action {
    go_on,      // no vehicle is in the way
    hold,       // stop, or stay where it is
    stop,       // on its way to make room it comes too near to somebody: brake, and look for another place
    make_room,  // it stands in another's way: to be answered by set_out() or no_room()
    leave,      // as make_room, but its present place is not a candidate
  };

  /// What to do now, to be asked ten times a second. `self` has the phase that it would be in without others,
  /// and has kept to one place for `still_for`: whomever it waited for, or since it waits there aside.
  Action update(const SeparationRule& rule, Neighbour self, const std::vector<Neighbour>& others, TimeNs now,
                bool at_rest, TimeNs still_for);

  /// The vehicle has left for its waiting place.
  void set_out() { on_the_way_ = true, aside_ = false; }
  enum class Place { aside, in_the_way };  // aside: where others get by
  /// It is at rest again.
  void arrived(Place place, TimeNs now);
  /// There is no place to make room; of a `crowd`, further vehicles may be in the way, which make room
  /// themselves.
  void no_room(TimeNs now, bool crowd);
  void forget() { *this = {}; }

  bool holds() const { return with_.has_value(); }
  /// It waits where the other can pass.
  bool stands_aside() const { return with_ && aside_; }
  bool on_the_way() const { return on_the_way_; }
  RobotId with() const { return with_.value_or(kBase); }
  /// The phase to report to the team instead of `phase`.
  TeamPhase reported(TeamPhase phase, TimeNs now) const;

 private:
  void begin(const Neighbour& self, const Neighbour& other, TimeNs now);
  bool over(const SeparationRule& rule, const Neighbour& self, const Neighbour& other, TimeNs now);

  std::optional<RobotId> with_;
  TimeNs since_ = 0, nearest_at_ = 0, asked_at_ = 0;
  std::optional<double> nearest_m_;  // since it stands here
  std::optional<TimeNs> came_nearer_at_;
  std::optional<TimeNs> aside_since_;  // the other vehicle
  bool on_the_way_ = false, aside_ = false;
  bool leaving_ = false;  // the others have been told that it leaves its place aside
  int attempts_ = 0;      // waiting places asked for
  TimeNs boxed_until_ = 0;
};

}  // namespace karst::core
