// Several vehicles in a passage with room for one, flown as points that brake and speed up: each hears the
// others by radio, and keeps apart from them as mission control does. Somebody who holds the mission's key
// may lie.
#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "core_stack/common/random.h"
#include "core_stack/mission/phases/still_watch.h"
#include "core_stack/team/right_of_way/waiting_place.h"
#include "core_stack/team/right_of_way/yield_state.h"
#include "core_stack/team/team_node.h"
#include "tests/unit/homing/passage.h"
#include "tests/unit/team/communication/test_radio.h"

namespace karst::core {
namespace {

constexpr double kTick_s = 0.1, kSpeed_mps = 1.2, kAcceleration_mps2 = 1.0, kRadius_m = 0.3;
constexpr double kHalf_m = 40.0, kHeight_m = 0.7;
constexpr TimeNs kTick = kSecond / 10, kPlanning = 300 * kMillisecond;

/// A passage 1.6 m wide and 1.4 m high: nobody gets by another.
struct Tube {
  std::vector<CellChange> changes;
  VoxelMap map = testing::passage(1.6, 1.4, 2 * kHalf_m, &changes);
  Roadmap roadmap{PlanningOptions{}};
  Tube() { roadmap.update(map, changes); }
  static const Tube& instance() {
    static const Tube tube;
    return tube;
  }
};

/// It need not look for places where others get by: there are none.
const std::vector<Vec3> kNowhere = {Vec3::Constant(1e3), Vec3::Constant(2e3)};

/// Flies to and fro between the ends, and keeps apart from those it hears of.
class Pilot {
 public:
  Pilot(RobotId robots, RobotId self, TeamPhase phase, double x_m, double goal_m)
      : phase_(phase),
        node_(self, team_of(robots), HomingOptions{}, Vec3(0, 0, 1), 7, testing::test_key()),
        x_m_(x_m),
        goal_m_(goal_m),
        flown_{place()} {}

  TeamNode& node() { return node_; }
  Vec3 place() const { return {x_m_, 0.1, kHeight_m}; }
  double x_m() const { return x_m_; }
  int made_room() const { return made_room_; }

  std::vector<Bytes> transmit(TimeNs now) {
    TeamState state;
    state.stamp = now, state.position = place(), state.velocity_mps = {speed_mps_, 0, 0};
    state.phase = yield_state_.reported(phase_, now), state.seconds_left = 100;
    node_.set_state(state);
    return node_.transmit(now);
  }

  void fly(TimeNs now) {
    separation(now);
    if (!yield_state_.holds() && at_rest()) {
      if (std::abs(goal_m_ - x_m_) < 0.5) goal_m_ = -goal_m_;
      target_m_ = goal_m_;
    }
    const double left_m = target_m_ - x_m_;
    const double max_mps = std::min(kSpeed_mps, std::sqrt(2 * kAcceleration_mps2 * std::abs(left_m)));
    const double wanted_mps = braking_ || std::abs(left_m) < 0.05 ? 0 : std::copysign(max_mps, left_m);
    const double step = kAcceleration_mps2 * kTick_s;
    speed_mps_ += std::clamp(wanted_mps - speed_mps_, -step, step);
    x_m_ += kTick_s * speed_mps_;
    if (speed_mps_ == 0) target_m_ = x_m_, braking_ = false;
    if ((flown_.back() - place()).norm() > 0.5) flown_.push_back(place());
  }

 private:
  static TeamOptions team_of(RobotId robots) {
    TeamOptions team;
    team.robots = robots;
    return team;
  }
  bool at_rest() const { return speed_mps_ == 0 && std::abs(target_m_ - x_m_) < 0.05; }

  void separation(TimeNs now) {
    if (yield_state_.on_the_way() && at_rest()) {
      const bool aside = waiting_place_.keeps_passage_open && (place() - waiting_place_.place).norm() < 0.5;
      yield_state_.arrived(aside ? YieldState::Place::aside : YieldState::Place::in_the_way, now);
    }
    const std::vector<Neighbour> others = node_.neighbours(now);
    const bool held = yield_state_.holds();
    const auto action = yield_state_.update({}, {node_.self(), place(), {speed_mps_, 0, 0}, phase_}, others,
                                            now, at_rest(), still_.still_for(place(), now));
    if (held != yield_state_.holds() || action == YieldState::Action::stop) braking_ = speed_mps_ != 0;
    const bool due = action == YieldState::Action::make_room || action == YieldState::Action::leave;
    if (due && !room_due_) room_due_ = now + kPlanning;
    if (room_due_ && now >= *room_due_) make_room(others, now);
  }

  void make_room(const std::vector<Neighbour>& others, TimeNs now) {
    room_due_.reset();
    if (!yield_state_.holds() || !at_rest()) return;
    RoomQuery query;
    query.from = place(), query.flown = flown_, query.failed = kNowhere;
    query.vehicle_radius_m = kRadius_m;
    query.others = others;
    const auto found = waiting_place(Tube::instance().map, Tube::instance().roadmap, query);
    if (!found) return yield_state_.no_room(now, others.size() > 1);
    ++made_room_;
    waiting_place_ = *found, target_m_ = found->place.x();
    if (found->place == place()) still_.wait(now);
    yield_state_.set_out();
  }

