// A simulated flight: requests as mission control would make them, each depending on the last answer. At
// random, the vehicle reaches a goal as soon as it is proposed, or the goal fails; the map grows.
#pragma once
#include <string>
#include <vector>

#include "core_stack/common/random.h"
#include "sdk/check/cave.h"
#include "sdk/check/subject.h"

namespace karst::check {

/// A cave for a flight of a few dozen decisions.
inline const CaveShape kShape{.volume_m3 = 200, .radius_m = 1.6, .branches = 4, .resolution_m = 0.2};

class Flight {
 public:
  /// Initially the cave is known up to `known_fraction` of its length. The flight is determined by the seed.
  Flight(std::uint64_t seed, const CaveShape& shape, double known_fraction = 0.3);
  bool map_grows = true;
  Flight(const Flight&) = delete;
  Flight& operator=(const Flight&) = delete;

  /// The next request; valid until react().
  const core::DecisionRequest& request();
  /// The request made by request(), for modification.
  core::DecisionRequest& edit() { return request_; }
  /// Simulates what follows the answer; returns the events that the policy is told.
  std::vector<karst_event_t> react(const Answer& answer);

  Cave& cave() { return cave_; }
  const core::VehicleDescription& vehicle() const { return vehicle_; }

 private:
  karst_event_t event_of(const core::Goal& goal);
  void fly_to(const core::Vec3& place);

  core::Random random_;
  Cave cave_;
  double known_m_;
  core::VehicleDescription vehicle_;
  core::DecisionRequest request_;
  std::vector<std::string> texts_;  // of the last events
};

/// A random cave shape: narrow or wide, short or long, coarse or fine.
CaveShape any_shape(core::Random& random);

/// Asks `count` times and reports the events in between. Throws Failed if a call fails.
std::vector<Answer> fly(Object& object, Flight& flight, int count);
/// The answers' texts, concatenated.
std::string text_of(const std::vector<Answer>& answers);

}  // namespace karst::check
