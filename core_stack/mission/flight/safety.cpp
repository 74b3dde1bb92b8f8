#include "core_stack/mission/flight/safety.h"

#include <string>
#include <utility>

namespace karst::core {
namespace {

constexpr TimeNs kKept = kSecond;
constexpr const char* kBlindForLong = "no sensor sees the cave any more";
const std::string kOutside = "the vehicle is outside ";

}  // namespace

SafetyVerdict SafetySupervisor::on_motion(const SafetyObservation& o) const {
  const std::string why = o.estimate.reason;
  if (o.estimate.health == Health::lost) return {SafetyAction::land, "the state estimate is lost: " + why};
  if (o.battery_s < options_.battery_land_s) return {SafetyAction::land, "the battery ends"};
  const bool waits_for_sight = o.blind_s > options_.blind_brake_s && o.blind_s <= options_.blind_home_s;
  if (waits_for_sight) return {SafetyAction::brake, "no sensor sees the cave"};
  if (o.tracking_error_m > options_.tracking_brake_m) return {SafetyAction::brake, "far from the reference"};
  if (o.blind_s > options_.blind_home_s) return {SafetyAction::slow, kBlindForLong};
  if (o.tracking_error_m > options_.tracking_slow_m) return {SafetyAction::slow, "off the reference"};
  if (o.estimate.health == Health::degraded)
    return {SafetyAction::slow, "the state estimate is degraded: " + why};
  if (o.hull_clearance_m && *o.hull_clearance_m < options_.hull_clearance_m)
    return {SafetyAction::slow, "close to rock"};
  if (!o.outside.empty()) return {SafetyAction::slow, kOutside + o.outside};
  return {};
}

std::optional<std::string> SafetySupervisor::why_home(const SafetyObservation& o) const {
  if (degraded_since_ && seconds(o.now - *degraded_since_) > options_.degraded_home_s)
    return "the state estimate stays degraded";
  if (o.blind_s > options_.blind_home_s) return kBlindForLong;
  if (!o.outside.empty()) return kOutside + o.outside;
  return std::nullopt;
}

const SafetyVerdict& SafetySupervisor::judge(const SafetyObservation& o) {
  if (o.estimate.health == Health::good) degraded_since_.reset();
  if (o.estimate.health != Health::good && !degraded_since_) degraded_since_ = o.now;
  SafetyVerdict now = on_motion(o);
  now.go_home = why_home(o);
  const bool turns_back = now.go_home && !verdict_.go_home;  // takes effect at once, with no hold time
  if (now.action >= verdict_.action || turns_back || o.now - cause_seen_ >= kKept) {
    verdict_ = std::move(now);
    cause_seen_ = o.now;
  } else {
    verdict_.go_home = std::move(now.go_home);
  }
  return verdict_;
}

}  // namespace karst::core
