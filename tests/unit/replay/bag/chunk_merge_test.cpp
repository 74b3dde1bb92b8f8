// Chunks whose times overlap as they like, merged: the order of a sort, and few chunks in memory.
#include "plugins/replay/bag/chunk_merge.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core_stack/common/random.h"
#include "plugins/replay/bag/decompress.h"
#include "tests/unit/replay/bag/bag_writer.h"

namespace karst::replay {
namespace {

struct Chunks {
  std::vector<core::TimeNs> start;
  std::vector<std::vector<ChunkMessage>> messages;
};

/// Messages of 10 bytes; each chunk lasts `length`, and begins 100 after the one before.
Chunks random_chunks(core::Random& random, std::size_t count, double length) {
  Chunks c;
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<ChunkMessage> messages;
    const auto size = static_cast<std::size_t>(random.uniform() * 8);
    for (std::size_t k = 0; k < size; ++k)
      messages.push_back({static_cast<core::TimeNs>(100 * static_cast<double>(i) + random.uniform() * length),
                          i, 10 * k, 10});
    core::TimeNs start = static_cast<core::TimeNs>(100 * i);
    for (const auto& m : messages) start = &m == &messages.front() ? m.time : std::min(start, m.time);
    c.start.push_back(start);
    c.messages.push_back(std::move(messages));
  }
  return c;
}

TEST(ChunkMerge, GivesTheOrderOfASort) {
  core::Random random(3);
  for (int trial = 0; trial < 200; ++trial) {
    const Chunks c =
        random_chunks(random, static_cast<std::size_t>(random.uniform() * 20), random.uniform() * 1000);
    std::vector<core::TimeNs> expected, found;
    for (const auto& chunk : c.messages)
      for (const auto& m : chunk) expected.push_back(m.time);
    std::sort(expected.begin(), expected.end());
    ChunkMerge merge(
        c.start,
        [&](std::size_t i) {
          return LoadedChunk{std::string(80, 'x'), c.messages[i]};
        },
        1u << 30);
    while (const auto item = merge.next()) {
      found.push_back(item->message.time);
      EXPECT_EQ(item->message.connection, item->chunk);
      EXPECT_EQ(item->bytes.size(), 10u);
    }
    EXPECT_EQ(found, expected);
  }
}

/// Chunks that claim to begin all at once would fill the memory.
TEST(ChunkMerge, ReadsNoMoreThanItMayKeep) {
  std::size_t loaded = 0, given = 0;
  ChunkMerge merge(
      std::vector<core::TimeNs>(100, 0),
      [&](std::size_t i) {
        ++loaded;
        return LoadedChunk{std::string(1000, 'x'), {{static_cast<core::TimeNs>(i), i, 0, 10}}};
      },
      5000);
  while (merge.next()) {
    ++given;
    EXPECT_LE(loaded, given + 5);
  }
  EXPECT_EQ(given, 100u);
}

TEST(Decompress, GivesWhatWasCompressedAndOfACutChunkTheBeginning) {
  std::string text;
  core::Random random(5);
  for (int i = 0; i < 300'000; ++i) text += static_cast<char>(random.uniform() * 40);
  using enum Compression;
  for (const Compression c : {none, bz2, lz4, zstd}) {
    const std::string stored = test::compressed(c, text);
    const Decompressed whole = decompress(c, stored, text.size());
    EXPECT_TRUE(whole.bytes == text && whole.problem.empty()) << core::name_of(c) << whole.problem;
    if (c == none) continue;
    EXPECT_NE(decompress(c, stored, text.size() + 1).problem, "");
    const Decompressed cut = decompress(c, Bytes(stored).first(stored.size() * 9 / 10), text.size());
    EXPECT_NE(cut.problem, "") << core::name_of(c);
    EXPECT_TRUE(text.starts_with(cut.bytes)) << core::name_of(c);
    EXPECT_EQ(decompress(c, {}, 5).bytes, "");
    EXPECT_NE(decompress(c, text, 5).problem, "");
  }
}

/// A few hundred bytes that decompress to gigabytes.
TEST(Decompress, ABombIsRefused) {
  std::string zeros(4u << 20, '\0'), frame = test::compressed(Compression::zstd, zeros);
  const Decompressed d = decompress(Compression::zstd, frame, 100);
  EXPECT_NE(d.problem.find("instead of the 100"), std::string::npos) << d.problem;
}

}  // namespace
}  // namespace karst::replay
