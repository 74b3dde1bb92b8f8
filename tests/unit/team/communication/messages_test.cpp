#include "core_stack/team/communication/messages.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <string>

#include "tests/unit/team/communication/random_messages.h"
#include "tests/unit/team/communication/test_radio.h"

namespace karst::core {
namespace {

using testing::below;
using testing::random_record;
using testing::random_state;
using testing::read_frame;
using testing::write_frame;

Random seeded() { return Random(*rc::gen::inRange<std::uint64_t>(1, 1u << 30)); }

TEST(Wire, CompactNumbersHaveOneFormOnly) {
  for (const std::uint32_t v : {0u, 1u, 127u, 128u, 16383u, 16384u, 0xffffffffu}) {
    Bytes bytes;
    WireWriter(bytes).compact(v);
    WireReader r(bytes);
    EXPECT_EQ(r.compact(), v);
    EXPECT_FALSE(r.bad());
    EXPECT_EQ(r.left(), 0u);
  }
  for (const Bytes& wrong : {Bytes{0x80, 0x00}, Bytes{0xff, 0xff, 0xff, 0xff, 0x1f}, Bytes{0x80},
                             Bytes{0x80, 0x80, 0x80, 0x80, 0x80, 0x01}}) {
    WireReader r(wrong);
    r.compact();
    EXPECT_TRUE(r.bad());
  }
}

TEST(Messages, ARecordReadIsTheRecordWritten) {
  rc::check("records", [] {
    Random random = seeded();
    const Record record = random_record(random);
    const auto bytes = write_record(record);
    RC_PRE(bytes.has_value());
    Refusal why{};
    const auto read = read_record(*bytes, why);
    RC_ASSERT(read.has_value());
    RC_ASSERT(read->index() == record.index());
    RC_ASSERT(write_record(*read) == bytes);  // and so are all its numbers
    if (const auto* facts = std::get_if<TreeFacts>(&record)) {
      const auto& got = std::get<TreeFacts>(*read);
      for (std::size_t i = 0; i < facts->nodes.size(); ++i) {
        RC_ASSERT(got.nodes[i].position == facts->nodes[i].position);  // the same doubles
        RC_ASSERT(got.nodes[i].id == facts->nodes[i].id);
      }
      for (std::size_t i = 0; i < facts->rays.size(); ++i) {
        RC_ASSERT(got.rays[i].a == facts->rays[i].a && got.rays[i].b == facts->rays[i].b);
        RC_ASSERT(got.rays[i].free == facts->rays[i].free && got.rays[i].stamp == facts->rays[i].stamp);
      }
    }
  });
}

TEST(Messages, AFrameReadIsTheFrameWritten) {
  rc::check("frames", [] {
    Random random = seeded();
    Frame frame;
    frame.sender = static_cast<RobotId>(below(random, kMaxRobots));
    frame.sent = testing::random_time(random);
    frame.sequence = static_cast<std::uint16_t>(random.bits());
    frame.reports_held = random.uniform() < 0.5;
    if (random.uniform() < 0.7) frame.states.push_back(random_state(random));
    for (std::uint32_t n = below(random, 6); n > 0; --n)
      frame.held.push_back({static_cast<RobotId>(below(random, kMaxRobots)), below(random, kMaxNumber),
                            static_cast<std::uint32_t>(random.bits())});
    if (const auto bytes = write_record(random_record(random)))
      frame.records.push_back({1, 1 + below(random, 1000), *bytes});
    const auto bytes = write_frame(frame);
    RC_PRE(bytes.has_value());
    RC_ASSERT(bytes->size() <= kFrameBytes);
    std::size_t expected = kEmptyFrameBytes;
    for (const auto& s : frame.states) expected += state_bytes(s);
    for (const auto& h : frame.held) expected += held_bytes(h);
    for (const auto& r : frame.records) expected += record_bytes(r);
    RC_ASSERT(bytes->size() == expected);
    Refusal why{};
    const auto read = read_frame(*bytes, why);
    RC_ASSERT(read.has_value());
    RC_ASSERT(read->sender == frame.sender && read->reports_held == frame.reports_held);
    RC_ASSERT(read->sent == frame.sent && read->sequence == frame.sequence);
    RC_ASSERT(write_frame(*read) == bytes);
  });
}

TEST(Messages, WhatOtherRobotsSentStaysWithinTheFrameAtItsLongest) {
  Frame frame;
  frame.sender = kMaxRobots - 1;
  TeamState s;
  s.position = {-40000, 40000, -40000};
  frame.states = {s};
  constexpr std::uint32_t max_records = 1000000;  // gossip.max_records at its most
  for (RobotId i = 0; i < kMaxRobots; ++i) frame.held.push_back({i, max_records, 0});
  frame.reports_held = true;
  ASSERT_TRUE(write_frame(frame));
  Bytes longest(max_record_bytes());
  EXPECT_TRUE(write_frame({.sender = 1, .records = {{15, kMaxNumber - 1, longest}}}));
}

TEST(Messages, AnyDamageIsNoticed) {
  rc::check("damage", [] {
    Random random = seeded();
    Frame frame{.sender = 3, .reports_held = true, .states = {random_state(random)}};
    frame.held = {{1, 7, 0}};
    if (const auto r = write_record(ObjectSeen{})) frame.records.push_back({3, 1, *r});
    Bytes bytes = *write_frame(frame);
    Refusal why{};
    const std::size_t at = random.bits() % bytes.size();
    switch (below(random, 3)) {
      case 0:
        bytes[at] ^= static_cast<std::uint8_t>(1 + below(random, 255));
        break;
      case 1:
        bytes.resize(at);
        break;
      default:
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), 0x55);
    }
    RC_ASSERT(!read_frame(bytes, why).has_value());
  });
}

