#include "core_stack/team/communication/gossip.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "core_stack/homing/path_home/homing_tree.h"
#include "tests/unit/team/communication/lossy_network.h"

namespace karst::core {
namespace {

using testing::Heard;
using testing::Network;
using testing::radio;
using testing::read_frame;
using testing::write_frame;

const Heard kChain = [](RobotId a, RobotId b, TimeNs) { return a + 1 == b || b + 1 == a; };
const Heard kAll = [](RobotId, RobotId, TimeNs) { return true; };

/// What robot `by` publishes as its `n`-th.
Record object(RobotId by, std::uint32_t n) {
  return ObjectSeen{n * kMillisecond, n, by, {1.0 * n, 2, 3}, 0.5};
}

void expect_each_once_and_whole(const Network& net, std::uint32_t records) {
  for (std::size_t to = 0; to < net.robots.size(); ++to) {
    std::map<std::pair<RobotId, std::uint32_t>, int> times;
    for (const Delivery& d : net.delivered[to]) {
      ++times[{d.author, d.number}];
      const auto& seen = std::get<ObjectSeen>(d.record);
      EXPECT_EQ(seen.kind, d.author);
      EXPECT_EQ(seen.object, d.number);
      EXPECT_EQ(seen.position.x(), 1.0 * d.number);
    }
    EXPECT_EQ(times.size(), records * (net.robots.size() - 1));
    for (const auto& [key, n] : times) EXPECT_EQ(n, 1);
  }
}

TEST(Gossip, EverybodyComesToHoldEverythingWith30PerCentLostAndHalfCorrupted) {
  Network net(8, kChain, 0.3, 0.5, 11);
  for (std::uint32_t n = 1; n <= 20; ++n) {
    for (RobotId r = 0; r < 8; ++r) net.robots[r].publish(object(r, n));
    net.run(2);
  }
  for (int i = 0; i < 20 && !net.alike(); ++i) net.run(10);
  EXPECT_TRUE(net.alike());
  expect_each_once_and_whole(net, 20);
  std::uint64_t refused = 0;
  for (const Gossip& r : net.robots) {
    for (const auto n : r.counts().refused) refused += n;
    EXPECT_EQ(r.counts().contradictions, 0u);
    EXPECT_EQ(r.counts().records_refused, 0u);
  }
  EXPECT_GT(refused, 1000u);
  // The far end of the chain knows that the base holds its records, by the base's receipts.
  net.robots[0].publish(net.robots[0].receipt());
  for (int i = 0; i < 20 && net.robots[7].known_at_base() < 20; ++i) net.run(10);
  EXPECT_EQ(net.robots[7].known_at_base(), 20u);
}

/// How old what the base knows of anybody ever is, in a chain of `n` radios that each publish `backlog`
/// records a second.
double oldest_state_s(RobotId n, TeamPhase phase, std::uint32_t backlog) {
  Network net(n, kChain, 0.1, 0, 5);
  net.phase = phase;
  for (RobotId r = 0; r < n; ++r) net.robots[r].publish(object(r, 1));  // what is held takes room, too
  net.run(60);
  double oldest_s = 0;
  for (std::uint32_t i = 0; i < 60; ++i) {
    for (RobotId r = 0; r < n; ++r)
      for (std::uint32_t k = 0; k < backlog; ++k) net.robots[r].publish(object(r, 2 + i * backlog + k));
    net.run(1);
    EXPECT_EQ(net.robots[0].states().size(), n - 1u);
    for (const TeamState& s : net.robots[0].states())
      oldest_s = std::max(oldest_s, seconds(net.now - s.stamp));
  }
  return oldest_s;
}

// As it was: of sixteen radios two states fitted a frame, and over ten hops they were a minute old: the base
// took half the chain for cut off. And again where there were more records to pass on than could be.
TEST(Gossip, OfManyRadiosInAChainTheBaseKnowsHowAllAreNow) {
  for (const RobotId n : {RobotId{16}, RobotId{26}, RobotId{32}})
    for (const TeamPhase phase : {TeamPhase::explore, TeamPhase::relay})
      for (const std::uint32_t backlog : {0, 3})  // 3: more records to pass on than links carry
        EXPECT_LT(oldest_state_s(n, phase, backlog), kPeriodsPerRadio * n)
            << int{n} << " radios, " << backlog;
}

// As it was: of 26 radios everybody's states and what each held took all that a radio may send, and of five
// robots' records a third never came to the base.
TEST(Gossip, OfManyRadiosInAChainTheBaseGetsTheRecordsOfTheFarEnd) {
  constexpr RobotId n = 26, authors = 5;
  constexpr std::uint32_t records = 300;
  Network net(
      n, [](RobotId a, RobotId b, TimeNs) { return std::abs(a - b) <= 2; }, 0.1, 0, 5);
  net.phase = TeamPhase::relay;
  for (std::uint32_t i = 1; i <= records; ++i) {  // 15 a second of 28 bytes
    for (RobotId r = n - authors; r < n; ++r) net.robots[r].publish(object(r, i));
    if (i % 3 == 0) net.run(1);
  }
  net.run(60);
  for (RobotId r = n - authors; r < n; ++r) EXPECT_EQ(net.robots[0].held(r).first(), records) << int{r};
}

// As it was: states of 24 explorers took what a hurried robot needs to say where it is three times a second.
TEST(Gossip, AmongManyAHurriedRobotStaysOnTheBeat) {
  Network net(24, kAll, 0, 0, 5);
  std::map<RobotId, TimeNs> reported;
  TimeNs longest = 0;
  for (Gossip& r : net.robots) r.hurry(true);
  net.run(20);
  for (int i = 0; i < 200; ++i) {
    net.run(0.1);
    const std::vector<TeamState> states = net.robots[0].states();
    for (const TeamState& s : states)
      if (const auto [at, is_new] = reported.try_emplace(s.robot, s.stamp); !is_new && s.stamp > at->second)
        longest = std::max(longest, s.stamp - at->second), at->second = s.stamp;
  }
  EXPECT_EQ(reported.size(), 23u);
  EXPECT_LE(seconds(longest), 0.65);
}

TEST(Gossip, WhoComesIntoContactAmongManyIsToldOfOneThatFellSilent) {
  constexpr RobotId n = 12, silent = 11, late = 10;
  Network net(
      n,
      [](RobotId from, RobotId to, TimeNs now) {
        const bool there = now > 90 * kSecond, spoke = now < 60 * kSecond;
        return (there || (from != late && to != late)) && (spoke || (from != silent && to != silent));
      },
      0, 0, 5);
  net.run(85);
  EXPECT_EQ(net.robots[late].states().size(), 0u);
  net.run(15);
  EXPECT_EQ(net.robots[late].states().size(), n - 1u);
}

TEST(Gossip, WhatIsHeldOfAllFitsAFrameThoughOfEachThereIsAGap) {
  Gossip base(radio(kBase), {}, 1);
  const Bytes record = *write_record(object(1, 33));
  for (RobotId r = 1; r < kMaxRobots; ++r)
    base.receive(*write_frame({.sender = r, .records = {{r, 33, record}}}), kSecond);
  base.publish(object(kBase, 1));
  std::size_t reported = 0;
  for (TimeNs t = kSecond; t < 4 * kSecond; t += kSecond / 10)
    for (const Bytes& b : base.send(t)) {
      Refusal why{};
      const auto frame = read_frame(b, why);
      ASSERT_TRUE(frame);
      if (frame->reports_held) reported = std::max(reported, frame->held.size());
    }
  EXPECT_EQ(reported, kMaxRobots) << "five bytes of each for what lies beyond the gap would not fit";
}

TEST(Gossip, ConvergesOnAnyNetworkThatIsConnectedNowAndThen) {
  rc::check("random networks", [] {
    Random random(*rc::gen::inRange<std::uint64_t>(1, 1u << 30));
    const auto n = static_cast<RobotId>(2 + random.bits() % 6);
    // Every few seconds another random tree joins them.
    const std::uint64_t seed = random.bits();
    const Heard linked = [seed](RobotId a, RobotId b, TimeNs now) {
      Random r(seed + static_cast<std::uint64_t>(now / (5 * kSecond)));
      std::vector<RobotId> parent(kMaxRobots);
      for (RobotId i = 1; i < kMaxRobots; ++i) parent[i] = static_cast<RobotId>(r.bits() % i);
      return parent[a] == b || parent[b] == a;
    };
    Network net(n, linked, 0.3, 0.5, seed);
    for (RobotId r = 0; r < n; ++r)
      for (std::uint32_t k = 1; k <= 6; ++k) net.robots[r].publish(object(r, k));
    for (int i = 0; i < 30 && !net.alike(); ++i) net.run(10);
    RC_ASSERT(net.alike());
  });
}

TEST(Gossip, TwoWhoMeetAgainAreBroughtUpToDate) {
  const Heard apart = [](RobotId, RobotId, TimeNs now) { return now > 60 * kSecond; };
  Network net(2, apart, 0, 0, 3);
  for (std::uint32_t n = 1; n <= 200; ++n) net.robots[1].publish(object(1, n));
  net.run(60);
  EXPECT_EQ(net.robots[0].held(1).first(), 0u);
  EXPECT_TRUE(net.robots[0].contacts(net.now, 0).empty());
  net.run(30);
  EXPECT_EQ(net.robots[0].held(1).first(), 200u);
  EXPECT_EQ(net.robots[1].known_at_base(), 200u);
  ASSERT_EQ(net.robots[0].contacts(net.now, 0).size(), 1u);
  EXPECT_GT(net.robots[0].contacts(net.now, 0)[0].quality, 0.9);
}

TEST(Gossip, QualityIsTheShareThatArrives) {
  Network net(2, kAll, 0.4, 0, 5);
  net.run(60);
  double sum = 0;
  for (int i = 0; i < 100; ++i) {
    net.run(5);
    sum += net.robots[0].contacts(net.now, 0).empty() ? 0 : net.robots[0].contacts(net.now, 0)[0].quality;
  }
  EXPECT_NEAR(sum / 100, 0.6, 0.08);
}

TEST(Gossip, StatesOfAllReachAllAlongAChain) {
  Network net(6, kChain, 0.2, 0, 7);
  net.run(60);
  const std::vector<TeamState> known = net.robots[5].states();
  ASSERT_EQ(known.size(), 5u);
  for (const TeamState& s : known) EXPECT_LT(net.now - s.stamp, 30 * kSecond);
}

TEST(Gossip, KeepsToItsShareOfBandwidth) {
  Network net(4, kAll, 0.3, 0.2, 9);
  for (int second = 0; second < 60; ++second) {
    for (RobotId r = 0; r < 4; ++r)
      for (int k = 0; k < 10; ++k) net.robots[r].publish(object(r, 1));
    net.run(1);
  }
  for (const Gossip& r : net.robots)
    EXPECT_LE(static_cast<double>(r.counts().bytes_sent),
              GossipOptions{}.bytes_per_s * 60.0 + 11 * kFrameBytes);
}

TEST(Gossip, IdleItSaysLittle) {
  Network net(5, kAll, 0, 0, 9);
  for (RobotId r = 0; r < 5; ++r) net.robots[r].publish(object(r, 1));
  net.run(20);
  const std::uint64_t before = net.bytes;
  net.run(100);
  EXPECT_LT(static_cast<double>(net.bytes - before) / (5 * 100), 210);  // bytes a second and robot
}

TEST(Gossip, HostileFramesLeaveItAsItWas) {
  Gossip robot(radio(1), {}, 1);
  const auto record = write_record(object(2, 1));
  std::uint16_t sequence = 0;
  const auto receive = [&](Frame f) {
    f.sequence = sequence++;
    robot.receive(*write_frame(f), kSecond);
  };
  receive({.sender = 2, .records = {{2, 5000, *record}}});  // far ahead: would need memory without end
  receive({.sender = 2, .records = {{2, 1, {9, 9, 9}}}});   // no record
  EXPECT_EQ(robot.counts().records_refused, 2u);
  receive({.sender = 2, .records = {{2, 1, *record}}});
  receive({.sender = 2, .records = {{2, 1, *write_record(object(2, 7))}}});
  EXPECT_EQ(robot.counts().contradictions, 1u);
  EXPECT_EQ(std::get<ObjectSeen>(robot.take_delivered().at(0).record).object, 1u);
  EXPECT_TRUE(robot.take_delivered().empty());
  TeamState late;
  late.robot = 2, late.stamp = 1000 * kSecond;
  receive({.sender = 2, .states = {late}});
  EXPECT_TRUE(robot.states().empty());
  EXPECT_EQ(robot.counts().states_refused, 1u);
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    Bytes noise(random.bits() % 300);
    for (auto& b : noise) b = static_cast<std::uint8_t>(random.bits());
    robot.receive(noise, kSecond);
  }
  EXPECT_EQ(robot.counts().records_taken, 1u);
  EXPECT_EQ(robot.counts().frames_heard, 2005u);
}

TEST(Gossip, RecordsFromTheFutureAreRefusedAndTheGenuineOnesUnderTheirNumbersTaken) {
  constexpr TimeNs future = 1000 * kSecond;
  TreeFacts ray, life;
  ray.rays = {{{2, 1}, {2, 2}, true, future}};
  life.lives = {{{2, 1}, false, future}};
  const std::vector<Record> forged = {
      GoalClaim{.stamp = future},
      LandingClaim{.stamp = future, .hover = {0, 0, 1}},
      ObjectSeen{.stamp = future, .object = 1, .kind = 1},
      ray,
      life,
  };
  Gossip robot(radio(1), {}, 1);
  std::uint16_t sequence = 0;
  const auto receive = [&](std::uint32_t number, const Record& r) {
    robot.receive(
        *write_frame({.sender = 2, .sequence = sequence++, .records = {{2, number, *write_record(r)}}}),
        kSecond);
  };
  for (std::uint32_t i = 0; i < forged.size(); ++i) receive(i + 1, forged[i]);
  EXPECT_EQ(robot.counts().records_refused, forged.size());
  EXPECT_TRUE(robot.take_delivered().empty());
  for (std::uint32_t i = 0; i < forged.size(); ++i) receive(i + 1, object(2, i + 1));
  EXPECT_EQ(robot.take_delivered().size(), forged.size());
  EXPECT_EQ(robot.counts().contradictions, 0u);
}

TEST(Gossip, AStateThatCannotBeToldDoesNotSilenceTheRobot) {
  Network net(2, kAll, 0, 0, 2);
  net.robots[1].publish(object(1, 1));
  net.run(3);
  TeamState broken;
  broken.position = {std::nan(""), 0, 0};
  net.robots[1].publish(object(1, 2));
  for (TimeNs t = net.now; t < net.now + 3 * kSecond; t += kSecond / 10) {
    net.robots[1].set_state(broken);
    for (const Bytes& b : net.robots[1].send(t)) net.robots[0].receive(b, t);
  }
  EXPECT_EQ(net.robots[0].held(1).first(), 2u);
}

TEST(Gossip, ARobotThatStartsAnewGoesOnBehindWhatOthersRemember) {
  Network net(2, kAll, 0, 0, 2);
  for (std::uint32_t n = 1; n <= 5; ++n) net.robots[1].publish(object(1, n));
  net.run(5);
  net.robots[1] = Gossip(radio(1), {}, 99);
  net.run(10);
  EXPECT_EQ(net.robots[1].publish(object(1, 6)), 6u);
  net.run(5);
  EXPECT_EQ(net.robots[0].held(1).first(), 6u);
  EXPECT_EQ(net.robots[0].counts().contradictions, 0u);
}

TEST(Gossip, HomingTreesOfAllBecomeOneOverALossyNetwork) {
  constexpr RobotId n = 5;
  Network net(n, kChain, 0.3, 0.5, 21);
  const FreeRay all_free = [](const Vec3&, const Vec3&) { return true; };
  std::vector<HomingTree> trees(n, HomingTree({}, 1.6));
  net.robots[0].publish(trees[0].insert_communication({0, 0}, {0, 0, 1}, 0, all_free));
  const auto merge = [&] {
    for (RobotId r = 0; r < n; ++r) {
      for (const Delivery& d : net.delivered[r])
        if (const auto* facts = std::get_if<TreeFacts>(&d.record)) trees[r].apply(*facts);
      net.delivered[r].clear();
    }
  };
  for (std::uint32_t i = 1; i <= 60; ++i) {
    for (RobotId r = 1; r < n; ++r) {
      const Vec3 p(2.2 * i, 3.0 * r + std::sin(0.3 * i), 1);
      const TreeFacts facts = trees[r].insert_pose({r, i}, p, net.now, all_free);
      if (!facts.empty()) {
        EXPECT_GT(net.robots[r].publish(facts), 0u);
      }
    }
    if (i == 40)
      net.robots[2].publish(trees[2].insert_communication({2, 1000}, {88, 6, 1}, net.now, all_free));
    net.run(1);
    merge();
  }
  for (int i = 0; i < 40 && !net.alike(); ++i) net.run(10), merge();
  ASSERT_TRUE(net.alike());
  // Records to come from robots that already are alike: the trees are, too.
  for (const TreeNode& node : trees[0].nodes())
    for (const HomingTree& t : trees) {
      EXPECT_EQ(t.cost_s(node.id), trees[0].cost_s(node.id));
      EXPECT_EQ(t.next(node.id), trees[0].next(node.id));
      EXPECT_EQ(t.node_count(), trees[0].node_count());
    }
  EXPECT_GT(trees[0].node_count(), 200u);
}

}  // namespace
}  // namespace karst::core
