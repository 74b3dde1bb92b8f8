#include "plugins/simulator/radio/radio.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>

#include "tests/unit/simulator/meshes.h"

namespace karst::sim {
namespace {

using core::kMillisecond;
using core::kSecond;
using core::Vec3;
using test::append;
using test::box_mesh;

/// Two halls, x from 0 to 10 and from 13 to 40: three metres of rock between them.
cave::RayScene two_halls() {
  cave::TriangleMesh mesh = box_mesh({0, 0, 0}, {10, 10, 5});
  append(mesh, box_mesh({13, 0, 0}, {40, 10, 5}));
  return cave::RayScene(std::move(mesh));
}
const cave::RayScene& hall() {
  static const cave::RayScene scene(box_mesh({-500, -500, -50}, {500, 500, 50}));
  return scene;
}
RadioOptions clean(Propagation propagation = Propagation::distance) {
  RadioOptions o;
  o.link.propagation = propagation;
  o.link.fading_db = 0;
  return o;
}
std::vector<std::uint8_t> bytes_of(std::size_t n, std::uint8_t v = 7) {
  return std::vector<std::uint8_t>(n, v);
}

TEST(RadioLink, RockIsMeasuredAlongTheStraightLine) {
  const cave::RayScene scene = two_halls();
  EXPECT_NEAR(rock_between_m(scene, {5, 5, 2}, {20, 5, 2}), 3, 1e-4);
  EXPECT_NEAR(rock_between_m(scene, {20, 5, 2}, {5, 5, 2}), 3, 1e-4);
  EXPECT_EQ(rock_between_m(scene, {1, 1, 1}, {9, 9, 4}), 0);
  EXPECT_EQ(rock_between_m(scene, {1, 1, 1}, {1, 1, 1}), 0);
  const double askew = rock_between_m(scene, {7, 2, 2}, {16, 8, 2});
  EXPECT_NEAR(askew, 3 * Vec3(9, 6, 0).norm() / 9, 1e-4);
  // Boulders count, those within rock twice: rock there is rock already, and they are few.
  const cave::RayScene fallen = scene.with_boulders({{{5, 5, 2}, 1.5}});
  EXPECT_NEAR(rock_between_m(fallen, {1, 5, 2}, {9, 5, 2}), 3, 1e-4);
  EXPECT_EQ(rock_between_m(fallen, {1, 9, 2}, {9, 9, 2}), 0);
}

TEST(RadioLink, AHoleInTheMeshMakesAllBetweenFirstAndLastSurfaceRock) {
  cave::TriangleMesh mesh = box_mesh({0, 0, 0}, {10, 10, 5});
  append(mesh, box_mesh({13, 0, 0}, {20, 10, 5}, 0b111110));  // open towards the first hall
  append(mesh, box_mesh({25, 0, 0}, {30, 10, 5}));
  const cave::RayScene scene(std::move(mesh));
  EXPECT_NEAR(rock_between_m(scene, {5, 5, 2}, {28, 5, 2}), 15, 1e-4);
}

TEST(RadioLink, TheBudgetIsUsedUpAtTheRangeAndByRock) {
  LinkOptions o;
  o.range_m = 50, o.rock_db_per_m = 3, o.path_loss_exponent = 2;
  EXPECT_NEAR(link_margin_db(o, hall(), {0, 0, 0}, {50, 0, 0}), 0, 1e-9);
  EXPECT_NEAR(link_margin_db(o, hall(), {0, 0, 0}, {5, 0, 0}), 20, 1e-9);
  EXPECT_NEAR(link_margin_db(o, two_halls(), {5, 5, 2}, {20, 5, 2}), 20 * std::log10(50 / 15.0) - 9, 1e-3);
  o.propagation = Propagation::distance;
  EXPECT_GT(link_margin_db(o, two_halls(), {5, 5, 2}, {20, 5, 2}), 0);
  EXPECT_LT(link_margin_db(o, hall(), {0, 0, 0}, {50.1, 0, 0}), 0);
}

TEST(Radio, ByDistanceAloneAllWithinTheRangeHearAndNobodyElse) {
  Radio radio(clean(), 1);
  radio.place(0, {0, 0, 0});
  radio.place(1, {49.9, 0, 0});
  radio.place(2, {50.1, 0, 0});
  radio.send(hall(), 0, bytes_of(100), 0);
  EXPECT_EQ(radio.receive(1, kSecond).size(), 1u);
  EXPECT_TRUE(radio.receive(2, kSecond).empty());
  EXPECT_TRUE(radio.receive(0, kSecond).empty());
  EXPECT_TRUE(radio.receive(1, kSecond).empty());  // taken
  radio.place(2, {10, 0, 0});
  radio.send(hall(), 2, bytes_of(5, 9), kSecond);
  const auto got = radio.receive(0, 2 * kSecond);
  ASSERT_EQ(got.size(), 1u);
  EXPECT_EQ(got[0].from, 2);
  EXPECT_EQ(got[0].bytes, bytes_of(5, 9));
}

TEST(Radio, BandwidthIsSharedByAllWhoHearOneAnother) {
  RadioOptions o = clean();
  o.bandwidth_kbps = 8, o.latency_ms = 0, o.jitter_ms = 0;  // a byte a millisecond
  Radio radio(o, 1);
  radio.place(0, {0, 0, 0});
  radio.place(1, {10, 0, 0});
  radio.place(2, {1000, 0, 0});
  radio.place(3, {1010, 0, 0});
  radio.send(hall(), 0, bytes_of(100), 0);
  radio.send(hall(), 1, bytes_of(100), 0);
  radio.send(hall(), 2, bytes_of(100), 0);  // far off: another channel, as it were
  EXPECT_TRUE(radio.receive(1, 99 * kMillisecond).empty());
  EXPECT_EQ(radio.receive(1, 100 * kMillisecond).at(0).stamp, 100 * kMillisecond);
  EXPECT_EQ(radio.receive(0, kSecond).at(0).stamp, 200 * kMillisecond);
  EXPECT_EQ(radio.receive(3, kSecond).at(0).stamp, 100 * kMillisecond);
  // A second is a thousand bytes; the queue holds 8000 more.
  for (int i = 0; i < 200; ++i) radio.send(hall(), 0, bytes_of(100), kSecond);
  EXPECT_EQ(radio.counts(0).packets_sent, 82u);
  EXPECT_EQ(radio.counts(0).packets_dropped, 119u);
  EXPECT_EQ(radio.counts(0).bytes_dropped, 11900u);
  EXPECT_EQ(radio.receive(1, 3 * kSecond).size(), 20u);
}

TEST(Radio, NothingArrivesThatIsSentInTheSilence) {
  RadioOptions o = clean();
  o.silent_after_s = 10, o.silent_for_s = 5;
  Radio radio(o, 1);
  radio.place(0, {0, 0, 0});
  radio.place(1, {10, 0, 0});
  for (int t = 9; t <= 16; ++t) radio.send(hall(), 0, bytes_of(static_cast<std::size_t>(t)), t * kSecond);
  std::vector<std::size_t> sizes;
  for (const RadioPacket& p : radio.receive(1, 20 * kSecond)) sizes.push_back(p.bytes.size());
  EXPECT_EQ(sizes, (std::vector<std::size_t>{9, 15, 16}));
  EXPECT_EQ(radio.counts(1).bytes_lost, 10u + 11 + 12 + 13 + 14);
}
TEST(Radio, EveryByteIsAccountedFor) {
  rc::check("bytes", [] {
    core::Random random(*rc::gen::inRange<std::uint64_t>(1, 1u << 30));
    RadioOptions o;
    o.loss = 0.3, o.corrupt = 0.5;
    Radio radio(o, random.bits());
    constexpr int n = 5;
    for (int i = 0; i < n; ++i) radio.place(i, {random.uniform(-40, 40), random.uniform(-40, 40), 0});
    radio.switch_off(4);
    std::uint64_t taken = 0;
    core::TimeNs now = 0;
    for (int k = 0; k < 200; ++k) {
      now += 20 * kMillisecond;
      radio.send(hall(), static_cast<int>(random.bits() % n), bytes_of(1 + random.bits() % 200), now);
      for (int i = 0; i < n; ++i)
        for (const RadioPacket& p : radio.receive(i, now)) {
          RC_ASSERT(p.stamp <= now);
          ++taken;
        }
    }
    for (int i = 0; i < n; ++i) taken += radio.receive(i, now + 100 * kSecond).size();
    std::uint64_t sent = 0, met = 0, packets = 0;
    for (int i = 0; i < n; ++i) {
      const RadioCounts& c = radio.counts(i);
      sent += c.bytes_sent, packets += c.packets_heard;
      met += c.bytes_heard + c.bytes_weak + c.bytes_lost + c.bytes_deaf;
    }
    RC_ASSERT(met == sent * (n - 1));
    RC_ASSERT(taken == packets);
    RC_ASSERT(radio.counts(4).packets_heard + radio.counts(4).packets_sent == 0u);
  });
}

TEST(Radio, WhatHappensToAPacketDependsOnNothingElse) {
  RadioOptions o;
  o.loss = 0.3, o.corrupt = 0.3;
  const auto heard_by_1 = [&](bool others, bool ask_often) {
    Radio radio(o, 42);
    radio.place(0, {0, 0, 0}), radio.place(1, {35, 0, 0});
    if (others) radio.place(2, {400, 0, 0}), radio.place(3, {404, 0, 0});
    std::vector<RadioPacket> got;
    for (int k = 0; k < 300; ++k) {
      if (others) radio.send(hall(), 2, bytes_of(50), k * 100 * kMillisecond);
      radio.send(hall(), 0, bytes_of(50), k * 100 * kMillisecond);
      if (ask_often)
        for (RadioPacket& p : radio.receive(1, k * 100 * kMillisecond)) got.push_back(std::move(p));
    }
    for (RadioPacket& p : radio.receive(1, 1000 * kSecond)) got.push_back(std::move(p));
    return got;
  };
  const auto a = heard_by_1(false, false), b = heard_by_1(true, true);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_GT(a.size(), 100u);
  EXPECT_LT(a.size(), 250u);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].stamp, b[i].stamp);
    EXPECT_EQ(a[i].bytes, b[i].bytes);
    EXPECT_EQ(a[i].margin_db, b[i].margin_db);
  }
}

