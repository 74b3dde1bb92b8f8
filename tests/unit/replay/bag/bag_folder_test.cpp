// Folders of bags: recorded one after another, or side by side.
#include <gtest/gtest.h>

#include <numeric>

#include "core_stack/common/error.h"
#include "plugins/replay/bag/sensor_messages.h"
#include "tests/unit/replay/bag/bag_writer.h"

namespace karst::replay {
namespace {

using test::Folder;

const std::vector<test::WrittenTopic> kTwoTopics = {{"/a", "std_msgs/String", "string data\n"},
                                                    {"/b", "std_msgs/String", "string data\n"}};

std::vector<test::WrittenMessage> every(core::TimeNs period, std::size_t topic, int from, int to) {
  std::vector<test::WrittenMessage> messages;
  for (int i = from; i < to; ++i) messages.push_back({topic, (i + 1) * period, std::string("\0\1\0\0", 4)});
  return messages;
}

struct Read {
  std::vector<core::TimeNs> times;
  std::vector<std::string> topics;
};
Read read(Bag& bag) {
  Read all;
  while (const auto m = bag.next()) {
    all.times.push_back(m->time);
    all.topics.push_back(bag.connections()[m->connection].topic);
  }
  return all;
}

TEST(BagFolder, BagsRecordedSideBySideAreMergedByTime) {
  Folder dir;
  dir.write("lidar.mcap",
            test::mcap_file(kTwoTopics, every(100, 0, 0, 40), {Compression::zstd, true, 7}));
  test::write_db3((dir.path() / "more.db3").string(), kTwoTopics, every(10, 1, 0, 400), true);
  dir.write("late.bag", test::ros1_bag(kTwoTopics, every(1000, 0, 4, 9), {Compression::lz4, true, 2}));
  const auto bag = open_bag(dir.path().string());
  const Read all = read(*bag);
  EXPECT_EQ(all.times.size(), 445u);
  EXPECT_TRUE(std::is_sorted(all.times.begin(), all.times.end()));
  EXPECT_EQ(std::count(all.topics.begin(), all.topics.end(), "/b"), 400);
  EXPECT_EQ(bag->faults().count(), 0u);
  EXPECT_EQ(all.times.back(), 9000);
}

TEST(BagFolder, AllFaultsOfItsBagsAreCounted) {
  Folder dir;
  for (const char* name : {"s_0.mcap", "s_1.mcap"}) {
    const int first = name[2] == '1' ? 50 : 0;
    std::string bytes =
        test::mcap_file(kTwoTopics, every(100, 0, first, first + 50), {Compression::none, true, 1});
    std::size_t chunk = 0;
    for (std::size_t at = 8; at + 9 < bytes.size();) {
      std::uint64_t length = 0;
      std::memcpy(&length, bytes.data() + at + 1, 8);
      if (bytes[at] == 6 && ++chunk > 10) bytes[at + 9 + length - 1] ^= 1;  // its check sum is wrong
      at += 9 + length;
    }
    dir.write(name, bytes);
  }
  const auto bag = open_bag(dir.path().string());
  EXPECT_EQ(read(*bag).times.size(), 20u);
  EXPECT_EQ(bag->faults().count(), 80u) << "more than a log keeps";
  EXPECT_TRUE(bag->faults().first().front().place.starts_with("s_0.mcap, byte "));
}

}  // namespace
}  // namespace karst::replay
