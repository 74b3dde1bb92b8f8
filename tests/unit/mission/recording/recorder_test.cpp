#include "core_stack/mission/recording/recorder.h"

#include <gtest/gtest.h>

#include <fstream>
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

TEST(Recorder, WritesEventsAsOneJsonObjectALine) {
  const fs::path dir = fresh("recorder_events");
  Recorder recorder(dir);
  recorder.event(1500 * kMillisecond, "phase", {{"phase", "takeoff"}});
  recorder.event(2 * kSecond, "log", {{"text", "bad \xff utf-8"}});
  ASSERT_TRUE(recorder.flush());
  std::ifstream in(dir / "events.jsonl");
  std::string line;
  ASSERT_TRUE(std::getline(in, line));
  EXPECT_EQ(line, R"({"t":1.5,"kind":"phase","phase":"takeoff"})");
  ASSERT_TRUE(std::getline(in, line));
  EXPECT_EQ(nlohmann::json::parse(line)["kind"], "log");
}

TEST(Recorder, WritesFieldsMadeIntoTextElsewhereAsItWouldItself) {
  const fs::path dir = fresh("recorder_texts");
  Recorder recorder(dir);
  const nlohmann::json fields{{"text", "a \"b\""}, {"points", {{1.5, 2, 3}}}, {"alpha", 1}};
  recorder.event(1500 * kMillisecond, "drawing", fields);
  recorder.event_of_text(1500 * kMillisecond, "drawing", fields.dump());
  ASSERT_TRUE(recorder.flush());
  std::ifstream in(dir / "events.jsonl");
  std::string one, other;
  ASSERT_TRUE(std::getline(in, one) && std::getline(in, other));
  EXPECT_EQ(one, other);
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

}  // namespace
}  // namespace karst::core
