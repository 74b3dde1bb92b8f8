// The same walk through a room in every kind of bag: the same trajectory, whatever the format.
#include <gtest/gtest.h>

#include "core_stack/common/error.h"
#include "plugins/replay/bag/message_type.h"
#include "plugins/replay/bag_sensors.h"
#include "plugins/replay/recording.h"
#include "plugins/replay/recording_source.h"
#include "plugins/replay/scan_files/decimal_time.h"
#include "plugins/replay/scan_files/scan_file.h"
#include "sdk/evaluation/record/poses.h"
#include "sdk/replay/replay_run.h"
#include "tests/unit/replay/bag/bag_writer.h"
#include "tests/unit/replay/bag/room_bag.h"

namespace karst::replay {
namespace {

using test::BagVariant;
using test::Folder;
using test::kBagScans;
using test::Serializer;
using test::written;
using test::Written;
struct Replayed {
  std::string trajectory;
  ReplaySummary summary;
  SensorStream::Damage damage;
};
Replayed replayed(const std::string& path, const Folder& dir, const std::string& name) {
  const RecordingSource source = open_source(path, "");
  const auto run = dir.path() / ("run_" + name);
  const ReplaySummary s =
      replay_recording(*source.sensors, {}, run, [](auto, const auto&, const auto&) { return true; });
  return {file_bytes((run / "trajectory.tum").string()), s, source.sensors->damage()};
}

std::string expected_trajectory() {
  Folder dir;
  test::write_room_files(dir.path() / "scans");
  return replayed((dir.path() / "scans").string(), dir, "folder").trajectory;
}

TEST(BagReplay, EveryFormatGivesTheTrajectoryOfTheFiles) {
  const std::string expected = expected_trajectory();
  ASSERT_EQ(std::count(expected.begin(), expected.end(), '\n'), kBagScans);
  Folder dir;
  const auto expect_same = [&](const std::string& file, const std::string& name, bool cut = false) {
    const Replayed r = replayed(file, dir, name);
    EXPECT_TRUE(r.trajectory == expected) << name;
    EXPECT_GT(r.summary.imu_samples, 200u) << name;
    EXPECT_EQ(r.damage.count > 0, cut)
        << name << ": " << (r.damage.first.empty() ? "" : r.damage.first.front());
  };
  const Written one = written(Serializer::ros1), little = written(Serializer::cdr_little),
                big = written(Serializer::cdr_big);
  using enum Compression;
  for (const Compression c : {none, bz2, lz4})
    for (const bool index : {true, false}) {
      const std::string name = std::string("ros1_") + core::name_of(c) + (index ? "" : "_unindexed") + ".bag";
      expect_same(dir.write(name, test::ros1_bag(one.topics, one.messages, {c, index, 30})), name, !index);
    }
  for (const Compression c : {none, lz4, zstd})
    for (const bool index : {true, false}) {
      const std::string name =
          std::string("mcap_") + core::name_of(c) + (index ? "" : "_without_summary") + ".mcap";
      expect_same(dir.write(name, test::mcap_file(little.topics, little.messages, {c, index, 30})), name);
    }
  expect_same(dir.write("loose.mcap", test::mcap_file(big.topics, big.messages, {none, false, 0})),
              "loose.mcap");
  for (const bool index : {true, false}) {
    const std::string name = index ? "a.db3" : "b.db3", path = (dir.path() / name).string();
    test::write_db3(path, (index ? little : big).topics, (index ? little : big).messages, index);
    expect_same(path, name);
  }
}

/// ROS 2 begins a new file after so many bytes or seconds.
TEST(BagReplay, AFolderOfSplitBagsIsOneRecording) {
  Folder dir;
  const Written w = written(Serializer::cdr_little);
  std::filesystem::create_directory(dir.path() / "flight");
  constexpr std::size_t kParts = 11;
  for (std::size_t i = 0; i < kParts; ++i) {
    const auto at = [&](std::size_t part) {
      return w.messages.begin() + static_cast<std::ptrdiff_t>(w.messages.size() * part / kParts);
    };
    const std::vector<test::WrittenMessage> part(at(i), at(i + 1));
    dir.write("flight/flight_" + std::to_string(i) + ".mcap",
              test::mcap_file(w.topics, part, {Compression::zstd, true, 10}));
  }
  dir.write("flight/metadata.yaml", "rosbag2_bagfile_information:\n");
  EXPECT_EQ(replayed((dir.path() / "flight").string(), dir, "split").trajectory, expected_trajectory());
}

/// Records in another order than that of time, as they are where several publishers are recorded.
TEST(BagReplay, MessagesOfChunksThatOverlapComeInTheOrderOfTime) {
  Written w = written(Serializer::cdr_little);
  for (std::size_t i = 0; i + 7 < w.messages.size(); i += 7)
    std::reverse(w.messages.begin() + static_cast<std::ptrdiff_t>(i),
                 w.messages.begin() + static_cast<std::ptrdiff_t>(i + 7));
  Folder dir;
  const auto bag =
      open_bag(dir.write("a.mcap", test::mcap_file(w.topics, w.messages, {Compression::zstd, true, 5})));
  core::TimeNs last = 0;
  std::size_t count = 0;
  while (const auto m = bag->next()) {
    EXPECT_GE(m->time, last);
    last = m->time;
    ++count;
  }
  EXPECT_EQ(count, w.messages.size());
}

TEST(BagReplay, OfABagThatIsCutAnywhereTheBeginningIsRead) {
  Folder dir;
  const Written one = written(Serializer::ros1), little = written(Serializer::cdr_little);
  using enum Compression;
  const std::vector<std::pair<std::string, std::string>> files = {
      {"a.bag", test::ros1_bag(one.topics, one.messages, {lz4, true, 30})},
      {"b.bag", test::ros1_bag(one.topics, one.messages, {none, true, 30})},
      {"c.mcap", test::mcap_file(little.topics, little.messages, {zstd, true, 30})},
      {"d.mcap", test::mcap_file(little.topics, little.messages, {none, false, 0})}};
  for (const auto& [name, bytes] : files) {
    std::size_t before = 0;
    for (int part = 1; part <= 20; ++part) {
      const std::string path =
          dir.write(name, bytes.substr(0, bytes.size() * static_cast<std::size_t>(part) / 21));
      const auto bag = open_bag(path);
      std::size_t count = 0;
      while (bag->next()) ++count;
      EXPECT_GE(count, before) << name << " " << part;
      EXPECT_GE(bag->faults().count(), 1u) << name << " " << part;
      before = count;
    }
    EXPECT_GT(before, one.messages.size() * 9 / 10) << name;
    EXPECT_LE(before, one.messages.size()) << name;
  }
}

}  // namespace
}  // namespace karst::replay
