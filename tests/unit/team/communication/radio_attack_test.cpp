// What a hostile radio can do to a robot: without the mission's key nothing; with it, no more than a member
// may.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstdlib>
#include <set>

#include "core_stack/common/random.h"
#include "core_stack/team/team_node.h"
#include "tests/unit/team/communication/random_messages.h"
#include "tests/unit/team/communication/test_radio.h"

namespace karst::core {
namespace {

using testing::test_key;
using testing::write_frame;

RC_GTEST_PROP(ReplayWindow, TakesNoFrameTwiceAndEveryNewOneThatIsNotFarBehind, ()) {
  Random random(*rc::gen::inRange<std::uint64_t>(1, 1u << 30));
  using Stamped = std::pair<TimeNs, std::uint16_t>;
  ReplayWindow window;
  std::vector<Stamped> sent;
  std::set<std::size_t> heard;
  std::size_t newest = 0;
  TimeNs now = 0;
  auto sequence = static_cast<std::uint16_t>(random.bits());
  for (std::size_t i = 0; i < 400; ++i) {
    now += static_cast<TimeNs>(random.bits() % 3) * kMillisecond;  // several at one moment
    sent.push_back({now, sequence++});
    if (random.uniform() < 0.3) continue;  // lost
    const std::size_t which = random.uniform() < 0.6 ? i : i - std::min<std::size_t>(i, random.bits() % 100);
    const auto verdict = window.take(sent[which].first, sent[which].second);
    const bool taken = verdict != ReplayWindow::Verdict::refused;
    if (heard.contains(which)) RC_ASSERT(!taken);
    if (!heard.contains(which) && which + 63 >= newest) RC_ASSERT(taken);
    if (verdict == ReplayWindow::Verdict::newest) {
      RC_ASSERT(heard.empty() || which > newest);
      newest = which;
    }
    if (taken) heard.insert(which);
  }
}

TEST(ReplayWindow, OfASenderThatCountsAnewTheOldFramesAreRefused) {
  ReplayWindow window;
  using Verdict = ReplayWindow::Verdict;
  for (std::uint16_t i = 0; i < 50; ++i) EXPECT_EQ(window.take(i * kSecond, i), Verdict::newest);
  EXPECT_EQ(window.take(60 * kSecond, 0), Verdict::newest);
  EXPECT_EQ(window.take(61 * kSecond, 1), Verdict::newest);
  for (std::uint16_t i = 0; i < 50; ++i) EXPECT_EQ(window.take(i * kSecond, i), Verdict::refused) << i;
  EXPECT_EQ(window.take(60 * kSecond, 0), Verdict::refused);
}

/// Robot 2 of a team of three that carry a node each; all hear one another.
struct Victim {
  static constexpr RobotId kSelf = 2;
  TeamOptions team;
  std::vector<TeamNode> nodes;
  std::vector<Bytes> air;  // all that was ever sent
  TimeNs now = 0;
  std::uint16_t sequence = 0;

  Victim() {
    team.robots = 3, team.nodes = 1;
    for (RobotId r = 0; r <= 3; ++r)
      nodes.emplace_back(r, team, HomingOptions{}, Vec3(0, 0, 1), 7, test_key());
  }
  TeamNode& self() { return nodes[kSelf]; }
  void run(double for_s) {
    for (const TimeNs end = now + from_seconds(for_s); now < end;) {
      now += kSecond / 10;
      for (TeamNode& from : nodes) {
        TeamState state;
        state.phase = from.self() == kBase ? TeamPhase::standby : TeamPhase::explore;
        state.position = {10.0 * from.self(), seconds(now), 2};
        state.stamp = now;
        from.set_state(state);
        for (Bytes& frame : from.transmit(now)) {
          for (TeamNode& to : nodes)
            if (to.self() != from.self()) to.receive(frame, now);
          air.push_back(std::move(frame));
        }
      }
    }
  }
  /// As somebody who holds the key, in the name of `frame.sender`.
  void forge(Frame frame) {
    frame.sent = now, frame.sequence = static_cast<std::uint16_t>(20000 + sequence++);
    self().receive(*write_frame(frame), now);
  }
  std::uint64_t refused(Refusal why) {
    return self().gossip().counts().refused[static_cast<std::size_t>(why)];
  }
  std::uint64_t refused() {
    std::uint64_t all = 0;
    for (const std::uint64_t n : self().gossip().counts().refused) all += n;
    return all;
  }
  /// All that it believes of the team, as text.
  std::string belief() {
    const Gossip& g = self().gossip();
    std::string out;
    const auto add = [&out](double v) { out += std::to_string(v) + ' '; };
    for (const TeamState& s : g.states()) {
      add(s.robot), add(seconds(s.stamp)), add(s.position.x()), add(s.position.y());
      for (const RadioContact& h : s.heard) add(h.robot), add(h.quality);
    }
    for (const RadioContact& h : g.contacts(now, 0)) add(h.robot), add(h.quality);
    for (RobotId r = 0; r < kMaxRobots; ++r) add(g.held(r).first()), add(self().landing_of(r).has_value());
    for (const Vec3& p : self().claimed_goals(now)) add(p.x());
    for (const Vec3& p : self().taken_ground()) add(p.x());
    add(g.known_at_base()), add(static_cast<double>(g.counts().records_taken));
    return out;
  }
};

/// A fiftieth of the million, unless KARST_ATTACK_FRAMES asks for more: `team_test
/// --gtest_filter='RadioAttack.*'` then takes some seconds.
std::uint64_t attacks() {
  const char* asked = std::getenv("KARST_ATTACK_FRAMES");
  return asked ? std::strtoull(asked, nullptr, 10) : 20000;
}

struct RadioAttack : ::testing::Test {
  Victim victim;
  Random random{11};
  std::string before;
  std::uint64_t refused_before = 0;

