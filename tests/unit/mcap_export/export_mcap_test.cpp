// A run directory becomes one file, and what is refused. interop.mjs compares the messages with the run.
#include "sdk/mcap_export/export_mcap.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <set>

#include "core_stack/common/error.h"
#include "plugins/replay/bag/bag.h"
#include "plugins/replay/recording_source.h"
#include "sdk/evaluation/record/run_record.h"
#include "sdk/mcap_export/event_words.h"
#include "tests/unit/evaluation/fake_run.h"
#include "tests/unit/mcap_export/mcap_records_read.h"

namespace karst::mcap {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class ExportMcap : public testing::Test {
 protected:
  ExportMcap() { test::write_fake_run(run_, {.length_m = 12}); }
  McapExport exported(std::optional<core::TimeNs> epoch = {}) const {
    return export_mcap(run_, file_, epoch, "1");
  }
  std::string error(const fs::path& file) const {
    try {
      export_mcap(run_, file, {}, "1");
    } catch (const core::InputError& e) {
      return e.what();
    }
    return "";
  }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(out_), {}));
  }
  void cut(const char* name) const { fs::resize_file(run_ / name, fs::file_size(run_ / name) - 5); }

  const test::TemporaryDirectory folder_;
  const fs::path run_ = folder_.path() / "run", out_ = folder_.path() / "out", file_ = out_ / "a.mcap";
  const bool made_ = fs::create_directories(out_);
};

TEST_F(ExportMcap, HasAMessageForEachPoseAndTheTopicsOfWhatTheRunHolds) {
  const McapExport made = exported();
  const evaluation::RunRecord run = evaluation::read_run(run_);
  std::map<std::string, std::uint64_t> counts;
  for (const TopicCount& t : made.topics) counts[t.name] = t.messages;
  EXPECT_EQ(counts["/odometry"], run.estimate.size());
  EXPECT_EQ(counts["/truth/odometry"], run.truth.size());
  EXPECT_EQ(counts["/tf"], run.estimate.size() + run.truth.size());
  for (const char* topic : {"/path", "/map", "/map/new", "/plan", "/frontiers", "/goals", "/drawings",
                            "/phase", "/battery", "/events"})
    EXPECT_GT(counts[topic], 0u) << topic;
  EXPECT_EQ(made.bytes, fs::file_size(file_));
  EXPECT_EQ(files(), 1u);
}

TEST_F(ExportMcap, TimesNeverFallAndCountFromTheEpoch) {
  exported(1000 * core::kSecond);
  const auto messages = test::messages_of(bytes_of(file_));
  EXPECT_GE(messages.front().time_ns, 1'000'000'000'000u);
  EXPECT_TRUE(std::is_sorted(messages.begin(), messages.end(),
                             [](const auto& a, const auto& b) { return a.time_ns < b.time_ns; }));
}

TEST_F(ExportMcap, TheSameRunGivesTheSameBytes) {
  exported();
  const std::string first = bytes_of(file_);
  exported();
  EXPECT_EQ(bytes_of(file_), first);
}

TEST_F(ExportMcap, WithoutATrajectoryIsRefusedAndLeavesNoFile) {
  fs::remove(run_ / "trajectory.tum");
  EXPECT_NE(error(file_).find("trajectory.tum: is not there"), std::string::npos) << error(file_);
  std::ofstream(run_ / "trajectory.tum") << "";
  EXPECT_NE(error(file_).find("holds no pose"), std::string::npos) << error(file_);
  EXPECT_EQ(files(), 0u);
}

TEST_F(ExportMcap, WhatIsNoRunDirectoryIsRefused) {
  EXPECT_THROW(export_mcap(folder_.path() / "none", file_, {}, "1"), core::InputError);
  const fs::path empty = folder_.path() / "empty";
  fs::create_directories(empty);
  EXPECT_THROW(export_mcap(empty, file_, {}, "1"), core::InputError);
  EXPECT_EQ(files(), 0u);
}

