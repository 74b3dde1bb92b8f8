// `karst recording info` as a command, and `karst replay` of bags: what they print, and their exit codes.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "core_stack/common/error.h"
#include "plugins/replay/recording_info.h"
#include "sdk/tools/recording_command.h"
#include "sdk/tools/replay_command.h"
#include "tests/unit/replay/bag/room_bag.h"

namespace karst::tools {
namespace {

using test::Folder;

struct Printed {
  int code = 0;
  std::string out, error;
};

Printed run(std::vector<std::string> words) {
  CLI::App app{"karst", "karst"};
  add_recording_command(app);
  add_replay_command(app);
  std::reverse(words.begin(), words.end());
  Printed p;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  std::string thrown;
  try {
    app.parse(words);
  } catch (const CLI::RuntimeError& e) {
    p.code = e.get_exit_code();
  } catch (const core::InputError& e) {
    p.code = 1;
    thrown = e.what();
  }
  p.out = testing::internal::GetCapturedStdout();
  p.error = testing::internal::GetCapturedStderr() + thrown;
  return p;
}

std::string room_mcap() {
  test::Written w = test::written(test::Serializer::cdr_little);
  return test::mcap_file(w.topics, w.messages, {replay::Compression::zstd, true, 30});
}

TEST(RecordingCommand, PrintsARecordingFile) {
  Folder dir;
  const std::string bag = dir.write("room.mcap", room_mcap());
  const Printed p = run({"recording", "info", bag});
  EXPECT_EQ(p.code, 0) << p.error;
  EXPECT_NE(p.out.find("/os/points"), std::string::npos);
  EXPECT_NE(p.out.find("sensor_msgs/PointCloud2"), std::string::npos);
  const replay::RecordingInfo info = replay::read_recording_info(dir.write("room.info", p.out));
  EXPECT_EQ(info.lidar_topic, "/os/points");
  EXPECT_EQ(info.imu_topic, "/os/imu");
  EXPECT_EQ(info.time_unit, "ns");
}

TEST(RecordingCommand, PrintsJson) {
  Folder dir;
  const Printed p = run({"recording", "info", dir.write("room.mcap", room_mcap()), "--json"});
  const auto j = nlohmann::json::parse(p.out);
  EXPECT_EQ(j["schema"], "karst.recording/1");
  EXPECT_EQ(j["topics"].size(), 2u);
  EXPECT_EQ(j["topics"][0]["messages"], test::kBagScans);
  EXPECT_NEAR(j["topics"][0]["rate_hz"].get<double>(), 10, 1e-6);
  EXPECT_TRUE(j["open"].empty());
  EXPECT_EQ(j["fault_count"], 0);
}

TEST(RecordingCommand, OfADamagedBagItTellsThePlaceAndTheRest) {
  Folder dir;
  const std::string whole = room_mcap(), bag = dir.write("cut.mcap", whole.substr(0, whole.size() / 2));
  const Printed p = run({"recording", "info", bag});
  EXPECT_EQ(p.code, 1);
  EXPECT_NE(p.out.find("/os/points"), std::string::npos);
  EXPECT_NE(p.error.find(bag + ": byte "), std::string::npos) << p.error;
}

TEST(RecordingCommand, WhatIsNoBagIsAnError) {
  Folder dir;
  const auto refused = [&](const std::string& name, const std::string& bytes, const std::string& reason) {
    const Printed p = run({"recording", "info", dir.write(name, bytes)});
    EXPECT_EQ(p.code, 1) << name;
    EXPECT_NE(p.error.find(name + ": "), std::string::npos) << p.error;
    EXPECT_NE(p.error.find(reason), std::string::npos) << p.error;
  };
  refused("empty.bag", "", "is empty");
  refused("text.mcap", "not a bag at all", "is no bag");
  refused("old.bag", "#ROSBAG V1.2\n1234", "another version");
  refused("head.bag", "#ROSBAG V2.0\n", "");
  refused("head.mcap", std::string("\x89MCAP0\r\n", 8), "");
  refused("head.db3", std::string("SQLite format 3\0", 16), "");
}

TEST(RecordingCommand, OfAFolderOfScansItPointsToReplay) {
  Folder dir;
  test::write_room_files(dir.path() / "scans");
  const Printed p = run({"recording", "info", (dir.path() / "scans").string()});
  EXPECT_EQ(p.code, 1);
  EXPECT_NE(p.error.find("scans: is a folder of scans, not a bag: karst replay reads it"), std::string::npos)
      << p.error;
}

TEST(ReplayCommand, OfABagSaysWhatItAssumedAndOfADamagedOneWhatItLeftOut) {
  Folder dir;
  const std::string whole = room_mcap(), bag = dir.write("room.mcap", whole);
  const Printed p = run({"replay", bag, "--out", (dir.path() / "run").string(), "--no-report"});
  EXPECT_EQ(p.code, 0) << p.error;
  EXPECT_NE(p.error.find("The LiDAR is /os/points"), std::string::npos) << p.error;
  EXPECT_NE(p.out.find("12 scans, 0 of them lost"), std::string::npos) << p.out;
  const std::string cut = dir.write("cut.mcap", whole.substr(0, whole.size() * 2 / 3));
  const Printed damaged =
      run({"replay", cut, "--out", (dir.path() / "run2").string(), "--no-report", "--quiet"});
  EXPECT_EQ(damaged.code, 1);
  EXPECT_NE(damaged.out.find(" scans, 0 of them lost"), std::string::npos) << damaged.out;
  EXPECT_NE(damaged.error.find("the bag is damaged"), std::string::npos) << damaged.error;
}

}  // namespace
}  // namespace karst::tools