  void SetUp() override {
    victim.nodes[1].publish(GoalClaim{0, {5, 0, 0}, false});
    victim.nodes[3].publish(LandingClaim{0, {40, 0, 0}, {40, 0, 1}, LandingClaim::State::claimed});
    victim.run(30);
    before = victim.belief(), refused_before = victim.refused();
  }
  void expect_all_refused(std::uint64_t n) {
    EXPECT_EQ(victim.refused() - refused_before, n);
    EXPECT_EQ(victim.belief(), before);
    std::printf("%llu of %llu believed\n",
                static_cast<unsigned long long>(n - (victim.refused() - refused_before)),
                static_cast<unsigned long long>(n));
  }
};

TEST_F(RadioAttack, NoForgedFrameIsBelieved) {
  const std::uint64_t n = attacks();
  for (std::uint64_t i = 0; i < n; ++i) {
    Frame frame{.sender = static_cast<RobotId>(random.bits() % 4 == 2 ? 3 : random.bits() % 4)};
    frame.sent = victim.now, frame.sequence = static_cast<std::uint16_t>(random.bits());
    TeamState state = testing::random_state(random);
    state.stamp = victim.now, state.heard.clear();
    frame.states = {state};
    Bytes bytes = *write_frame(frame);
    for (std::size_t b = bytes.size() - kTagBytes; b < bytes.size(); ++b)
      bytes[b] = static_cast<std::uint8_t>(random.bits());
    victim.self().receive(bytes, victim.now);
  }
  expect_all_refused(n);
}

TEST_F(RadioAttack, NoFrameWithFlippedBitsIsBelieved) {
  const std::uint64_t n = attacks();
  for (std::uint64_t i = 0; i < n; ++i) {
    Bytes bytes = victim.air[random.bits() % victim.air.size()];
    std::set<std::size_t> bits;
    for (std::uint64_t k = 1 + random.bits() % 4; k > 0; --k) bits.insert(random.bits() % (8 * bytes.size()));
    for (const std::size_t bit : bits) bytes[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
    victim.self().receive(bytes, victim.now);
  }
  expect_all_refused(n);
}

TEST_F(RadioAttack, NoReplayedFrameIsBelieved) {
  std::vector<Bytes> others;  // its own voice, thrown back, is not even counted
  for (const Bytes& frame : victim.air)
    if ((frame[3] & 0x7f) != Victim::kSelf) others.push_back(frame);
  const std::uint64_t n = attacks();
  for (std::uint64_t i = 0; i < n; ++i)
    victim.self().receive(others[random.bits() % others.size()], victim.now);
  expect_all_refused(n);
  EXPECT_GT(victim.refused(Refusal::replayed), 0u);
  EXPECT_GT(victim.refused(Refusal::stale), 0u);
}

// As it was: a vehicle that was no robot of the team, forged beside two that were, made both give way.
TEST_F(RadioAttack, NobodyWhoIsNotInTheTeamIsHeardOrHeardOf) {
  const std::size_t neighbours = victim.self().neighbours(victim.now).size();
  TeamState phantom;
  phantom.phase = TeamPhase::landing, phantom.stamp = victim.now, phantom.position = {21, 30, 2};
  for (RobotId id = 7; id < kMaxRobots; ++id) {  // base, three robots, a node of each: 0 to 6
    phantom.robot = id;
    victim.forge({.sender = id, .states = {phantom}});
    victim.forge({.sender = 1, .states = {phantom}});
    const LandingClaim landing{victim.now, {20, 30, 0}, {20, 30, 1}, LandingClaim::State::landed};
    victim.forge({.sender = 1, .records = {{id, 1, *write_record(landing)}}});
  }
  EXPECT_EQ(victim.refused(Refusal::stranger), kMaxRobots - 7u);
  EXPECT_EQ(victim.self().gossip().counts().states_refused, kMaxRobots - 7u);
  EXPECT_EQ(victim.self().gossip().counts().records_refused, kMaxRobots - 7u);
  EXPECT_EQ(victim.self().neighbours(victim.now).size(), neighbours);
  EXPECT_EQ(victim.self().taken_ground().size(), 1u) << "robot 3's claim, and no ground that nobody claimed";
}

TEST_F(RadioAttack, ANodeOrTheBaseThatFliesIsNotBelieved) {
  const std::size_t neighbours = victim.self().neighbours(victim.now).size();
  for (const RobotId id : {kBase, RobotId{4}, RobotId{6}}) {
    TeamState flying;
    flying.robot = id, flying.phase = TeamPhase::boxed, flying.stamp = victim.now;
    victim.forge({.sender = id, .states = {flying}});
  }
  EXPECT_EQ(victim.self().gossip().counts().states_refused, 3u);
  EXPECT_EQ(victim.self().neighbours(victim.now).size(), neighbours);
}

// As it was: the robot took the highest of its numbers that anybody named for its own, found no room behind
// the gap, and never said a word again.
TEST_F(RadioAttack, ARecordThatItNeverWroteDoesNotMuteIt) {
  const std::uint32_t own = victim.self().gossip().held(Victim::kSelf).first();
  const Bytes forged = *write_record(GoalClaim{victim.now, {9, 9, 9}, false});
  for (std::uint32_t ahead = 1; ahead <= 33; ++ahead)
    victim.forge({.sender = 1, .records = {{Victim::kSelf, own + ahead, forged}}});
  for (std::uint32_t i = 1; i <= 3; ++i)
    EXPECT_EQ(victim.self().publish(ObjectSeen{victim.now, i, 1, {1, 2, 3}, 0.5}), own + i);
  victim.run(10);
  EXPECT_EQ(victim.nodes[kBase].gossip().held(Victim::kSelf).first(), own + 3);
  EXPECT_EQ(victim.nodes[kBase].objects().size(), 3u);
}

TEST(RadioAttackAtTheStart, ARobotRemindedOfANumberFarAheadStillSpeaks) {
  Victim victim;
  victim.run(0.2);
  const Bytes forged = *write_record(GoalClaim{0, {9, 9, 9}, false});
  victim.forge({.sender = 1, .records = {{Victim::kSelf, 33, forged}}});
  for (std::uint32_t i = 1; i <= 40; ++i)
    EXPECT_GT(victim.self().publish(ObjectSeen{victim.now, i, 1, {1, 2, 3}, 0.5}), 0u) << i;
}

// As it was: known_at_base() became what one frame in the base's name said, and no object was told again.
TEST_F(RadioAttack, TheBaseIsNotBelievedToHoldMoreThanWasWritten) {
  const std::uint32_t own = victim.self().publish(ObjectSeen{victim.now, 1, 1, {1, 2, 3}, 0.5});
  victim.forge({.sender = kBase, .reports_held = true, .held = {{Victim::kSelf, 5000, 0}}});
  victim.forge({.sender = kBase, .reports_held = true, .held = {{Victim::kSelf, 0, 0xffffffffu}}});
  const Receipt receipt{{{Victim::kSelf, 5000}}};
  const std::uint32_t next = victim.self().gossip().held(kBase).first() + 1;
  victim.forge({.sender = 1, .records = {{kBase, next, *write_record(receipt)}}});
  EXPECT_LT(victim.self().gossip().known_at_base(), own);
  EXPECT_EQ(victim.self().gossip().counts().claims_refused, 3u);
  victim.run(5);
  EXPECT_EQ(victim.self().gossip().known_at_base(), victim.self().gossip().held(Victim::kSelf).first());
  EXPECT_TRUE(victim.nodes[kBase].objects().contains({Victim::kSelf, 1})) << "it went on telling it";
}

// As it was: what was stamped up to 5 s ahead stood for the truth until that had passed.
TEST_F(RadioAttack, AStateOfTheFutureDoesNotStandForTheTruth) {
  TeamState forged;
  forged.robot = 1, forged.phase = TeamPhase::explore, forged.position = {500, 0, 0};
  forged.stamp = victim.now + 4 * kSecond;
  victim.forge({.sender = 3, .states = {forged}});
  EXPECT_EQ(victim.self().gossip().counts().states_refused, 1u);
  // As far ahead as clocks may differ it does, and for so long.
  forged.stamp = victim.now + kClockTolerance;
  victim.forge({.sender = 3, .states = {forged}});
  victim.run(1.2);
  for (const TeammateState& teammate : victim.self().teammates(victim.now))
    EXPECT_LT(teammate.position.x(), 100);
}

TEST_F(RadioAttack, ATreeNodeInAnothersNameIsNotTaken) {
  const auto receive = [&](const TreeFacts& facts) {
    const std::uint32_t next = victim.self().gossip().held(1).first() + 1;
    victim.forge({.sender = 1, .records = {{1, next, *write_record(facts)}}});
  };
  TreeFacts base, stranger;
  base.nodes = {{{kBase, 1}, NodeKind::communication, {300, 0, 0}}};
  stranger.lives = {{{20, 1}, false, victim.now}};
  receive(base), receive(stranger);
  EXPECT_EQ(victim.self().gossip().counts().records_refused, 2u);
  EXPECT_TRUE(victim.self().take_facts().empty());
}

}  // namespace
}  // namespace karst::core
