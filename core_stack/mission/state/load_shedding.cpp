#include "core_stack/mission/state/load_shedding.h"

#include <algorithm>
#include <utility>

namespace karst::core {
namespace {

constexpr TimeNs kMaxStrain = kSecond;
constexpr TimeNs kAtOnce = 10 * kSecond;
constexpr TimeNs kMaxPatience = 80 * kSecond;

/// A decision of 0.3 s delays the scans behind it by as much, and a plan as well.
constexpr TimeNs kMapTolerated = 300 * kMillisecond;
/// With the budget of 60 ms, a scan that is later than this delays the next one.
constexpr TimeNs kLocalizationTolerated = 40 * kMillisecond;

std::vector<Relief> map_reliefs(const LoadShedding::Sensors& sensors) {
  std::vector<Relief> reliefs;
  if (sensors.maps_scans) reliefs = {Relief::half_the_scans, Relief::quarter_the_scans};
  if (sensors.depth_images) reliefs.push_back(Relief::half_the_images);
  reliefs.push_back(Relief::fewer_decisions);
  if (sensors.pictures) reliefs.push_back(Relief::no_pictures);
  return reliefs;
}

std::vector<Relief> localization_reliefs(const LoadShedding::Sensors& sensors) {
  if (!sensors.locates_scans) return {};
  return {Relief::half_the_features, Relief::half_the_sweeps};
}

}  // namespace

std::optional<LaneLoad::Change> LaneLoad::observe(TimeNs now, TimeNs behind) {
  const TimeNs passed = now - std::exchange(observed_, now);
  const bool late = behind > tolerated_;
  strain_ = std::clamp<TimeNs>(strain_ + (late ? passed : -passed / 2), 0, kMaxStrain);
  if (late) calm_since_ = now;
  if (strain_ == kMaxStrain && since_.size() < reliefs_.size()) return take(now, behind);
  if (!since_.empty() && now - calm_since_ >= patience_) return give_back(now, behind);
  return std::nullopt;
}

LaneLoad::Change LaneLoad::take(TimeNs now, TimeNs behind) {
  if (given_back_)
    patience_ = now - *given_back_ < kAtOnce ? std::min(2 * patience_, kMaxPatience) : kFirstPatience;
  given_back_.reset();
  strain_ = 0;  // it needs time to have an effect
  since_.push_back(now);
  return {reliefs_[since_.size() - 1], true, now, behind};
}

LaneLoad::Change LaneLoad::give_back(TimeNs now, TimeNs behind) {
  const Change change{reliefs_[since_.size() - 1], false, since_.back(), behind};
  since_.pop_back();
  given_back_ = now;
  calm_since_ = now;
  return change;
}

bool LaneLoad::sheds(Relief relief) const {
  const auto end = reliefs_.begin() + static_cast<std::ptrdiff_t>(since_.size());
  return std::find(reliefs_.begin(), end, relief) != end;
}

LoadShedding::LoadShedding(const Sensors& sensors)
    : map_(map_reliefs(sensors), kMapTolerated),
      localization_(localization_reliefs(sensors), kLocalizationTolerated) {}

std::optional<LaneLoad::Change> LoadShedding::note(const std::optional<LaneLoad::Change>& change) {
  if (change && change->begins) ++times_[static_cast<std::size_t>(change->relief)];
  return change;
}

}  // namespace karst::core
