// Bags with wrong bytes anywhere: what is intact is read, the rest is named, and nothing else happens.
#include <gtest/gtest.h>

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
