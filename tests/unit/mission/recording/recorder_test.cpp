#include "core_stack/mission/recording/recorder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "core_stack/common/error.h"

namespace karst::core {
namespace {

namespace fs = std::filesystem;

fs::path fresh(const std::string& name) {
  const fs::path dir = fs::path(KARST_BINARY_DIR) / "test_runs" / name;
  fs::remove_all(dir);
  return dir;
}

TEST(Recorder, WritesAnEventALine) {
  const fs::path dir = fresh("recorder_events");
  Recorder recorder(dir);
  const event::Event log = event::Log{"away"};
  recorder.write(1500 * kMillisecond, event::Phase{Phase::takeoff, "clear"});
  recorder.write(2 * kSecond, log);
  recorder.write(2 * kSecond, event::Log::kKind, event::fields_text(log));
  ASSERT_TRUE(recorder.flush());
  std::ifstream in(dir / "events.jsonl");
  const std::string lines(std::istreambuf_iterator<char>(in), {});
  EXPECT_EQ(lines, R"({"t":1.5,"kind":"phase","phase":"takeoff","reason":"clear"}
{"t":2.0,"kind":"log","text":"away"}
{"t":2.0,"kind":"log","text":"away"}
)");
}

TEST(Recorder, GrowthHoldsTheComingAndGoingOfOccupiedCellsOnly) {
  const fs::path dir = fresh("recorder_growth");
  Recorder recorder(dir);
  const std::vector<CellChange> changes = {{{1, 2, 3}, Cell::unknown, Cell::occupied},
                                           {{4, 5, 6}, Cell::unknown, Cell::free},
                                           {{-7, 8, -9}, Cell::occupied, Cell::free}};
  recorder.map_changes(250 * kMillisecond, changes);
  ASSERT_TRUE(recorder.flush());
  std::ifstream in(dir / "map_growth.bin", std::ios::binary);
  std::array<std::int32_t, 8> got{};
  ASSERT_TRUE(in.read(reinterpret_cast<char*>(got.data()), sizeof got));
  EXPECT_EQ(got, (std::array<std::int32_t, 8>{1, 2, 3, 250, -7, 8, -9, -250}));
  EXPECT_EQ(in.peek(), EOF);
}

TEST(Recorder, WhatASurveyLacksIsWrittenWhenItChangesAndNoFileIsThereWithoutASurvey) {
  const fs::path dir = fresh("recorder_unsurveyed");
  Recorder recorder(dir);
  EXPECT_FALSE(fs::exists(dir / "unsurveyed.csv"));
  recorder.unsurveyed(100 * kMillisecond, 0);
  recorder.unsurveyed(200 * kMillisecond, 0);
  recorder.unsurveyed(300 * kMillisecond, 1.25);
  recorder.unsurveyed(400 * kMillisecond, 1.25);
  recorder.unsurveyed(12500 * kMillisecond, 0.5);
  ASSERT_TRUE(recorder.flush());
  std::ifstream in(dir / "unsurveyed.csv");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  EXPECT_EQ(text, "t_s,unsurveyed_m3\n0.10,0.000\n0.30,1.250\n12.50,0.500\n");
}

TEST(Recorder, RefusesADirectoryThatHoldsARun) {
  const fs::path dir = fresh("recorder_twice");
  { Recorder first(dir); }
  try {
    Recorder second(dir);
    FAIL() << "a run was overwritten";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("another run"), std::string::npos) << e.what();
  }
}

TEST(Recorder, SaysWhyADirectoryCannotBeMade) {
  try {
    Recorder recorder("/proc/nowhere/run");
    FAIL() << "made a directory in /proc";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("/proc/nowhere/run"), std::string::npos) << e.what();
  }
}

TEST(Recorder, FlushTellsOfAFullDisk) {
  const fs::path dir = fresh("recorder_full");
  fs::create_directories(dir);
  fs::create_symlink("/dev/full", dir / "telemetry.csv");
  Recorder recorder(dir);
  recorder.telemetry({});
  EXPECT_FALSE(recorder.flush());
}

/// Keeps what it is told, and whether the record is complete.
struct Listener : RecordListener {
  void on_record(RecordPart part, std::string_view bytes) override { told[part] += bytes; }
  void on_close() override { ++closed; }
  std::map<RecordPart, std::string> told;
  int closed = 0;
};

TEST(Recorder, AListenerGetsTheVeryBytesOfTheFilesWithoutTheColumns) {
  for (const Durability durability : {Durability::survives_a_crash, Durability::survives_a_power_cut}) {
    const fs::path dir = fresh("recorder_listener");
    Listener listener;
    Recorder recorder(dir, durability);
    recorder.set_listener(&listener);
    for (int i = 1; i < 5; ++i) {
      const TimeNs t = i * kSecond;
      recorder.write(t, event::Phase{Phase::takeoff, "clear"});
      recorder.write(t, event::Log::kKind, event::fields_text(event::Log{"text"}));
      recorder.pose({.stamp = t, .position = Vec3(i, 2, 3)});
      Telemetry row;
      row.stamp = t;
      recorder.telemetry(row);
      Located located;
      located.used_at = t;
      recorder.located(located);
      recorder.map_changes(t, std::vector<CellChange>{{{i, 2, 3}, Cell::unknown, Cell::occupied},
                                                      {{4, i, 6}, Cell::unknown, Cell::free}});
    }
    EXPECT_EQ(listener.closed, 0);
    ASSERT_TRUE(recorder.close());
    EXPECT_EQ(listener.closed, 1);
    const auto bytes_of_file = [&](const char* name) {
      std::ifstream in(dir / name, std::ios::binary);
      return std::string(std::istreambuf_iterator<char>(in), {});
    };
    const auto with = [](std::string_view columns, const std::string& rows) {
      return std::string(columns) + "\n" + rows;
    };
    EXPECT_EQ(bytes_of_file("events.jsonl"), listener.told[RecordPart::events]);
    EXPECT_EQ(bytes_of_file("trajectory.tum"), listener.told[RecordPart::trajectory]);
    EXPECT_EQ(bytes_of_file("telemetry.csv"),
              with(Recorder::kTelemetryColumns, listener.told[RecordPart::telemetry]));
    EXPECT_EQ(bytes_of_file("localization.csv"),
              with(Recorder::kLocalizationColumns, listener.told[RecordPart::localization]));
    EXPECT_EQ(bytes_of_file("map_growth.bin"), listener.told[RecordPart::map_growth]);
    EXPECT_FALSE(listener.told[RecordPart::map_growth].empty());
  }
}

}  // namespace
}  // namespace karst::core