TEST_F(ExportMcap, OfFilesThatAreCutOffWhatCanBeReadIsExportedAndTheRestReported) {
  const std::size_t poses = evaluation::read_run(run_).estimate.size();
  for (const char* name : {"trajectory.tum", "events.jsonl", "telemetry.csv", "map_growth.bin"}) cut(name);
  const McapExport made = exported();
  const auto reported = [&](const char* name) {
    return std::any_of(made.problems.begin(), made.problems.end(),
                       [&](const std::string& p) { return p.find(name) != std::string::npos; });
  };
  for (const char* name : {"trajectory.tum", "events.jsonl", "telemetry.csv", "map_growth.bin"})
    EXPECT_TRUE(reported(name)) << name;
  for (const TopicCount& t : made.topics)
    if (t.name == "/odometry") {
      EXPECT_EQ(t.messages, poses - 1);
    }
}

TEST_F(ExportMcap, WithNothingButATrajectoryThereIsAPath) {
  for (const char* name :
       {"events.jsonl", "telemetry.csv", "map_growth.bin", "ground_truth.tum", "truth.csv"})
    fs::remove(run_ / name);
  std::set<std::string> topics;
  for (const TopicCount& t : exported().topics) topics.insert(t.name);
  EXPECT_EQ(topics, (std::set<std::string>{"/tf", "/odometry", "/path"}));
}

TEST_F(ExportMcap, AFullDiskIsAnErrorWithItsReason) {
  EXPECT_NE(error("/dev/full").find("/dev/full: cannot be written: No space left"), std::string::npos)
      << error("/dev/full");
}