/// A frame whose tag is right and whose inside is `body`.
Bytes sealed(Bytes body) {
  const Tag tag = tag_of(body, testing::test_key());
  body.insert(body.end(), tag.begin(), tag.end());
  return body;
}

TEST(Messages, HostileFramesAreRefusedByReason) {
  const Bytes head = {0x4b, 0x72, kWireVersion, 2, 0, 0, 0, 0, 0, 0};
  const auto why_of = [](const Bytes& bytes) {
    Refusal why{};
    EXPECT_FALSE(read_frame(bytes, why));
    return why;
  };
  const auto with = [&head](Bytes tail) {
    Bytes body = head;
    body.insert(body.end(), tail.begin(), tail.end());
    return sealed(body);
  };
  Refusal why{};
  EXPECT_TRUE(read_frame(with({0, 0, 0}), why));
  EXPECT_EQ(why_of({}), Refusal::too_short);
  EXPECT_EQ(why_of(Bytes(100000, 7)), Refusal::too_short);
  EXPECT_EQ(why_of(Bytes(50, 0)), Refusal::no_frame);
  EXPECT_EQ(why_of(sealed({0x4b, 0x72, 1, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0})), Refusal::version);
  EXPECT_EQ(why_of({0x4b, 0x72, kWireVersion, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8}),
            Refusal::forged);
  EXPECT_EQ(why_of(with({255, 0, 0})), Refusal::truncated);  // says it holds 255 states
  EXPECT_EQ(why_of(with({0, 0, 1, 1, 1, 250})), Refusal::truncated);
  EXPECT_EQ(why_of(with({0, 0, 0, 9})), Refusal::truncated);  // a byte too many
  EXPECT_EQ(why_of(with({0, 1, kMaxRobots, 0, 0, 0})), Refusal::range);
  EXPECT_EQ(why_of(with({0, 0, 1, 1, 0, 0})), Refusal::range);  // record 0
  Bytes sender = {0x4b, 0x72, kWireVersion, 99, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  EXPECT_EQ(why_of(sealed(sender)), Refusal::range);
}

TEST(Messages, HostileRecordsAreRefusedByReason) {
  const auto why_of = [](const Bytes& bytes) {
    Refusal why{};
    EXPECT_FALSE(read_record(bytes, why));
    return why;
  };
  EXPECT_EQ(why_of({}), Refusal::truncated);
  EXPECT_EQ(why_of({77}), Refusal::kind);
  EXPECT_EQ(why_of({0, 200, 0, 0}), Refusal::truncated);          // 200 nodes in no bytes
  EXPECT_EQ(why_of({0, 0, 1, 0, 3, 1, 1, 1, 2}), Refusal::kind);  // the first ray like the one before
  EXPECT_EQ(why_of({0, 0, 1, 0, 1, 1, 5, 0, 0, 0, 0, 1, 5}), Refusal::range);  // from a node to itself
  Bytes far = {1, 0, 0, 0, 0, 0xff, 0xff, 0x7f, 0, 0, 0, 0, 0, 0, 0};
  EXPECT_EQ(why_of(far), Refusal::range);  // 84 km east
  EXPECT_EQ(why_of(Bytes(300, 1)), Refusal::range);
}

TEST(Messages, WhatCannotBeWrittenIsNot) {
  const double nan = std::nan("");
  EXPECT_FALSE(write_record(GoalClaim{0, {nan, 0, 0}, false}));
  EXPECT_FALSE(write_record(GoalClaim{0, {0, 50000, 0}, false}));
  EXPECT_FALSE(write_record(GoalClaim{-kSecond, {0, 0, 0}, false}));
  EXPECT_FALSE(write_record(ObjectSeen{0, kMaxNumber, 0, {0, 0, 0}, 0}));
  EXPECT_FALSE(write_record(ObjectSeen{0, 0, 0, {0, 0, 0}, nan}));
  TeamState s;
  s.seconds_left = nan;
  EXPECT_FALSE(write_frame({.sender = 1, .states = {s}}));
  EXPECT_FALSE(write_frame({.sender = kMaxRobots}));
}

TEST(Messages, TreeFactsOfAnySizeAreSplitAndLoseNothing) {
  rc::check("splitting", [] {
    Random random = seeded();
    const TreeFacts facts = testing::random_facts(random, 60);
    TreeFacts joined;
    for (const TreeFacts& piece : split(facts)) {
      RC_ASSERT(write_record(piece).has_value());
      joined.nodes.insert(joined.nodes.end(), piece.nodes.begin(), piece.nodes.end());
      joined.rays.insert(joined.rays.end(), piece.rays.begin(), piece.rays.end());
      joined.lives.insert(joined.lives.end(), piece.lives.begin(), piece.lives.end());
    }
    RC_ASSERT(joined.nodes.size() == facts.nodes.size());
    RC_ASSERT(joined.rays.size() == facts.rays.size());
    RC_ASSERT(joined.lives.size() == facts.lives.size());
    for (std::size_t i = 0; i < facts.rays.size(); ++i)
      RC_ASSERT(joined.rays[i].a == facts.rays[i].a && joined.rays[i].b == facts.rays[i].b);
  });
}

TEST(Messages, ANodeOfACorridorWithItsRaysTakesFewBytes) {
  TreeFacts facts;
  facts.nodes = {{{3, 120}, NodeKind::pose, {103.4, -22.1, 3.2}}};
  for (std::uint32_t i = 0; i < 7; ++i) facts.rays.push_back({{3, 120}, {3, 119 - i}, true, 250 * kSecond});
  EXPECT_LE(write_record(facts)->size(), 43u);
}

}  // namespace
}  // namespace karst::core
