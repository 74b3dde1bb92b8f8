// Records pass between two threads in their order; what finds no room is counted.
#include "sdk/live/record_feed.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace karst::live {
namespace {

using core::RecordPart;

TEST(RecordFeed, EachRecordArrivesOnceInOrderWithItsPart) {
  RecordFeed feed;
  constexpr int kRecords = 100000;
  std::thread recorder([&] {
    for (int i = 0; i < kRecords; ++i)
      feed.on_record(i % 2 ? RecordPart::events : RecordPart::map_growth,
                     std::to_string(i) + std::string(i % 7, '.'));
    feed.on_close();
  });
  int next = 0;
  bool closed = false;
  std::uint64_t lost = 0;
  while (!closed) {
    const RecordFeed::Progress progress = feed.read([&](RecordPart part, std::string_view bytes) {
      ASSERT_EQ(bytes, std::to_string(next) + std::string(next % 7, '.'));
      ASSERT_EQ(part, next % 2 ? RecordPart::events : RecordPart::map_growth);
      ++next;
    });
    closed = progress.closed;
    lost = progress.lost;
  }
  recorder.join();
  EXPECT_EQ(next, kRecords);
  EXPECT_EQ(lost, 0u);
}

TEST(RecordFeed, WithoutAReaderItHoldsNoMoreThanItsBounds) {
  RecordFeed feed;
  const std::string megabyte(1 << 20, 'x');
  constexpr std::uint64_t kRecords = 100;
  for (std::uint64_t i = 0; i < kRecords; ++i) feed.on_record(RecordPart::events, megabyte);
  feed.on_close();
  std::uint64_t read = 0, lost = 0;
  for (int i = 0; i < 3; ++i) lost = feed.read([&](RecordPart, std::string_view) { ++read; }).lost;
  EXPECT_LE(read, 2 * RecordFeed::kMaxBytes >> 20);
  EXPECT_GT(lost, 30u);
  EXPECT_EQ(read + lost, kRecords);
}

}  // namespace
}  // namespace karst::live
