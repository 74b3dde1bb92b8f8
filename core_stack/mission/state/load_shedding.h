// What the core leaves out while a lane cannot keep up, in real time.
//
// A lane that is late is relieved of one measure after another, in the order of the list below, and takes
// them back one by one, the last first, when there is room. In lockstep nothing is late, so nothing is ever
// left out.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/common/enum_names.h"
#include "core_stack/common/executive.h"

namespace karst::core {

/// In the order in which they are taken; each stays in force while later ones are. The first five relieve the
/// map lane, the others localization.
enum class Relief {
  half_the_scans,     // every second scan is mapped; all are located
  quarter_the_scans,  // every fourth scan
  half_the_images,    // every second depth image of each camera is mapped
  fewer_decisions,    // the policy is asked half as often
  no_pictures,        // pictures of the colour camera are neither kept nor noted in the map
  half_the_features,  // LOAM uses half the features of a scan
  half_the_sweeps     // every second scan is located, and so mapped
};
constexpr auto names_of(Relief) {
  using enum Relief;
  return std::to_array<Named<Relief>>({{half_the_scans, "every 2nd scan mapped"},
                                       {quarter_the_scans, "every 4th scan mapped"},
                                       {half_the_images, "every 2nd depth image mapped"},
                                       {fewer_decisions, "decisions half as often"},
                                       {no_pictures, "no pictures"},
                                       {half_the_features, "half the features located by"},
                                       {half_the_sweeps, "every 2nd scan located"}});
}

/// Decides for one lane, by what it is told ten times a second.
class LaneLoad {
 public:
  struct Change {
    Relief relief{};
    bool begins = false;  // else it is over
    TimeNs since = 0;     // from when on it has been in force
    TimeNs behind = 0;    // the lane's lateness, as last observed
  };
  /// `reliefs` in order. An observation beyond `tolerated` counts as late: more than a burst of work
  /// explains.
  LaneLoad(std::vector<Relief> reliefs, TimeNs tolerated)
      : reliefs_(std::move(reliefs)), tolerated_(tolerated) {}

  /// `behind`: the greatest lateness since the last observation. One more relief is taken once the lane was
  /// late for a second in all, where time in which it was not counts half against that. The last one is over
  /// after five seconds in which the lane was never late; if it was needed again at once, that takes twice as
  /// long the next time, up to 80 s.
  std::optional<Change> observe(TimeNs now, TimeNs behind);
  bool sheds(Relief relief) const;

 private:
  Change take(TimeNs now, TimeNs behind);
  Change give_back(TimeNs now, TimeNs behind);

  std::vector<Relief> reliefs_;
  TimeNs tolerated_;
  std::vector<TimeNs> since_;  // of each relief in force
  TimeNs observed_ = 0;        // when last
  TimeNs strain_ = 0;          // time late, less half the time not late
  TimeNs calm_since_ = 0;
  TimeNs patience_ = kFirstPatience;
  std::optional<TimeNs> given_back_;  // when last
  static constexpr TimeNs kFirstPatience = 5 * kSecond;
};

/// Of all lanes together.
class LoadShedding {
 public:
  /// What can be left out on a vehicle with these sensors.
  struct Sensors {
    bool maps_scans = false, locates_scans = false, depth_images = false, pictures = false;
  };
  explicit LoadShedding(const Sensors& sensors);

  std::optional<LaneLoad::Change> observe_map(TimeNs now, TimeNs behind) {
    return note(map_.observe(now, behind));
  }
  std::optional<LaneLoad::Change> observe_localization(TimeNs now, TimeNs behind) {
    return note(localization_.observe(now, behind));
  }
  bool sheds(Relief relief) const { return map_.sheds(relief) || localization_.sheds(relief); }

  /// How often a relief was taken.
  int times(Relief relief) const { return times_[static_cast<std::size_t>(relief)]; }

 private:
  std::optional<LaneLoad::Change> note(const std::optional<LaneLoad::Change>& change);

  LaneLoad map_, localization_;
  std::array<int, names_of(Relief{}).size()> times_{};
};

}  // namespace karst::core