TEST(Radio, LossCorruptionAndFadingComeInTheirShares) {
  RadioOptions o = clean(Propagation::rock);
  o.loss = 0.3, o.corrupt = 0.5, o.link.fading_db = 3;
  Radio radio(o, 7);
  radio.place(0, {0, 0, 0}), radio.place(1, {10, 0, 0}), radio.place(2, {0, 50, 0});
  int damaged = 0;
  for (int k = 0; k < 4000; ++k) {
    radio.send(hall(), 0, bytes_of(40), k * 100 * kMillisecond);
    for (const RadioPacket& p : radio.receive(1, (k + 1) * 100 * kMillisecond))
      damaged += p.bytes != bytes_of(40);
  }
  const RadioCounts &near = radio.counts(1), &edge = radio.counts(2);
  EXPECT_NEAR(static_cast<double>(near.bytes_lost) / (4000 * 40), 0.3, 0.03);
  EXPECT_NEAR(static_cast<double>(near.packets_corrupted) / static_cast<double>(near.packets_heard), 0.5,
              0.03);
  EXPECT_EQ(near.bytes_weak, 0u);
  // Bits may be turned over twice and back, hardly ever.
  EXPECT_NEAR(damaged, static_cast<double>(near.packets_corrupted), 0.02 * 2000);
  // At the range itself half of what is sent is too weak.
  EXPECT_NEAR(static_cast<double>(edge.bytes_weak) / (4000 * 40), 0.5, 0.03);
}

TEST(Radio, ARelayThatFailsNeitherSendsNorHears) {
  Radio radio(clean(), 1);
  radio.place(0, {0, 0, 0}), radio.place(1, {1, 0, 0});
  radio.switch_off(1);
  radio.send(hall(), 0, bytes_of(10), 0);
  radio.send(hall(), 1, bytes_of(10), 0);
  EXPECT_TRUE(radio.receive(0, kSecond).empty());
  EXPECT_TRUE(radio.receive(1, kSecond).empty());
  EXPECT_EQ(radio.counts(1).bytes_deaf, 10u);
  EXPECT_EQ(radio.counts(1).bytes_dropped, 10u);
  radio.switch_on(1);
  radio.send(hall(), 0, bytes_of(10), kSecond);
  EXPECT_EQ(radio.receive(1, 2 * kSecond).size(), 1u);
  EXPECT_THROW(radio.send(hall(), 9, bytes_of(1), 0), std::out_of_range);
}

}  // namespace
}  // namespace karst::sim