  TeamPhase phase_;
  TeamNode node_;
  YieldState yield_state_;
  double x_m_, goal_m_, target_m_ = x_m_, speed_mps_ = 0;
  bool braking_ = false;
  StillWatch still_;
  WaitingPlace waiting_place_;
  std::vector<Vec3> flown_;
  std::optional<TimeNs> room_due_;
  int made_room_ = 0;
};

struct Outcome {
  double nearest_m = std::numeric_limits<double>::infinity();
  int made_room = 0;
};

/// Forty seconds of `flying` robots. A liar says of robot `flying` + 1, which never started, that it is
/// wherever it pleases: beside one of the others, and on its way to it.
Outcome fly(RobotId flying, bool liar, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::unique_ptr<Pilot>> pilots;
  for (RobotId r = 1; r <= flying; ++r) {
    const double x_m = 8.0 * r - 4 * (flying + 1) + random.uniform(-1.5, 1.5);
    const double goal_m = (random.uniform() < 0.5 ? -1 : 1) * (kHalf_m - 6);
    const TeamPhase phase = random.uniform() < 0.5 ? TeamPhase::explore : TeamPhase::home;
    pilots.push_back(std::make_unique<Pilot>(flying + 1, r, phase, x_m, goal_m));
  }
  Outcome out;
  Vec3 phantom = Vec3::Zero();
  TeamState lie;
  lie.robot = static_cast<RobotId>(flying + 1);
  std::uint16_t lies = 0;
  for (TimeNs now = kTick; now < 40 * kSecond; now += kTick) {
    for (const auto& from : pilots)
      for (const Bytes& frame : from->transmit(now))
        for (const auto& to : pilots)
          if (to != from) to->node().receive(frame, now);
    if (liar && now % (kSecond / 2) == 0) {
      if (now % (10 * kSecond) == 0) {  // it appears 2 to 4 m from one of them
        const Pilot& victim = *pilots[random.bits() % pilots.size()];
        const double side = random.uniform() < 0.5 ? -1 : 1;
        phantom = victim.place() + Vec3(side * random.uniform(2, 4), 0, 0);
        lie.velocity_mps = {-side * random.uniform(0, 1), 0, 0};
        lie.phase = random.uniform() < 0.5 ? TeamPhase::landing : TeamPhase::home;
      }
      lie.stamp = now, lie.position = phantom;
      const Frame frame{.sender = lie.robot, .sent = now, .sequence = lies++, .states = {lie}};
      for (const auto& to : pilots) to->node().receive(*testing::write_frame(frame), now);
    }
    for (const auto& pilot : pilots) pilot->fly(now);
    for (std::size_t i = 0; i < pilots.size(); ++i)
      for (std::size_t k = 0; k < i; ++k)
        out.nearest_m = std::min(out.nearest_m, (pilots[i]->place() - pilots[k]->place()).norm());
  }
  for (const auto& pilot : pilots) out.made_room += pilot->made_room();
  return out;
}

constexpr std::uint64_t kSeeds = 20;

// As it was: who made room for one looked at nobody else on its way, and flew into who came behind it.
TEST(Meeting, OfThreeToFiveInAPassageForOneNobodyTouchesAnother) {
  int made_room = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Outcome o = fly(static_cast<RobotId>(3 + seed % 3), false, seed);
    EXPECT_GT(o.nearest_m, 2 * kRadius_m) << seed;
    made_room += o.made_room;
  }
  EXPECT_GT(made_room, 40) << "they did not meet";
}

// As it was: a vehicle that was not there, forged beside two that were, made them collide at 1.87 m/s.
TEST(Meeting, WhereOneWhoHoldsTheKeyLiesAboutAMemberNobodyTouchesAnother) {
  int made_room = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Outcome o = fly(static_cast<RobotId>(2 + seed % 3), true, seed);
    EXPECT_GT(o.nearest_m, 2 * kRadius_m) << seed;
    made_room += o.made_room;
  }
  EXPECT_GT(made_room, 40) << "nobody believed it";
}

TEST(WaitingPlace, IsNotBeyondAnotherThatIsNearerToIt) {
  const Tube& tube = Tube::instance();
  RoomQuery query;
  query.from = {0, 0.1, kHeight_m}, query.others = {{2, {4, 0.1, kHeight_m}}},
  query.vehicle_radius_m = kRadius_m;
  for (double x = -30; x <= 0; x += 0.5) query.flown.push_back({x, 0.1, kHeight_m});
  const auto alone = waiting_place(tube.map, tube.roadmap, query);
  ASSERT_TRUE(alone);
  EXPECT_FALSE(alone->keeps_passage_open);
  EXPECT_LT(alone->place.x(), -25) << "as far back as it came";
  query.others.push_back({3, {-10, 0.1, kHeight_m}});
  const auto before_one = waiting_place(tube.map, tube.roadmap, query);
  ASSERT_TRUE(before_one);
  EXPECT_LT(before_one->place.x(), -2.5);
  EXPECT_GE(before_one->place.x(), -4.5) << "it arrives there a metre before the one behind it";
  query.others.back().position.x() = -3;
  EXPECT_FALSE(waiting_place(tube.map, tube.roadmap, query)) << "between two there is no room";
}

TEST(WaitingPlace, KeepsItsDistanceFromOthersThatWait) {
  std::vector<CellChange> changes;
  const VoxelMap map = testing::passage(8, 2, 20, &changes);  // wide enough to get by
  Roadmap roadmap{PlanningOptions{}};
  roadmap.update(map, changes);
  RoomQuery query;
  query.from = {0, 0.1, 1.1}, query.others = {{2, {4, 0.1, 1.1}}}, query.vehicle_radius_m = kRadius_m;
  const auto alone = waiting_place(map, roadmap, query);
  ASSERT_TRUE(alone && alone->keeps_passage_open);
  const Vec3 waits = alone->place - (query.others[0].position - alone->place).normalized() * 0.2;
  query.others.push_back({3, waits, Vec3::Zero(), TeamPhase::aside});
  query.from = waits + Vec3(0, -2, 0);
  const auto beside = waiting_place(map, roadmap, query);
  ASSERT_TRUE(beside);
  EXPECT_GE((beside->place - waits).norm(), query.separation_m);
}

}  // namespace
}  // namespace karst::core
