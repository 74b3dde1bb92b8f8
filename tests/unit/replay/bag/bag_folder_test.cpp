// Bags as a whole: folders of them, recorded one after another or side by side, and files that cannot be
// read.
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
  dir.write("lidar.mcap", test::mcap_file(kTwoTopics, every(100, 0, 0, 40), {Compression::zstd, true, 7}));
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

TEST(BagFolder, NothingIsReadTwiceAfterItsEnd) {
  Folder dir;
  test::write_db3((dir.path() / "a.db3").string(), kTwoTopics, every(10, 0, 0, 4), true);
  for (const std::string& path : {dir.path().string(), (dir.path() / "a.db3").string()}) {
    const auto bag = open_bag(path);
    EXPECT_EQ(read(*bag).times.size(), 4u);
    EXPECT_FALSE(bag->next());
  }
}

std::string opening_error_of(const std::string& path) {
  try {
    open_bag(path);
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "opened";
}

TEST(Bag, AnUnclosedDatabaseIsNamedAndNotReadAsEmpty) {
  Folder dir;
  const std::string path = (dir.path() / "a.db3").string();
  test::write_db3(path, kTwoTopics, every(10, 0, 0, 4), true);
  dir.write("a.db3-wal", "");
  EXPECT_EQ(opening_error_of(path), "opened") << "an empty log holds nothing";
  dir.write("a.db3-wal", "frames");
  EXPECT_NE(opening_error_of(path).find("was not closed: messages of it stand in " + path + "-wal"),
            std::string::npos)
      << opening_error_of(path);
}

TEST(Bag, TimesOfADatabaseBefore1970AreFaults) {
  Folder dir;
  const std::string path = (dir.path() / "a.db3").string();
  auto messages = every(10, 0, 0, 4);
  messages[0].time = std::numeric_limits<core::TimeNs>::min();
  messages[3].time = std::numeric_limits<core::TimeNs>::max();
  test::write_db3(path, kTwoTopics, messages, true);
  const auto bag = open_bag(path);
  EXPECT_EQ(read(*bag).times.size(), 3u);
  EXPECT_EQ(bag->faults().count(), 1u);
}

TEST(Bag, FilesThatAreCompressedOrEmptyAreNamedSo) {
  Folder dir;
  const std::string zstd = dir.write("a_0.db3.zstd", std::string("\x28\xb5\x2f\xfd", 4) + "rest");
  EXPECT_NE(opening_error_of(zstd).find("is compressed as a file"), std::string::npos)
      << opening_error_of(zstd);
  EXPECT_NE(opening_error_of(dir.path().string()).find("is compressed as a file"), std::string::npos)
      << opening_error_of(dir.path().string());
  EXPECT_NE(opening_error_of(dir.write("b.bag", "")).find("b.bag: is empty"), std::string::npos);
}

TEST(Bag, McapMessagesOutsideOfChunksComeInTheOrderOfTime) {
  Folder dir;
  std::vector<test::WrittenMessage> messages;
  const std::string large(3u << 20, '\0');  // two of them are a run
  for (const core::TimeNs time : {0, 100}) messages.push_back({1, time, large});
  for (const core::TimeNs time : {900, 200}) messages.push_back({0, time, "x"});
  messages.push_back({1, 500, large});
  const auto bag =
      open_bag(dir.write("a.mcap", test::mcap_file(kTwoTopics, messages, {Compression::none, true, 0})));
  EXPECT_EQ(read(*bag).times, (std::vector<core::TimeNs>{0, 100, 200, 500, 900}));
}

TEST(BagFolder, AConnectionThatASummaryDoesNotListIsRead) {
  Folder dir;
  std::vector<test::WrittenMessage> messages = every(100, 0, 0, 4);
  for (const test::WrittenMessage& m : every(100, 1, 0, 4)) messages.push_back(m);
  std::string bytes = test::mcap_file(kTwoTopics, messages, {Compression::none, true, 20});
  std::size_t channels = 0;
  for (std::size_t at = 8; at + 9 < bytes.size();) {
    std::uint64_t length = 0;
    std::memcpy(&length, bytes.data() + at + 1, 8);
    if (bytes[at] == 4 && ++channels == 2) bytes[at] = 0x7f;  // the summary's of /b: no such opcode
    at += 9 + length;
  }
  ASSERT_EQ(channels, 2u);
  dir.write("a.mcap", bytes);
  const auto bag = open_bag(dir.path().string());
  ASSERT_EQ(bag->connections().size(), 1u) << "before the chunk is read";
  const Read all = read(*bag);
  EXPECT_EQ(all.times.size(), 8u);
  EXPECT_EQ(std::count(all.topics.begin(), all.topics.end(), "/b"), 4);
  EXPECT_EQ(bag->faults().count(), 0u);
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
