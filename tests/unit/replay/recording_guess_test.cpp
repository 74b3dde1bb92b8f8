// What karst finds out about the sensors in a bag: the drivers' fields, units and origins of their times,
// mounting.
#include "plugins/replay/recording_guess.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>
#include <tuple>

#include "core_stack/common/error.h"
#include "plugins/replay/bag_sensors.h"
#include "tests/unit/replay/bag/bag_writer.h"

namespace karst::replay {
namespace {

using core::kMillisecond;
using core::kSecond;
using core::TimeNs;
using test::Folder;
using test::PointFieldSpec;
using test::put;
using test::Serializer;

constexpr TimeNs kStart = 1'700'000'000 * kSecond;
constexpr int kPoints = 200, kClouds = 4;

/// A driver's cloud: its fields, and the bytes of point i, measured `after` the scan's stamp.
struct Driver {
  std::vector<PointFieldSpec> fields;
  std::uint32_t step;
  std::function<void(std::string& bytes, int i, TimeNs stamp, TimeNs after)> rest;
};

struct BagContent {
  std::vector<test::WrittenTopic> topics;
  std::vector<test::WrittenMessage> messages;

  std::size_t topic(const std::string& name, const std::string& type) {
    topics.push_back({name, type, known_definition(type, Dialect::ros2)});
    return topics.size() - 1;
  }
  void add_lidar(const std::string& name, const Driver& driver, const std::string& frame) {
    const std::size_t t = topic(name, "sensor_msgs/PointCloud2");
    for (int k = 0; k < kClouds; ++k) {
      const TimeNs stamp = kStart + k * 100 * kMillisecond;
      std::string data;
      for (int i = 0; i < kPoints; ++i) {
        const float angle = 0.03f * static_cast<float>(i);
        for (const float v : {5 * std::cos(angle), 5 * std::sin(angle), 0.1f}) put(data, v);
        driver.rest(data, i, stamp, i * 100 * kMillisecond / kPoints);
      }
      messages.push_back(
          {t, stamp + 105 * kMillisecond,
           test::point_cloud2(Serializer::cdr_little, stamp, frame, driver.fields, driver.step, data)});
    }
  }
  void add_imu(const std::string& name, const std::string& frame, double g) {
    const std::size_t t = topic(name, "sensor_msgs/Imu");
    for (int k = 0; k < 50; ++k) {
      const TimeNs stamp = kStart + k * 10 * kMillisecond;
      messages.push_back(
          {t, stamp, test::imu(Serializer::cdr_little, stamp, frame, {0, 0, g}, {0, 0, 0.25})});
    }
  }
  void add_transform(const std::string& parent, const std::string& child, const core::Pose& T) {
    const std::size_t t = topic("/tf_static", "tf2_msgs/TFMessage");
    Serializer s(Serializer::cdr_little);
    s.number(std::uint32_t{1}).header(kStart, parent).text(child);
    for (const double v : {T.position.x(), T.position.y(), T.position.z(), T.orientation.x(),
                           T.orientation.y(), T.orientation.z(), T.orientation.w()})
      s.number(v);
    messages.push_back({t, kStart, s.bytes()});
  }
  std::string write(const Folder& dir) {
    std::stable_sort(messages.begin(), messages.end(),
                     [](const auto& a, const auto& b) { return a.time < b.time; });
    return dir.write("a.mcap", test::mcap_file(topics, messages, {Compression::zstd, true, 10}));
  }
};

const Driver kOuster = {
    {{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}, {"t", 12, 6}, {"reflectivity", 16, 4}, {"ring", 18, 2}},
    19,
    [](std::string& b, int i, TimeNs, TimeNs after) {
      put(b, static_cast<std::uint32_t>(after));
      put(b, std::uint16_t{500});
      put(b, static_cast<std::uint8_t>(i % 8));
    }};
const Driver kVelodyne = {
    {{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}, {"intensity", 12, 7}, {"ring", 16, 4}, {"time", 18, 7}},
    22,
    [](std::string& b, int i, TimeNs, TimeNs after) {
      put(b, 3.0f);
      put(b, static_cast<std::uint16_t>(i % 8));
      put(b, static_cast<float>(core::seconds(after)));
    }};
const Driver kHesai = {
    {{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}, {"intensity", 12, 7}, {"timestamp", 16, 8}, {"ring", 24, 4}},
    26,
    [](std::string& b, int i, TimeNs stamp, TimeNs after) {
      put(b, 3.0f);
      put(b, core::seconds(stamp + after));
      put(b, static_cast<std::uint16_t>(i % 8));
    }};
const Driver kLivox = {{{"x", 0, 7},
                        {"y", 4, 7},
                        {"z", 8, 7},
                        {"intensity", 12, 7},
                        {"tag", 16, 2},
                        {"line", 17, 2},
                        {"timestamp", 18, 8}},
                       26,
                       [](std::string& b, int i, TimeNs stamp, TimeNs after) {
                         put(b, 3.0f);
                         put(b, std::uint8_t{0});
                         put(b, static_cast<std::uint8_t>(i % 4));
                         put(b, static_cast<double>(stamp + after));
                       }};

/// Whatever the driver: the sweep ends with its last point, 99.5 ms after the stamp.
void expect_sweep(const std::string& path, double tolerance_s) {
  BagSensors sensors(open_bag_recording(path, ""));
  ReadNotes notes;
  const auto sweep = sensors.next_sweep(notes);
  ASSERT_TRUE(sweep);
  EXPECT_NEAR(core::seconds(sweep->stamp - kStart), 0.0995, tolerance_s);
  double first = 0;
  for (const core::SweepPoint& p : sweep->points) first = std::min(first, static_cast<double>(p.time_s));
  EXPECT_NEAR(first, -0.0995, tolerance_s);
  EXPECT_EQ(sweep->points.size(), static_cast<std::size_t>(kPoints));
  EXPECT_LT(sensors.begin(), sweep->stamp);
}

TEST(RecordingGuess, KnowsTheDriversByTheirFieldsAndReadsTheirTimes) {
  for (const auto& [name, driver, rings, origin, unit] :
       {std::tuple{"Ouster", &kOuster, RingSource::field, TimeOrigin::start, "ns"},
        {"Velodyne", &kVelodyne, RingSource::field, TimeOrigin::start, "s"},
        {"Hesai or RoboSense", &kHesai, RingSource::field, TimeOrigin::absolute, "s"},
        {"Livox", &kLivox, RingSource::none, TimeOrigin::absolute, "ns"}}) {
    SCOPED_TRACE(name);
    Folder dir;
    BagContent bag;
    bag.add_lidar("/points", *driver, "lidar");
    const std::string path = bag.write(dir);
    const RecordingGuess guess = guess_recording(survey_bag(path, SurveyExtent::beginning));
    EXPECT_TRUE(guess.doubts.empty()) << guess.doubts.front();
    EXPECT_EQ(guess.lidar, name);
    EXPECT_EQ(guess.info.rings_by, rings);
    EXPECT_EQ(guess.info.time_of, origin);
    EXPECT_EQ(guess.info.time_unit, unit);
    EXPECT_NEAR(guess.info.period_s, 0.1, 1e-9);
    expect_sweep(path, 2e-6);
  }
}

TEST(RecordingGuess, LivoxMessagesOfItsOwnTypeAreRead) {
  Folder dir;
  BagContent bag;
  const std::size_t t = bag.topic("/livox/lidar", "livox_ros_driver2/CustomMsg");
  for (int k = 0; k < kClouds; ++k) {
    const TimeNs stamp = kStart + k * 100 * kMillisecond;
    Serializer s(Serializer::cdr_little);
    s.header(stamp, "livox_frame").number(static_cast<std::uint64_t>(stamp)).number(std::uint32_t{kPoints});
    for (int i = 0; i < 4; ++i) s.number(std::uint8_t{0});
    s.number(std::uint32_t{kPoints});
    for (int i = 0; i < kPoints; ++i)
      s.number(static_cast<std::uint32_t>(i * 100 * kMillisecond / kPoints))
          .number(5.0f)
          .number(0.01f * static_cast<float>(i))
          .number(1.0f)
          .number(std::uint8_t{40})
          .number(std::uint8_t{0})
          .number(static_cast<std::uint8_t>(i % 4));
    bag.messages.push_back({t, stamp + 105 * kMillisecond, s.bytes()});
  }
  bag.add_imu("/livox/imu", "livox_frame", 1.0);
  const std::string path = bag.write(dir);
  const RecordingGuess guess = guess_recording(survey_bag(path, SurveyExtent::all));
  EXPECT_EQ(guess.lidar, "Livox");
  EXPECT_EQ(guess.info.imu_topic, "/livox/imu");
  EXPECT_EQ(guess.info.imu_force_unit, ForceUnit::g) << "a mean of 1 is no weight in m/s^2";
  expect_sweep(path, 1e-6);
  BagSensors sensors(open_bag_recording(path, ""));
  const auto sample = sensors.next_imu();
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->specific_force_mps2.z(), 9.80665, 1e-9);
}

TEST(RecordingGuess, StaticTransformsSayHowTheSensorsAreMounted) {
  Folder dir;
  BagContent bag;
  bag.add_lidar("/points", kVelodyne, "velodyne");
  bag.add_imu("/imu/data", "imu_link", 9.81);
  const core::Quat down(Eigen::AngleAxisd(std::numbers::pi, core::Vec3::UnitX()));
  const core::Quat turned(Eigen::AngleAxisd(0.3, core::Vec3(1, 2, 3).normalized()));
  bag.add_transform("base_link", "mast", {core::Vec3(0, 0, 0.2), core::Quat::Identity()});
  bag.add_transform("mast", "velodyne", {core::Vec3(0.1, 0, 0.3), turned});
  bag.add_transform("imu_link", "base_link", {core::Vec3(0, 0, 0), down});
  const std::string path = bag.write(dir);
  const BagRecording r = open_bag_recording(path, "");
  EXPECT_EQ(r.info.imu_topic, "/imu/data");
  EXPECT_LT((r.layout.T_body_lidar.position - core::Vec3(0.1, 0, 0.5)).norm(), 1e-8);
  EXPECT_LT(r.layout.T_body_lidar.orientation.angularDistance(turned), 1e-8);
  EXPECT_LT(r.layout.R_body_imu.angularDistance(down.conjugate()), 1e-8);
}

TEST(RecordingGuess, AnImuWhoseMountingIsUnknownIsNotUsedUnlessItIsNamed) {
  Folder dir;
  BagContent bag;
  bag.add_lidar("/points", kVelodyne, "velodyne");
  bag.add_imu("/imu/data", "imu_link", 9.81);
  const std::string path = bag.write(dir);
  const BagRecording without = open_bag_recording(path, "");
  EXPECT_EQ(without.info.imu_topic, "none");
  EXPECT_NE(without.assumptions.back().find("is not used"), std::string::npos);
  dir.write("a.info", "bag { imu /imu/data }\nimu { rotation \"0 0 90\" }\n");
  const BagRecording with = open_bag_recording(path, "");
  EXPECT_EQ(with.info_file, (dir.path() / "a.info").string()) << "the file beside the bag";
  EXPECT_EQ(with.info.imu_topic, "/imu/data");
  EXPECT_LT((with.layout.R_body_imu * core::Vec3(1, 0, 0) - core::Vec3(0, 1, 0)).norm(), 1e-12);
}

TEST(RecordingGuess, AKeyOfTheMountingLeavesTheOthersToTheTransforms) {
  Folder dir;
  BagContent bag;
  bag.add_lidar("/points", kVelodyne, "velodyne");
  bag.add_imu("/imu/data", "imu_link", -9.81);
  const core::Quat down(Eigen::AngleAxisd(std::numbers::pi, core::Vec3::UnitX()));
  bag.add_transform("base_link", "velodyne", {core::Vec3(0.1, 0, 0.3), core::Quat::Identity()});
  bag.add_transform("base_link", "imu_link", {core::Vec3(0, 0, 0), down});
  const std::string path = bag.write(dir);
  dir.write("a.info", "lidar { position \"0 0 0.1\" }\n");
  const BagRecording r = open_bag_recording(path, "");
  EXPECT_EQ(r.info.imu_topic, "/imu/data");
  EXPECT_LT((r.layout.T_body_lidar.position - core::Vec3(0, 0, 0.1)).norm(), 1e-12);
  EXPECT_LT(r.layout.R_body_imu.angularDistance(down), 1e-8);
  dir.write("a.info", "lidar { position \"0 0 0\" }\n");
  EXPECT_EQ(open_bag_recording(path, "").info.lidar_position, "0 0 0") << "the default, but said";
}

TEST(RecordingGuess, ALaterTransformOfAFrameReplacesTheEarlierOne) {
  Folder dir;
  BagContent bag;
  bag.add_lidar("/points", kVelodyne, "velodyne");
  bag.add_transform("base_link", "velodyne", {core::Vec3(0, 0, 1), core::Quat::Identity()});
  bag.add_transform("base_link", "velodyne", {core::Vec3(0, 0, 2), core::Quat::Identity()});
  EXPECT_EQ(open_bag_recording(bag.write(dir), "").info.lidar_position, "0 0 2");
}

std::string joined(const std::vector<std::string>& sentences) {
  std::string all;
  for (const std::string& s : sentences) all += s + "\n";
  return all;
}

TEST(RecordingGuess, AnImuThatIsUsedIsNotCalledUnused) {
  Folder dir;
  BagContent bag;
  bag.add_lidar("/points", kVelodyne, "velodyne");
  bag.add_imu("/imu/data", "imu_link", 9.81);
  bag.add_transform("base_link", "camera", {});
  const std::string path = bag.write(dir);
  dir.write("a.info", "bag { imu /imu/data }\nimu { rotation \"0 0 0\" }\n");
  const BagRecording r = open_bag_recording(path, "");
  EXPECT_EQ(r.info.imu_topic, "/imu/data");
  EXPECT_EQ(joined(r.assumptions).find("is not used"), std::string::npos) << joined(r.assumptions);
  EXPECT_NE(joined(r.assumptions).find("/imu/data is used"), std::string::npos) << joined(r.assumptions);
}

TEST(RecordingGuess, TheDoubtAboutTimeOfIsAnsweredByTheRecordingFile) {
  Folder dir;
  BagContent bag;
  bag.add_lidar("/points", kHesai, "lidar");
  for (auto& m : bag.messages) std::memset(m.bytes.data() + 4, 0, 8);  // a driver that stamps nothing
  const std::string path = bag.write(dir);
  EXPECT_THROW(open_bag_recording(path, ""), core::InputError);
  dir.write("a.info", "time {\n  of absolute\n  unit s\n}\n");
  BagSensors sensors(open_bag_recording(path, ""));
  EXPECT_NEAR(core::seconds(sensors.begin() - kStart), 0, 0.15) << "the points' time, not the stamps'";
  int sweeps = 0;
  for (ReadNotes notes; sensors.next_sweep(notes);) ++sweeps;
  EXPECT_EQ(sweeps, kClouds);
}

std::string error_of(const std::string& path) {
  try {
    open_bag_recording(path, "");
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "opened";
}

TEST(RecordingGuess, WhatIsAmbiguousIsAnErrorThatNamesTheKey) {
  {
    Folder dir;
    BagContent bag;
    bag.add_lidar("/front", kVelodyne, "front");
    bag.add_lidar("/rear", kVelodyne, "rear");
    const std::string path = bag.write(dir);
    EXPECT_NE(error_of(path).find("Choose one with bag.lidar"), std::string::npos) << error_of(path);
    dir.write("a.info", "bag { lidar /rear }\n");
    EXPECT_EQ(open_bag_recording(path, "").info.lidar_topic, "/rear");
  }
  {
    Folder dir;
    BagContent bag;
    bag.add_imu("/imu", "imu", 9.81);
    EXPECT_NE(error_of(bag.write(dir)).find("No topic has scans"), std::string::npos);
  }
  {
    Folder dir;
    BagContent bag;
    Driver odd = kVelodyne;
    odd.rest = [](std::string& b, int i, TimeNs, TimeNs) {
      put(b, 3.0f);
      put(b, std::uint16_t{0});
      put(b, 1e-5f * static_cast<float>(i));
    };
    bag.add_lidar("/points", odd, "lidar");
    EXPECT_NE(error_of(bag.write(dir)).find("time.unit"), std::string::npos);
  }
}

TEST(RecordingGuess, AMapBesideTheLidarIsNoLidar) {
  Folder dir;
  BagContent bag;
  const Driver map = {{{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}}, 12, [](std::string&, int, TimeNs, TimeNs) {}};
  bag.add_lidar("/map", map, "map");
  bag.add_lidar("/points", kOuster, "lidar");
  EXPECT_EQ(open_bag_recording(bag.write(dir), "").info.lidar_topic, "/points");
}

TEST(RecordingGuess, ItsTextIsARecordingFileThatSaysTheSame) {
  Folder dir;
  BagContent bag;
  bag.add_lidar("/points", kHesai, "lidar");
  const std::string path = bag.write(dir);
  const RecordingGuess guess = guess_recording(survey_bag(path, SurveyExtent::all));
  const RecordingInfo read = read_recording_info(dir.write("b.info", recording_info_text(guess)));
  EXPECT_EQ(read.lidar_topic, "/points");
  EXPECT_EQ(read.time_of, TimeOrigin::absolute);
  EXPECT_EQ(read.time_unit, "s");
  EXPECT_EQ(read.rings_by, RingSource::field);
}

TEST(RecordingGuess, NamesOfTopicsDoNotBreakItsText) {
  for (const char* name : {"/p\"q\\", "/p\x1b[31m\"\ncompensated true"}) {
    Folder dir;
    BagContent bag;
    bag.add_lidar(name, kOuster, "lidar");
    const RecordingGuess guess = guess_recording(survey_bag(bag.write(dir), SurveyExtent::all));
    const std::string text = recording_info_text(guess);
    const RecordingInfo read = read_recording_info(dir.write("b.info", text));
    EXPECT_FALSE(read.compensated) << text;
    EXPECT_EQ(read.time_unit, "ns");
    EXPECT_EQ(text.find('\x1b'), std::string::npos);
    const bool writable = std::string_view(name).find('\n') == std::string_view::npos;
    EXPECT_EQ(read.lidar_topic, writable ? name : "auto") << text;
  }
}

/// The bag with a metadata record of karst after its header.
std::string with_settings(std::string mcap,
                          const std::vector<std::pair<std::string, std::string>>& settings) {
  std::string pairs;
  for (const auto& [key, value] : settings) pairs += test::mcap::text(key) + test::mcap::text(value);
  const std::size_t header = 8 + 9 + static_cast<unsigned char>(mcap[9]);
  return mcap.insert(header,
                     test::mcap::record(0x0C, test::mcap::text("karst.recording") + test::mcap::text(pairs)));
}

TEST(BagSensors, TakesWhatTheBagItselfSaysBeforeWhatIsGuessedAndAfterAFile) {
  Folder dir;
  BagContent bag;
  bag.add_lidar("/points", kOuster, "lidar");
  bag.add_transform("base_link", "lidar", {{0, 0, 0.5}, core::Quat::Identity()});
  bag.write(dir);
  const std::string mcap = test::mcap_file(bag.topics, bag.messages, {Compression::zstd, false, 10});
  const std::string path = dir.write(
      "s.mcap",
      with_settings(mcap, {{"lidar.min_range", "0.2 m"}, {"lidar.position", "0 0 0.123456789012"}}));
  const BagRecording r = open_bag_recording(path, "");
  EXPECT_EQ(r.info.min_range_m, 0.2);
  EXPECT_EQ(r.info.lidar_position, "0 0 0.123456789012");
  EXPECT_NE(r.assumptions.front().find("karst.recording gives lidar.min_range 0.2 m, "), std::string::npos)
      << r.assumptions.front();
  const RecordingGuess guess = guess_recording(survey_bag(path, SurveyExtent::all));
  EXPECT_EQ(read_recording_info(dir.write("t.info", recording_info_text(guess))).min_range_m, 0.2);
  dir.write("s.info", "lidar { min_range \"1 m\" }\n");
  EXPECT_EQ(open_bag_recording(path, "").info.min_range_m, 1);
}

TEST(BagSensors, SettingsOfABagThatAreWrongAreAnErrorUnlessAFileSetsTheirKeys) {
  Folder dir;
  BagContent bag;
  bag.add_lidar("/points", kOuster, "lidar");
  bag.write(dir);
  const std::string mcap = test::mcap_file(bag.topics, bag.messages, {Compression::zstd, false, 10});
  for (const auto& [key, value, reason] : std::vector<std::array<std::string, 3>>{
           {"lidar.min_range", "near", "karst.recording: lidar.min_range"},
           {"lidar.reach", "9 m", "karst.recording: lidar.reach"},
           {"rings.by", "elevation", "rings.count"},
           {"lidar.position", "0 0", "three numbers"}}) {
    const std::string path = dir.write("w.mcap", with_settings(mcap, {{key, value}}));
    EXPECT_NE(error_of(path).find("w.mcap: "), std::string::npos) << error_of(path);
    EXPECT_NE(error_of(path).find(reason), std::string::npos) << error_of(path);
  }
  const std::string path = dir.write("w.mcap", with_settings(mcap, {{"lidar.min_range", "near"}}));
  dir.write("w.info", "lidar { min_range \"1 m\" }\n");
  EXPECT_EQ(open_bag_recording(path, "").info.min_range_m, 1);
}

TEST(BagSensors, TheErrorInAnInfoThatStandsBesideABagSaysWhyItWasRead) {
  Folder dir;
  BagContent bag;
  bag.add_lidar("/points", kVelodyne, "lidar");
  const std::string path = bag.write(dir), mission = dir.write("a.info", "mission { max_flight_time 90s }\n");
  EXPECT_NE(error_of(path).find("(read because it stands beside the bag; --info names another)"),
            std::string::npos)
      << error_of(path);
  try {
    open_bag_recording(path, mission);
    ADD_FAILURE();
  } catch (const core::InputError& e) {
    EXPECT_EQ(std::string(e.what()).find("stands beside"), std::string::npos) << "it was named";
  }
}

TEST(BagSurvey, TellsRatesAndTheLongestGap) {
  Folder dir;
  BagContent bag;
  bag.add_imu("/imu", "imu", 9.81);
  std::erase_if(bag.messages, [](const auto& m) {
    return m.time > kStart + 100 * kMillisecond && m.time < kStart + 400 * kMillisecond;
  });
  const BagSurvey survey = survey_bag(bag.write(dir), SurveyExtent::all);
  ASSERT_EQ(survey.topics.size(), 1u);
  EXPECT_EQ(survey.topics[0].messages, 21u);
  EXPECT_EQ(survey.topics[0].longest_gap, 300 * kMillisecond);
  EXPECT_EQ(survey.topics[0].gap_after, kStart + 100 * kMillisecond);
  EXPECT_NEAR(survey.topics[0].rate_hz(), 20 / 0.49, 1e-9);
  EXPECT_NEAR(survey.imus.at(0).mean_force, 9.81, 1e-9);
}

TEST(BagSensors, ScansThatGoBackInTimeOrJumpAreLeftOutAndNamed) {
  Folder dir;
  BagContent bag;
  bag.add_lidar("/points", kVelodyne, "lidar");
  // The third scan is the second once more; a fifth one is stamped a day later than it is recorded.
  bag.messages[2].bytes = bag.messages[1].bytes;
  std::string late = bag.messages[3].bytes;
  const auto stamp = static_cast<std::uint32_t>(kStart / kSecond + 86400);
  std::memcpy(late.data() + 4, &stamp, 4);
  bag.messages.push_back({0, bag.messages[3].time + 100 * kMillisecond, late});
  BagSensors sensors(open_bag_recording(bag.write(dir), ""));
  int sweeps = 0;
  for (ReadNotes notes; sensors.next_sweep(notes);) ++sweeps;
  EXPECT_EQ(sweeps, 3);
  const auto damage = sensors.damage();
  ASSERT_EQ(damage.count, 2u);
  const std::string both = damage.first[0] + damage.first[1];
  EXPECT_NE(both.find("is not after that of the scan before it"), std::string::npos) << both;
  EXPECT_NE(both.find("jumps against the time of recording"), std::string::npos) << both;
  EXPECT_NE(both.find("topic /points, byte "), std::string::npos) << both;
}

TEST(BagSensors, TheTruthIsWrittenForTheEvaluation) {
  Folder dir;
  BagContent bag;
  const std::size_t t = bag.topic("/truth", "geometry_msgs/PoseStamped");
  Serializer s(Serializer::cdr_little);
  s.header(kStart + 5, "map");
  for (const double v : {1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0}) s.number(v);
  bag.messages.push_back({t, kStart, s.bytes()});
  const std::string out = (dir.path() / "truth.tum").string(), path = bag.write(dir);
  EXPECT_EQ(write_truth(path, "/truth", out).poses, 1u);
  std::ifstream in(out);
  std::string line;
  std::getline(in, line);
  EXPECT_TRUE(line.starts_with("1700000000.000000005 1.000000 2.000000 3.000000 0.0")) << line;
  EXPECT_THROW(write_truth(path, "/none", out), core::InputError);
}

void add_pose(BagContent& bag, std::size_t topic, int k, double qw) {
  Serializer s(Serializer::cdr_little);
  s.header(kStart + k, "map");
  for (const double v : {1.0, 2.0, 3.0, 0.0, 0.0, 0.0, qw}) s.number(v);
  bag.messages.push_back({topic, kStart + k, s.bytes()});
}

TEST(BagSensors, ATruthThatIsNotThereOrCannotBeReadIsSaid) {
  Folder dir;
  BagContent bag;
  bag.add_lidar("/points", kVelodyne, "lidar");
  const std::size_t t = bag.topic("/odom", "geometry_msgs/PoseStamped");
  for (int k = 0; k < 3; ++k) add_pose(bag, t, k, 0);  // no rotation
  const std::string path = bag.write(dir), out = (dir.path() / "truth.tum").string();
  dir.write("a.info", "bag { truth /points }\n");
  EXPECT_NE(error_of(path).find("topic /points: has no nav_msgs/Odometry"), std::string::npos)
      << "before anything is written: " << error_of(path);
  try {
    write_truth(path, "/odom", out);
    ADD_FAILURE();
  } catch (const core::InputError& e) {
    EXPECT_NE(std::string(e.what()).find("none of its 3 messages is a pose"), std::string::npos) << e.what();
  }
  add_pose(bag, t, 3, 1);
  const WrittenTruth written = write_truth(bag.write(dir), "/odom", out);
  EXPECT_EQ(written.poses, 1u);
  EXPECT_EQ(written.damaged, 3u);
}

/// Scans as of kVelodyne, recorded every 0.1 s, and stamped as `stamp_of(k)` says.
void add_scans(BagContent& bag, int count, const std::function<TimeNs(int k)>& stamp_of,
               const Driver& driver = kVelodyne) {
  const std::size_t t = bag.topic("/points", "sensor_msgs/PointCloud2");
  for (int k = 0; k < count; ++k) {
    std::string data;
    for (int i = 0; i < kPoints; ++i) {
      const float angle = 0.03f * static_cast<float>(i);
      for (const float v : {5 * std::cos(angle), 5 * std::sin(angle), 0.1f}) put(data, v);
      driver.rest(data, i, stamp_of(k), i * 100 * kMillisecond / kPoints);
    }
    bag.messages.push_back(
        {t, kStart + k * 100 * kMillisecond,
         test::point_cloud2(Serializer::cdr_little, stamp_of(k), "lidar", driver.fields, driver.step, data)});
  }
}
struct Sweeps {
  std::vector<TimeNs> stamps;
  SensorStream::Damage damage;
};
Sweeps sweeps_of(BagSensors& sensors) {
  Sweeps all;
  for (ReadNotes notes; const auto sweep = sensors.next_sweep(notes);) all.stamps.push_back(sweep->stamp);
  all.damage = sensors.damage();
  return all;
}

TEST(BagSensors, AClockThatIsSetBackIsOneFaultAndTimeGoesOn) {
  for (const Driver* driver : {&kVelodyne, &kHesai}) {  // times from the stamp, and absolute ones
    Folder dir;
    BagContent bag;
    const auto stamp_of = [](int k) { return kStart + k * 100 * kMillisecond - (k < 20 ? 0 : 37 * kSecond); };
    add_scans(bag, 80, stamp_of, *driver);
    const std::size_t t = bag.topic("/imu", "sensor_msgs/Imu");
    for (int k = 0; k < 800; ++k) {
      const TimeNs recorded = kStart + k * 10 * kMillisecond;
      const TimeNs stamp = recorded - (k < 200 ? 0 : 37 * kSecond);
      bag.messages.push_back({t, recorded + 3 * kMillisecond * (k % 2),
                              test::imu(Serializer::cdr_little, stamp, "lidar", {0, 0, 9.81}, {0, 0, 0})});
    }
    BagSensors sensors(open_bag_recording(bag.write(dir), ""));
    std::vector<TimeNs> imu;
    Sweeps sweeps;
    for (ReadNotes notes; const auto sweep = sensors.next_sweep(notes);) {
      sweeps.stamps.push_back(sweep->stamp);
      while (const auto sample = sensors.next_imu()) {
        imu.push_back(sample->stamp);
        if (sample->stamp > sweep->stamp) break;
      }
    }
    ASSERT_EQ(sweeps.stamps.size(), 80u);
    for (std::size_t k = 0; k < 80; ++k)
      EXPECT_NEAR(core::seconds(sweeps.stamps[k] - kStart), 0.1 * static_cast<double>(k) + 0.0995, 0.0051)
          << k;
    EXPECT_TRUE(std::is_sorted(imu.begin(), imu.end()));
    const auto damage = sensors.damage();
    ASSERT_EQ(damage.count, 2u) << joined(damage.first);  // one of each topic
    for (const std::string& d : damage.first)
      EXPECT_NE(d.find("the clock was set back by 37.0 s"), std::string::npos) << d;
  }
}

TEST(BagSensors, AWrongFirstStampCostsOneScan) {
  Folder dir;
  BagContent bag;
  add_scans(bag, 12, [](int k) { return kStart + k * 100 * kMillisecond + (k == 0 ? 30 * kSecond : 0); });
  BagSensors sensors(open_bag_recording(bag.write(dir), ""));
  const Sweeps all = sweeps_of(sensors);
  EXPECT_EQ(all.stamps.size(), 11u);
  EXPECT_EQ(all.damage.count, 1u) << joined(all.damage.first);
}

TEST(BagSensors, AScanWithoutReturnsIsNoDamage) {
  Folder dir;
  BagContent bag;
  add_scans(bag, 12, [](int k) { return kStart + k * 100 * kMillisecond; });
  for (const int k : {0, 5}) {
    const TimeNs stamp = kStart + k * 100 * kMillisecond;
    bag.messages[static_cast<std::size_t>(k)].bytes =
        test::point_cloud2(Serializer::cdr_little, stamp, "lidar", kVelodyne.fields, kVelodyne.step,
                           std::string(kVelodyne.step * 100, '\0'));
  }
  BagSensors sensors(open_bag_recording(bag.write(dir), ""));
  const Sweeps all = sweeps_of(sensors);
  EXPECT_EQ(all.stamps.size(), 10u);
  EXPECT_EQ(all.damage.count, 0u) << joined(all.damage.first);
  EXPECT_EQ(sensors.scans_without_returns(), 2u);
}

}  // namespace
}  // namespace karst::replay