/// Files of this process may not grow beyond a size, as on a disk that is full.
class SmallFiles {
 public:
  explicit SmallFiles(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit small{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~SmallFiles() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  SmallFiles(const SmallFiles&) = delete;
  SmallFiles& operator=(const SmallFiles&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_{};
};

TEST_F(ExportMcap, OfAFileThatDoesNotFitNothingRemainsAndTheOldOneStays) {
  for (const rlim_t bytes : {10u, 5'000u, 20'000u}) {
    const SmallFiles small(bytes);
    EXPECT_NE(error(file_).find("a.mcap: cannot be written: File too large"), std::string::npos)
        << error(file_);
    EXPECT_EQ(files(), 0u);
  }
  exported();
  const std::string whole = bytes_of(file_);
  ASSERT_GT(whole.size(), 20'000u);
  {
    const SmallFiles small(5'000);
    EXPECT_NE(error(file_), "");
  }
  EXPECT_EQ(bytes_of(file_), whole);
  EXPECT_EQ(files(), 1u);
}

TEST_F(ExportMcap, AStoredMapThatIsDamagedIsReportedAndItsGrowthExported) {
  std::ofstream(run_ / "map.bt") << "# Octomap OcTree binary file\nid OcTree\nsize 100\nres 0.2\ndata\nx";
  const McapExport made = exported();
  EXPECT_TRUE(std::any_of(made.problems.begin(), made.problems.end(),
                          [](const std::string& p) { return p.find("map.bt") != std::string::npos; }));
  EXPECT_TRUE(std::any_of(made.topics.begin(), made.topics.end(),
                          [](const TopicCount& t) { return t.name == "/map" && t.messages > 1; }));
}

TEST_F(ExportMcap, OfATeamOneRobotIsNamed) {
  const fs::path team = folder_.path() / "team";
  fs::create_directories(team / "robot_1");
  std::ofstream(team / "team.jsonl") << "";
  try {
    export_mcap(team, file_, {}, "1");
    ADD_FAILURE() << "a team was exported";
  } catch (const core::InputError& e) {
    EXPECT_NE(std::string(e.what()).find("team/robot_1"), std::string::npos) << e.what();
  }
}

TEST_F(ExportMcap, OfAVehicleWithoutALidarTheImuIsExported) {
  fs::create_directories(run_ / "scans");
  std::ofstream(run_ / "scans/imu.csv") << "t,ax,ay,az,wx,wy,wz\n0.1,0,0,9.8,0,0,0\n";
  const McapExport made = exported();
  std::map<std::string, std::uint64_t> counts;
  for (const TopicCount& t : made.topics) counts[t.name] = t.messages;
  EXPECT_EQ(counts["/imu"], 1u);
  EXPECT_FALSE(counts.contains("/points"));
  EXPECT_TRUE(std::none_of(made.problems.begin(), made.problems.end(),
                           [](const std::string& p) { return p.find("scans") != std::string::npos; }));
}

TEST_F(ExportMcap, AFileThatCannotBeMadeIsAnErrorAndLeavesNothing) {
  EXPECT_NE(error(out_ / "none" / "a.mcap").find("No such file"), std::string::npos);
  fs::create_directory(file_);  // cannot be renamed onto
  EXPECT_NE(error(file_).find("a.mcap: cannot be written"), std::string::npos) << error(file_);
  EXPECT_EQ(files(), 1u);
  EXPECT_TRUE(fs::is_directory(file_));
}

TEST_F(ExportMcap, AFileThatWasThereStaysUntilTheNewOneIsWhole) {
  std::ofstream(file_) << "before";
  fs::remove(run_ / "trajectory.tum");
  error(file_);
  EXPECT_EQ(bytes_of(file_), "before");
}

TEST_F(ExportMcap, PicturesThatAreMissingOrDamagedAreLeftOutAndReported) {
  std::ofstream(run_ / "frames.csv") << "stamp_s,file,x,y,z,qx,qy,qz,qw,width,height,fx,fy,cx,cy\n"
                                        "0.5,frames/a.jpg,0,0,1,0,0,0,1,320,240,200,200,160,120\n"
                                        "1.0,frames/b.jpg,0,0,1,0,0,0,1,320,240,200,200,160,120\n"
                                        "1.5,,0,0,1,0,0,0,1,320,240,200,200,160,120\n"
                                        "2.0,frames/c.jpg,0,0,1,0,0,0,1,nan,240,200,200,160,120\n";
  fs::create_directories(run_ / "frames");
  std::ofstream(run_ / "frames/a.jpg") << "\xff\xd8picture";
  std::ofstream(run_ / "frames/b.jpg") << "no picture";
  const McapExport made = exported();
  for (const TopicCount& t : made.topics)
    if (t.name.starts_with("/camera")) {
      EXPECT_EQ(t.messages, 1u) << t.name;
    }
  EXPECT_EQ(std::count_if(made.problems.begin(), made.problems.end(),
                          [](const std::string& p) {
                            return p.find("b.jpg") != std::string::npos ||
                                   p.find("frames.csv: picture 4") != std::string::npos;
                          }),
            2);
}

TEST_F(ExportMcap, ADamagedScanEndsItsTopicAndIsReported) {
  fs::create_directories(run_ / "scans");
  const std::string header =
      "VERSION 0.7\nFIELDS x y z intensity t ring\nSIZE 4 4 4 4 4 2\nTYPE F F F F U U\nCOUNT 1 1 1 1 1 1\n"
      "WIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA binary\n";
  std::ofstream(run_ / "scans/recording.info")
      << "scans \"*.pcd\"\nstamp { from names unit ns of start }\nimu { file imu.csv }\n";
  std::ofstream(run_ / "scans/imu.csv") << "t,ax,ay,az,wx,wy,wz\n0.1,0,0,9.8,0,0,0\n0.2,0,0,9.8,0\n";
  for (const char* name : {"100000000.pcd", "300000000.pcd"})
    std::ofstream(run_ / "scans" / name) << header << std::string(22, '\0');
  std::ofstream(run_ / "scans/200000000.pcd") << header << "cut";
  const McapExport made = exported();
  std::map<std::string, std::uint64_t> counts;
  for (const TopicCount& t : made.topics) counts[t.name] = t.messages;
  EXPECT_EQ(counts["/points"], 1u);
  EXPECT_EQ(counts["/imu"], 1u);
  for (const char* place : {"200000000.pcd", "imu.csv: line 3"})
    EXPECT_TRUE(std::any_of(made.problems.begin(), made.problems.end(), [&](const std::string& p) {
      return p.find(place) != std::string::npos && p.find("left out") != std::string::npos;
    })) << place;
}

void append(std::string& bytes, auto value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Returns between the least and the greatest range of the LiDAR, some nearer than a bag's default of 0.5 m.
TEST_F(ExportMcap, TheFileReplaysWithTheRangeOfItsRecording) {
  fs::create_directories(run_ / "scans");
  std::ofstream(run_ / "scans/recording.info") << "scans \"*.pcd\"\nstamp { from names unit ns of start "
                                                  "}\ntime { unit ns of start period \"0.1 s\" }\n"
                                                  "lidar { position \"0 0 0.1\" rotation \"0 30.1234567891 "
                                                  "0\" min_range \"0.3 m\" max_range \"150 m\" }\n"
                                                  "rings { by field }\n";
  constexpr int kPoints = 50;
  for (int scan = 1; scan <= 3; ++scan) {
    std::ofstream pcd(run_ / "scans" / (std::to_string(scan * 100'000'000) + ".pcd"));
    pcd << "VERSION 0.7\nFIELDS x y z intensity t ring\nSIZE 4 4 4 4 4 2\nTYPE F F F F U U\n"
           "COUNT 1 1 1 1 1 1\nWIDTH "
        << kPoints << "\nHEIGHT 1\nPOINTS " << kPoints << "\nDATA binary\n";
    for (int i = 0; i < kPoints; ++i) {
      const float range = i % 3 == 0 ? 0.4f : i % 3 == 1 ? 5.0f : 140.0f;
      std::string point;
      for (const float v : {range, 0.0f, 0.0f, 1.0f}) append(point, v);
      append(point, static_cast<std::uint32_t>(i * 1'000'000));
      append(point, static_cast<std::uint16_t>(i % 4));
      pcd << point;
    }
  }
  exported();
  const replay::RecordingSource from_folder = replay::open_source((run_ / "scans").string(), ""),
                                from_file = replay::open_source(file_.string(), "");
  EXPECT_EQ(from_file.info.min_range_m, 0.3);
  EXPECT_EQ(from_file.info.max_range_m, 150);
  EXPECT_EQ(from_file.info.lidar_rotation, "0 30.1234567891 0");
  for (int scan = 0; scan < 3; ++scan) {
    replay::ReadNotes notes;
    const auto a = from_folder.sensors->next_sweep(notes), b = from_file.sensors->next_sweep(notes);
    ASSERT_TRUE(a && b);
    ASSERT_EQ(a->points.size(), std::size_t{kPoints});
    ASSERT_EQ(b->points.size(), std::size_t{kPoints});
    for (std::size_t i = 0; i < kPoints; ++i) EXPECT_EQ(a->points[i].position, b->points[i].position);
    EXPECT_TRUE(a->T_body_lidar.orientation.isApprox(b->T_body_lidar.orientation, 0));
  }
  // A recording file goes before it.
  const fs::path info = folder_.path() / "other.info";
  std::ofstream(info) << "lidar { min_range \"1 m\" }\n";
  const replay::RecordingInfo given = replay::open_source(file_.string(), info.string()).info;
  EXPECT_EQ(given.min_range_m, 1);
  EXPECT_EQ(given.max_range_m, 150);
  // What is cut has it too.
  fs::resize_file(file_, fs::file_size(file_) * 9 / 10);
  EXPECT_EQ(replay::open_bag(file_.string())->recorded_settings().at("lidar.min_range"), "0.3 m");
}

TEST(EventWords, TellStateAndReason) {
  core::event::Goal goal;
  goal.state = core::event::GoalState::reached;
  goal.position = {1, 2, 3};
  goal.score = 4.5;
  goal.why = "near";
  goal.reason = "seen";
  const auto words = words_of(goal);
  ASSERT_TRUE(words);
  EXPECT_EQ(words->text, "goal at (1.0 2.0 3.0) reached, score 4.50: near; seen");
  EXPECT_EQ(words->kind, "goal");
  EXPECT_EQ(words->severity, Severity::info);
  EXPECT_EQ(words_of(core::event::Safety{core::SafetyAction::land, "battery"})->severity, Severity::error);
  EXPECT_FALSE(words_of(core::event::Frontiers{}));
}

}  // namespace
}  // namespace karst::mcap
