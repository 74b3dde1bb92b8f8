#include "core_stack/team/right_of_way/yield_state.h"

#include <algorithm>

namespace karst::core {
namespace {

constexpr double kGoOn = 1.3;                 // times the distance at which it stopped: then it goes on
constexpr double kPast_m = 2.0;               // so much farther away than it was: the other is past
constexpr double kNearer_m = 0.3;             // so much nearer: it comes
constexpr double kMoves_mps = 0.15;           // so fast: it comes, or goes
constexpr TimeNs kLook = 2 * kSecond;         // another that stands near may want to get by
constexpr TimeNs kStays = 3 * kSecond;        // in one place; then the place is no good,
constexpr TimeNs kPasses = 2 * kSecond;       // unless the other came nearer that lately, or goes,
constexpr TimeNs kStaysAtMost = 5 * kSecond;  // and even then
constexpr TimeNs kStaysAway = 10 * kSecond;   // it does not come
constexpr TimeNs kSeen = kSecond;             // one that stands aside is in the map by then
// One that is seen, but not heard, and stands: each waits so much longer than who has the number before.
constexpr TimeNs kTurn = 3 * kSecond;
constexpr TimeNs kFirst = 5 * kSecond;  // who goes before waits no longer for room
constexpr TimeNs kAskAgain = 2 * kSecond;
// One that is not heard and comes is so near, or is there so soon: do not set out.
constexpr double kTooNear_m = 2.5;
constexpr TimeNs kTooLate = 2 * kSecond;
constexpr TimeNs kTold = kSecond;  // by then the others have heard that it leaves
constexpr int kMaxAttempts = 1, kMaxAttemptsInCrowd = 2;
constexpr TimeNs kBoxed = 15 * kSecond;

double distance_m(const Neighbour& a, const Neighbour& b) { return (a.position - b.position).norm(); }

/// The speed at which `other` itself approaches.
double coming_mps(const Neighbour& self, const Neighbour& other) {
  Neighbour still = self;
  still.velocity_mps.setZero();
  return closing_mps(still, other);
}

/// Whether `self` has the right of way. One that is not heard does not know it, so if it comes, it has not.
bool goes_first(const Neighbour& self, const Neighbour& other) {
  return goes_before(self, other) && (other.heard || coming_mps(self, other) <= kMoves_mps);
}

/// Whether `other`, if it keeps its velocity, passes `self` at half the separation or more.
bool gets_by(const SeparationRule& rule, const Neighbour& self, const Neighbour& other) {
  const Vec3 to_self = self.position - other.position;
  const double speed2 = other.velocity_mps.squaredNorm();
  const double until_s = speed2 > 0 ? std::max(0.0, to_self.dot(other.velocity_mps) / speed2) : 0;
  return (to_self - until_s * other.velocity_mps).norm() >= rule.distance_m / 2;
}

}  // namespace

TeamPhase YieldState::reported(TeamPhase phase, TimeNs now) const {
  if (phase != TeamPhase::explore && phase != TeamPhase::home) return phase;
  if (stands_aside()) return TeamPhase::aside;
  return now < boxed_until_ ? TeamPhase::boxed : phase;
}

void YieldState::begin(const Neighbour& self, const Neighbour& other, TimeNs now) {
  with_ = other.robot;
  since_ = nearest_at_ = now;
  nearest_m_ = distance_m(self, other);
  aside_since_.reset();
  came_nearer_at_.reset();
  leaving_ = false;
}

bool YieldState::over(const SeparationRule& rule, const Neighbour& self, const Neighbour& other, TimeNs now) {
  // One that is not heard may be leaving, too, and stand but to turn: each goes to where it set out for.
  if (on_the_way_ && !other.heard) return false;
  const double d = distance_m(self, other);
  if (other.phase != TeamPhase::aside) aside_since_.reset();
  if (goes_first(self, other)) {
    if (other.phase == TeamPhase::aside) {
      if (!aside_since_) aside_since_ = now;
      return now - *aside_since_ > kSeen + (other.heard ? 0 : (self.robot - 1) * kTurn);
    }
    return d > kGoOn * rule.distance_m / 2 || coming_mps(self, other) < -kMoves_mps || now - since_ > kFirst;
  }
  if (!nearest_m_ || d < *nearest_m_ - kNearer_m) {
    if (nearest_m_) came_nearer_at_ = now;
    nearest_m_ = d;
    nearest_at_ = now;
  }
  if (on_the_way_ || d < kGoOn * rule.distance_m) return false;
  return d > *nearest_m_ + kPast_m || now - nearest_at_ > kStaysAway;
}

YieldState::Action YieldState::update(const SeparationRule& rule, Neighbour self,
                                      const std::vector<Neighbour>& others, TimeNs now, bool at_rest,
                                      TimeNs still_for) {
  if (now < boxed_until_) self.phase = TeamPhase::boxed;
  const std::vector<Neighbour> near = give_way_to(rule, self, others);
  const auto other = std::find_if(others.begin(), others.end(),
                                  [this](const Neighbour& o) { return with_ && o.robot == *with_; });
  if (!with_ || other == others.end() || over(rule, self, *other, now)) {
    if (near.empty()) {
      const TimeNs boxed_until = boxed_until_;
      forget();
      boxed_until_ = boxed_until;
      return Action::go_on;
    }
    begin(self, near.front(), now);
    return Action::hold;
  }
  // A vehicle that makes room for one must not fly into another: check all others, too.
  if (on_the_way_ && std::any_of(others.begin(), others.end(),
                                 [&](const Neighbour& o) { return stops_on_the_way(rule, self, o); })) {
    arrived(Place::in_the_way, now);
    return Action::stop;
  }
  const auto comes_and_does_not_stop = [&](const Neighbour& o) {
    return (!o.heard || o.phase == TeamPhase::landing) && coming_mps(self, o) > kMoves_mps;
  };
  const auto urgent = std::find_if(near.begin(), near.end(), comes_and_does_not_stop);
  if (!on_the_way_ && urgent != near.end() && !comes_and_does_not_stop(*other)) {
    begin(self, *urgent, now);
    asked_at_ = 0;
    return Action::hold;
  }
  if (on_the_way_ || goes_first(self, *other) || now - asked_at_ < kAskAgain) return Action::hold;
  const double coming = coming_mps(self, *other);
  const bool comes = coming > kMoves_mps;
  // One that is not heard may not know of this one, and come straight at it.
  const bool leaves = !other->heard && comes && !(aside_ && gets_by(rule, self, *other));
  if (!leaves && !at_rest) return Action::hold;
  // It may have planned its way around this one, as around rock: whoever sets out now flies into that way.
  const double away_m = distance_m(self, *other);
  if (!other->heard && comes && at_rest && (away_m < kTooNear_m || away_m < coming * seconds(kTooLate)))
    return Action::hold;
  const bool came_nearer = came_nearer_at_ && now - *came_nearer_at_ < kPasses;
  const bool passes = came_nearer || coming < -kMoves_mps || (aside_ && comes);
  if (leaves || leaving_ || still_for > (passes ? kStaysAtMost : kStays)) {
    asked_at_ = now;
    // Another may have set out because this one waits: it is told first.
    if (aside_ && !leaves) {
      aside_ = false;
      leaving_ = true;
      asked_at_ = now - kAskAgain + kTold;
      return Action::hold;
    }
    return Action::leave;
  }
  if (aside_ || !(comes || now - since_ > kLook)) return Action::hold;
  asked_at_ = now;
  return Action::make_room;
}

void YieldState::arrived(Place place, TimeNs now) {
  on_the_way_ = leaving_ = false;
  aside_ = place == Place::aside;
  if (aside_) attempts_ = 0;
  since_ = nearest_at_ = now;
  nearest_m_.reset();
}

void YieldState::no_room(TimeNs now, bool crowd) {
  aside_ = false;
  if (++attempts_ >= (crowd ? kMaxAttemptsInCrowd : kMaxAttempts)) {
    boxed_until_ = now + kBoxed;
    attempts_ = 0;
  }
}

}  // namespace karst::core
