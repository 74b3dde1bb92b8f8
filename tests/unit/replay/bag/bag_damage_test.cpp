// Bags with wrong bytes anywhere: what is intact is read, the rest is named, and nothing else happens.
#include <gtest/gtest.h>

#include <cstring>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "core_stack/common/random.h"
#include "plugins/replay/bag_sensors.h"
#include "tests/unit/replay/bag/room_bag.h"

namespace karst::replay {
namespace {

using test::Folder;
using test::Serializer;
using test::Written;

struct Files {
  std::string name, bytes;
};
std::vector<Files> small_bags(const Folder& dir) {
  using enum Compression;
  Written one = test::written(Serializer::ros1), two = test::written(Serializer::cdr_little);
  for (Written* w : {&one, &two}) {  // two scans are among these
    w->messages.erase(w->messages.begin(), w->messages.begin() + 60);
    w->messages.resize(100);
  }
  test::write_db3((dir.path() / "seed.db3").string(), two.topics, two.messages, true);
  return {{"a.bag", test::ros1_bag(one.topics, one.messages, {none, true, 15})},
          {"b.bag", test::ros1_bag(one.topics, one.messages, {lz4, true, 15})},
          {"c.bag", test::ros1_bag(one.topics, one.messages, {bz2, true, 15})},
          {"d.mcap", test::mcap_file(two.topics, two.messages, {none, true, 15})},
          {"e.mcap", test::mcap_file(two.topics, two.messages, {zstd, true, 15})},
          {"f.mcap", test::mcap_file(two.topics, two.messages, {lz4, false, 15})},
          {"g.mcap", test::mcap_file(two.topics, two.messages, {none, false, 0})},
          {"h.db3", core::read_input((dir.path() / "seed.db3").string(), 1 << 28)}};
}

/// Messages that are read, decoded or not; -1 if the bag cannot be opened.
int read_all(const std::string& path) {
  try {
    const auto bag = open_bag(path);
    MessageDecoder decoder(bag->connections());
    int count = 0;
    while (const auto m = bag->next()) {
      ++count;
      try {
        const Message message = decoder.decode(m->connection, m->bytes);
        const std::string& type = bag->connections()[m->connection].type;
        if (is_cloud_type(type)) cloud_of(type, message, {});
        if (type == "sensor_msgs/Imu") imu_of(message);
      } catch (const MalformedError&) {
      }
    }
    return count;
  } catch (const core::InputError& e) {
    EXPECT_NE(std::string(e.what()).find(path), std::string::npos) << e.what();
    return -1;
  }
}

TEST(BagDamage, WrongBytesAnywhereAreAnErrorOrLeaveTheRestReadable) {
  Folder dir;
  core::Random random(7);
  for (const Files& f : small_bags(dir)) {
    ASSERT_EQ(read_all(dir.write(f.name, f.bytes)), 100) << f.name;
    int opened = 0;
    for (int trial = 0; trial < 40; ++trial) {
      std::string bytes = f.bytes;
      const auto at = static_cast<std::size_t>(random.uniform() * static_cast<double>(bytes.size() - 1));
      for (std::size_t k = at; k < std::min(bytes.size(), at + 1 + static_cast<std::size_t>(trial % 8)); ++k)
        bytes[k] = static_cast<char>(static_cast<unsigned char>(random.uniform() * 256));
      opened += read_all(dir.write(f.name, bytes)) >= 0;
    }
    // Without a summary, only the first chunk tells the topics.
    EXPECT_GT(opened, f.name == "f.mcap" ? 15 : 30) << f.name;
  }
}

template <class T>
T number_at(const std::string& bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}
template <class T>
void set_number(std::string& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

/// The second chunk's length leads over the third to the end of the fourth.
std::string with_long_chunk_of_rosbag(std::string bytes) {
  std::vector<std::size_t> lengths, ends;  // of the chunks
  for (std::size_t at = 13; at < bytes.size();) {
    const std::size_t length = at + 4 + number_at<std::uint32_t>(bytes, at),
                      end = length + 4 + number_at<std::uint32_t>(bytes, length);
    if (bytes.substr(at, length - at).find("op=\5") != std::string::npos) {
      lengths.push_back(length);
      ends.push_back(end);
    }
    at = end;
  }
  set_number(bytes, lengths.at(1), static_cast<std::uint32_t>(ends.at(3) - lengths.at(1) - 4));
  return bytes;
}
std::string with_long_chunk_of_mcap(std::string bytes) {
  std::vector<std::size_t> records, ends;  // of the chunks
  for (std::size_t at = 8; at + 9 < bytes.size();) {
    const std::size_t end = at + 9 + number_at<std::uint64_t>(bytes, at + 1);
    if (bytes[at] == 6) {
      records.push_back(at);
      ends.push_back(end);
    }
    at = end;
  }
  const std::size_t at = records.at(1), name = number_at<std::uint32_t>(bytes, at + 9 + 28),
                    size = at + 9 + 32 + name;
  set_number(bytes, at + 1, static_cast<std::uint64_t>(ends.at(3) - at - 9));
  set_number(bytes, size, static_cast<std::uint64_t>(ends.at(3) - size - 8));
  return bytes;
}

TEST(BagDamage, ChunksInsideTheLengthThatAnotherAnnouncesAreRead) {
  Folder dir;
  for (const Files& f : small_bags(dir)) {
    if (f.name >= "f.mcap") continue;  // without an index
    const std::string path = dir.write(f.name, f.name.ends_with(".bag") ? with_long_chunk_of_rosbag(f.bytes)
                                                                        : with_long_chunk_of_mcap(f.bytes));
    EXPECT_EQ(read_all(path), 100) << f.name;
    const auto bag = open_bag(path);
    while (bag->next()) continue;
    EXPECT_EQ(bag->faults().count(), 1u) << f.name;
  }
}

/// A piece from within the third chunk to within the fourth is missing, not as long as a chunk: all offsets
/// behind it are wrong.
std::string with_hole(const Files& f) {
  std::vector<std::size_t> begins;
  if (f.name.ends_with(".bag")) {
    for (std::size_t at = f.bytes.find("compression="); at != std::string::npos;
         at = f.bytes.find("compression=", at + 1))
      begins.push_back(at);
  } else {
    for (std::size_t at = 8; at + 9 < f.bytes.size(); at += 9 + number_at<std::uint64_t>(f.bytes, at + 1))
      if (f.bytes[at] == 6) begins.push_back(at);
  }
  const std::size_t from = (begins.at(2) + begins.at(3)) / 2, to = (begins.at(3) + begins.at(4)) / 2 + 37;
  return f.bytes.substr(0, from) + f.bytes.substr(to);
}

TEST(BagDamage, BehindAPieceThatIsMissingTheNextChunksAreRead) {
  Folder dir;
  for (const Files& f : small_bags(dir)) {
    if (f.name >= "g.mcap") continue;  // without chunks
    const std::string bytes = with_hole(f), path = dir.write(f.name, bytes);
    const int count = read_all(path);  // of 100 in chunks of 15, two chunks are damaged
    EXPECT_GE(count, 70) << f.name;
    EXPECT_LT(count, 100) << f.name;
    const auto bag = open_bag(path);
    core::TimeNs before = 0, last = 0;
    while (const auto m = bag->next()) {
      EXPECT_GE(m->time, before) << f.name;
      before = last = m->time;
    }
    const auto whole = open_bag(dir.write("whole_" + f.name, f.bytes));
    while (const auto m = whole->next()) before = m->time;
    EXPECT_EQ(last, before) << f.name << ": the last message is read";
    std::string faults;
    for (const Fault& fault : bag->faults().first()) faults += fault.place + ": " + fault.reason + "\n";
    EXPECT_NE(faults.find("reading goes on with the chunk at byte "), std::string::npos) << f.name << faults;
    EXPECT_EQ(faults.find("summary"), std::string::npos) << f.name << faults;
  }
}

TEST(BagDamage, OfWhatNoChunkFollowsTheBytesAreCounted) {
  Folder dir;
  const Files f = small_bags(dir).at(4);
  std::string bytes = f.bytes.substr(0, f.bytes.size() * 2 / 3);
  int chunk = 0;
  std::size_t begin = 0;
  for (std::size_t at = 8; at + 9 < bytes.size(); at += 9 + number_at<std::uint64_t>(bytes, at + 1))
    if (bytes[at] == 6 && ++chunk == 3) begin = at;
  for (std::size_t i = begin; i < bytes.size(); ++i) bytes[i] = '\x77';
  const auto bag = open_bag(dir.write("end.mcap", bytes));
  ASSERT_GT(bag->faults().count(), 0u);
  EXPECT_EQ(bag->faults().first().front().place, "byte " + std::to_string(begin));
  EXPECT_EQ(bag->faults().first().front().reason, "no record begins here; the " +
                                                      std::to_string(bytes.size() - begin) +
                                                      " bytes from there on are not read");
}

/// The second chunk says that it holds 10 bytes, decompressed.
std::string with_small_chunk(const Files& f) {
  std::string bytes = f.bytes;
  if (f.name.ends_with(".bag")) {
    const std::size_t first = bytes.find("size=", bytes.find("compression=")),
                      second = bytes.find("size=", bytes.find("compression=", first));
    set_number(bytes, second + 5, std::uint32_t{10});
    return bytes;
  }
  int chunk = 0;
  for (std::size_t at = 8; at + 9 < bytes.size(); at += 9 + number_at<std::uint64_t>(bytes, at + 1))
    if (bytes[at] == 6 && ++chunk == 2) set_number(bytes, at + 9 + 16, std::uint64_t{10});
  return bytes;
}

TEST(BagDamage, AChunkThatAnnouncesTooFewBytesIsRead) {
  Folder dir;
  for (const Files& f : small_bags(dir))
    if (f.name < "g.mcap") {
      EXPECT_EQ(read_all(dir.write(f.name, with_small_chunk(f))), 100) << f.name;
    }
}

TEST(BagDamage, OfADatabaseThatIsCutTheBeginningIsRead) {
  Folder dir;
  const std::string bytes = small_bags(dir).back().bytes;
  const std::string path = dir.write("cut.db3", bytes.substr(0, bytes.size() / 2 / 4096 * 4096));
  const int count = read_all(path);
  EXPECT_GT(count, 20);
  EXPECT_LT(count, 100);
  const auto bag = open_bag(path);
  while (bag->next()) continue;
  ASSERT_GT(bag->faults().count(), 0u);
  const std::size_t cut = bytes.size() / 2 / 4096 * 4096;
  EXPECT_EQ(bag->faults().first().front().place, "byte " + std::to_string(cut));
  EXPECT_NE(bag->faults().first().front().reason.find("its header says " + std::to_string(bytes.size())),
            std::string::npos)
      << bag->faults().first().front().reason;
}

/// SQLite finds nothing where the pages that lead to the messages are missing.
TEST(BagDamage, OfADatabaseWithoutItsMessagesTheErrorSaysThatItIsDamaged) {
  Folder dir;
  const std::string bytes = small_bags(dir).back().bytes;
  std::string cut = bytes.substr(0, bytes.size() / 2 / 4096 * 4096);
  for (std::size_t page = 4096; page < cut.size(); page += 4096)
    if (cut[page] == 5) cut[page] = 0;  // an inner page of a table
  try {
    open_bag_recording(dir.write("cut.db3", cut), "");
    ADD_FAILURE() << "a scan was found";
  } catch (const core::InputError& e) {
    const std::string text = e.what();
    for (const char* part : {"cut.db3: No topic has scans", "The bag is damaged: byte ", "its header says ",
                             "database disk image is malformed"})
      EXPECT_NE(text.find(part), std::string::npos) << text;
  }
}

// The first read beyond the record, the second never ended: its pages lead in a circle.
TEST(BagDamage, WhatFuzzersFoundIsNamedAndEnds) {
  const std::string seeds = std::string(KARST_SOURCE_DIR) + "/tests/fuzz/seeds/";
  for (const char* seed : {"mcap/index_too_short.mcap", "db3/circle.db3"}) {
    const auto bag = open_bag(seeds + seed);
    while (bag->next()) continue;
    EXPECT_GT(bag->faults().count(), 0u) << seed;
  }
}

}  // namespace
}  // namespace karst::replay
