#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "core_stack/common/random.h"
#include "plugins/mavlink/wire/frame.h"

namespace karst::mavlink {
namespace {

constexpr Address kSender{1, 1};

std::vector<Frame> frames_in(std::span<const std::uint8_t> bytes, FrameParser& parser) {
  parser.add(bytes);
  std::vector<Frame> found;
  while (auto f = parser.next()) found.push_back(*f);
  return found;
}

TEST(Crc, OfTheStandardCheckText) {
  std::uint16_t crc = kCrcBegin;
  for (const char c : std::string_view("123456789")) crc = crc_add(crc, static_cast<std::uint8_t>(c));
  EXPECT_EQ(crc, 0x6f91);  // CRC-16/MCRF4XX in the catalogue of parametrised CRC algorithms
}

TEST(Wire, ZerosAtTheEndAreLeftOffAndComeBack) {
  const Frame f = frame_of(Heartbeat{0, 2, 12, 0, 0, 0}, kSender);
  EXPECT_EQ(f.size, 6u);  // custom_mode, type, autopilot
  const auto back = f.as<Heartbeat>();
  EXPECT_EQ(back.autopilot, 12);
  EXPECT_EQ(back.system_status, 0);
  EXPECT_EQ(back.mavlink_version, 0);
  EXPECT_EQ(frame_of(Timesync{}, kSender).size, 1u) << "a payload has one byte at least";
}

TEST(Wire, OfALongerMessageTheKnownFieldsAreTaken) {
  Frame f = frame_of(ExtendedSysState{3, 2}, kSender);
  f.bytes[2] = 9;  // a field that was added since
  f.size = 3;
  EXPECT_EQ(f.as<ExtendedSysState>().landed_state, 2);
}

TEST(Parser, FindsFramesCutAnywhere) {
  std::vector<std::uint8_t> all;
  for (int i = 0; i < 20; ++i) {
    const auto one =
        to_wire(frame_of(LocalPositionNed{static_cast<std::uint32_t>(i), 1, 2, 3, 4, 5, 6}, kSender));
    all.insert(all.end(), one.begin(), one.end());
  }
  for (const std::size_t piece : {1u, 2u, 7u, 39u, 41u}) {
    FrameParser parser;
    std::vector<Frame> found;
    for (std::size_t at = 0; at < all.size(); at += piece)
      for (const Frame& f : frames_in(std::span(all).subspan(at, std::min(piece, all.size() - at)), parser))
        found.push_back(f);
    ASSERT_EQ(found.size(), 20u) << piece;
    for (std::uint32_t i = 0; i < 20; ++i) EXPECT_EQ(found[i].as<LocalPositionNed>().time_boot_ms, i);
    EXPECT_EQ(parser.counts().garbage_bytes, 0u);
  }
}

TEST(Parser, AFlippedBitCostsTheFrameAndNoOther) {
  const auto first = to_wire(frame_of(ScaledPressure{1, 2, 3, 4, 5}, kSender));
  const auto second = to_wire(frame_of(ExtendedSysState{1, 2}, kSender));
  for (std::size_t bit = 0; bit < 8 * first.size(); ++bit) {
    std::vector<std::uint8_t> bytes = first;
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ 1 << bit % 8);
    bytes.insert(bytes.end(), second.begin(), second.end());
    // A length that became greater is waited for: other frames come.
    for (int i = 0; i < 30; ++i) bytes.insert(bytes.end(), second.begin(), second.end());
    FrameParser parser;
    const auto found = frames_in(bytes, parser);
    ASSERT_GE(found.size(), 29u) << bit;
    for (const Frame& f : found) EXPECT_TRUE(f.is<ExtendedSysState>()) << bit;
  }
}

TEST(Parser, PassesOverUnknownMessagesAndSignatures) {
  std::vector<std::uint8_t> unknown{0xfd, 4, 0, 0, 0, 1, 1, 0x39, 0x30, 0, 0xfd, 0xfd, 3, 4, 0xaa, 0xbb};
  const auto known = to_wire(frame_of(ExtendedSysState{1, 2}, kSender));
  std::vector<std::uint8_t> all = unknown;
  all.insert(all.end(), known.begin(), known.end());
  FrameParser parser;
  EXPECT_EQ(frames_in(all, parser).size(), 1u);
  EXPECT_EQ(parser.counts().unknown, 1u);
  EXPECT_EQ(parser.counts().garbage_bytes, 0u);

  // A signed frame: the flag is part of the checksum.
  std::vector<std::uint8_t> with_signature = known;
  with_signature[2] = 1;
  std::uint16_t crc = kCrcBegin;
  for (std::size_t i = 1; i < with_signature.size() - 2; ++i) crc = crc_add(crc, with_signature[i]);
  crc = crc_add(crc, *crc_extra_of(ExtendedSysState::kId));
  with_signature[with_signature.size() - 2] = static_cast<std::uint8_t>(crc);
  with_signature[with_signature.size() - 1] = static_cast<std::uint8_t>(crc >> 8);
  with_signature.insert(with_signature.end(), 13, 0x77);
  with_signature.insert(with_signature.end(), known.begin(), known.end());
  FrameParser other;
  EXPECT_EQ(frames_in(with_signature, other).size(), 2u);
  EXPECT_EQ(other.counts().garbage_bytes, 0u);
}

RC_GTEST_PROP(Parser, FindsEveryFrameAfterGarbageWithoutAStart, ()) {
  FrameParser parser;
  int sent = 0, found = 0;
  for (int i = 0; i < 20; ++i) {
    auto garbage = *rc::gen::arbitrary<std::vector<std::uint8_t>>();
    std::replace(garbage.begin(), garbage.end(), std::uint8_t{0xfd}, std::uint8_t{0});
    const auto frame = to_wire(frame_of(Timesync{*rc::gen::arbitrary<std::int64_t>(), i, 1, 1}, kSender));
    garbage.insert(garbage.end(), frame.begin(), frame.end());
    ++sent;
    found += static_cast<int>(frames_in(garbage, parser).size());
  }
  RC_ASSERT(found == sent);
}

RC_GTEST_PROP(Parser, GivesOnlyFramesThatWereSentWhateverTheNoise, (std::uint32_t seed)) {
  core::Random random(seed);
  FrameParser parser;
  int found = 0;
  for (int i = 0; i < 200; ++i) {
    std::vector<std::uint8_t> bytes(random.bits() % 30);
    for (auto& b : bytes) b = random.uniform() < 0.2 ? 0xfd : static_cast<std::uint8_t>(random.bits());
    const auto frame = to_wire(frame_of(LocalPositionNed{4711, 1, 2, 3, 4, 5, 6}, kSender));
    bytes.insert(bytes.end(), frame.begin(), frame.end());
    for (const Frame& f : frames_in(bytes, parser)) {
      RC_ASSERT(f.is<LocalPositionNed>() && f.as<LocalPositionNed>().time_boot_ms == 4711);
      ++found;
    }
  }
  RC_ASSERT(found > 150);  // a start in the noise may swallow one that follows, and no more
}

TEST(Loss, IsCountedByTheGapsInEachComponentsNumbers) {
  LossCount loss;
  const auto note = [&loss](std::uint8_t component, std::uint8_t sequence) {
    Frame f;
    f.from = {1, component};
    f.sequence = sequence;
    loss.note(f);
  };
  for (const int s : {254, 255, 0, 1, 5}) note(1, static_cast<std::uint8_t>(s));
  for (const int s : {10, 12}) note(2, static_cast<std::uint8_t>(s));
  EXPECT_EQ(loss.received(), 7u);
  EXPECT_EQ(loss.lost(), 4u);
  for (const int s : {5, 4, 6}) note(1, static_cast<std::uint8_t>(s));
  EXPECT_EQ(loss.lost(), 4u) << "one came twice and one late";
}

}  // namespace
}  // namespace karst::mavlink
