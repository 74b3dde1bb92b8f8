// A record that is followed gives the messages that an export of the finished run has, byte for byte.
#include "sdk/live/flight_messages.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <map>

#include "sdk/evaluation/record/run_record.h"
#include "sdk/mcap_export/flight_topics.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::live {
namespace {

namespace fs = std::filesystem;
using core::RecordPart;

struct Record {
  double t_s = 0;
  RecordPart part = RecordPart::events;
  std::string bytes;
};

/// The lines of a file, without the columns' names.
void add_lines(const fs::path& file, RecordPart part,
               const std::function<double(const std::string&)>& time_of, std::vector<Record>& out) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (!line.starts_with("t_s") && !line.starts_with("stamp") && !line.starts_with('#'))
      out.push_back({time_of(line), part, line + "\n"});
}

/// As the recorder wrote it: in the order of time.
std::vector<Record> record_of(const fs::path& run) {
  std::vector<Record> all;
  const auto first = [](const std::string& line) { return std::stod(line); };
  add_lines(
      run / "events.jsonl", RecordPart::events,
      [](const std::string& line) { return std::stod(line.substr(line.find("\"t\":") + 4)); }, all);
  add_lines(run / "trajectory.tum", RecordPart::trajectory, first, all);
  add_lines(run / "telemetry.csv", RecordPart::telemetry, first, all);
  add_lines(
      run / "localization.csv", RecordPart::localization,
      [](const std::string& line) { return std::stod(line.substr(line.find(',') + 1)); }, all);
  std::ifstream in(run / "map_growth.bin", std::ios::binary);
  for (std::string bytes(16, '\0'); in.read(bytes.data(), 16);) {
    std::int32_t ms = 0;
    std::memcpy(&ms, bytes.data() + 12, 4);
    all.push_back({std::abs(ms) / 1000.0, RecordPart::map_growth, bytes});
  }
  std::stable_sort(all.begin(), all.end(), [](const Record& a, const Record& b) { return a.t_s < b.t_s; });
  return all;
}

using Messages = std::map<std::string, std::vector<std::pair<std::uint64_t, std::string>>>;

Messages followed(const fs::path& run) {
  Messages out;
  FlightMessages messages(0.2, [&](const LiveMessage& m) {
    out[flight_topics()[m.topic].name].emplace_back(m.time_ns, *m.bytes);
  });
  for (const Record& r : record_of(run)) messages.take(r.part, r.bytes);
  messages.end();
  return out;
}

Messages exported(const evaluation::RunRecord& run) {
  const mcap::FlightClock clock;
  std::vector<std::string> problems;
  std::vector<mcap::Topic> topics = mcap::pose_topics(run, clock);
  for (auto& more : {mcap::map_topics(run, clock, problems), mcap::event_topics(run, clock)})
    topics.insert(topics.end(), more.begin(), more.end());
  topics.push_back(mcap::battery_topic(run, clock));
  Messages out;
  const std::string truth = "base_link_truth";
  for (mcap::Topic& topic : topics)
    while (auto m = topic.next())
      if (m->message.find(truth) == std::string::npos) out[topic.name].emplace_back(m->time_ns, m->message);
  return out;
}

class Followed : public testing::Test {
 protected:
  explicit Followed(double length_m = 15) { test::write_fake_run(run_, {.length_m = length_m}); }
  const test::TemporaryDirectory folder_;
  const fs::path run_ = folder_.path() / "run";
};

TEST_F(Followed, AFlightGivesTheMessagesOfItsExport) {
  const Messages live = followed(run_), exports = exported(evaluation::read_run(run_));
  for (const char* topic : {"/tf", "/odometry", "/map/new", "/battery", "/plan", "/frontiers", "/goals",
                            "/drawings", "/phase", "/events"}) {
    ASSERT_TRUE(exports.contains(topic)) << topic;
    ASSERT_TRUE(live.contains(topic)) << topic;
    ASSERT_EQ(live.at(topic).size(), exports.at(topic).size()) << topic;
    for (std::size_t i = 0; i < live.at(topic).size(); ++i)
      ASSERT_TRUE(live.at(topic)[i] == exports.at(topic)[i]) << topic << " " << i;
  }
}

TEST_F(Followed, WhatGrowsIsToldWholeAsAnExportTellsItAtThatTime) {
  const evaluation::RunRecord run = evaluation::read_run(run_);
  const Messages live = followed(run_), exports = exported(run);
  int same = 0;
  for (const char* topic : {"/path", "/map"})
    for (const auto& message : exports.at(topic))
      for (const auto& mine : live.at(topic))
        if (mine.first == message.first) {
          EXPECT_TRUE(mine.second == message.second) << topic << " " << mine.first;
          ++same;
        }
  EXPECT_GT(same, 20);
  EXPECT_TRUE(live.at("/path").back() == exports.at("/path").back());
}

TEST_F(Followed, TheMessagesOfATopicNeverGoBackInTime) {
  for (const auto& [topic, messages] : followed(run_))
    EXPECT_TRUE(std::is_sorted(messages.begin(), messages.end(), [](const auto& a, const auto& b) {
      return a.first < b.first;
    })) << topic;
}

TEST_F(Followed, WhatNoRecorderWritesIsRefusedAndLeavesTheRest) {
  std::size_t told = 0;
  FlightMessages messages(0.2, [&](const LiveMessage&) { ++told; });
  for (const auto& [part, bytes] :
       std::vector<std::pair<RecordPart, std::string>>{{RecordPart::events, "{\n"},
                                                       {RecordPart::events, "{\"kind\":\"phase\"}\n"},
                                                       {RecordPart::trajectory, "1 2 3\n"},
                                                       {RecordPart::telemetry, "x,explore\n"},
                                                       {RecordPart::localization, "1,y\n"},
                                                       {RecordPart::map_growth, "short"}})
    EXPECT_THROW(messages.take(part, bytes), std::runtime_error) << bytes;
  EXPECT_EQ(told, 0u);
  messages.take(RecordPart::trajectory, "1 0 0 0 0 0 0 1\n");
  EXPECT_EQ(told, 1u);
}

TEST(SnapshotTimes, AllOfThemTogetherStayWithinFortyTimesTheLast) {
  for (const double flight_s : {10.0, 100.0, 3600.0, 86400.0}) {
    SnapshotTimes times;
    double sum_s = 0;  // of what grows with the time
    while (times.due_s() < flight_s) {
      sum_s += times.due_s();
      times.told();
    }
    EXPECT_LE(sum_s, 42 * flight_s) << flight_s;
  }
}

}  // namespace
}  // namespace karst::live
