// Recorded requests: what was asked, told and answered comes back; damage is found.
#include "sdk/host/serialization/request_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core_stack/common/error.h"
#include "core_stack/planning/passages/passages.h"
#include "sdk/host/services/path_question.h"
#include "tests/abi/room.h"

namespace karst::host {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// Answers with what the services say, so that a replay shows whether they say the same.
class Curious final : public core::PolicyPort {
 public:
  std::string name() const override { return "curious"; }
  core::Decision decide(const core::DecisionRequest& r) override {
    if (r.sequence == 4) throw core::PolicyFailure("the fourth is too much");
    core::Decision d;
    d.outcome = core::Outcome::goals;
    core::Goal g;
    g.position = r.frontiers.at(0).viewpoint;
    g.heading_rad = std::nan("");
    g.score = r.roadmap->distances(*r.map, r.state.position, std::vector<core::Vec3>{g.position}, 0.5)[0];
    g.why = std::to_string(r.map->free_cells()) + " \"free\"";
    const std::vector<core::Vec3> goals = {g.position, {1.5, 1.5, 1.5}};
    const PathsAnswer found = find_paths(*r.map, *r.roadmap, r.state.position, goals, 0.5);
    for (const FoundPath& path : found.paths) {
      double sum = path.clearance_m;  // differs if any point does
      for (std::size_t k = 0; k < path.points.size(); ++k)
        sum += path.points[k].dot(core::Vec3(1, 10, 100)) * (1.0 + static_cast<double>(k));
      g.why += ", " + std::to_string(sum);
    }
    core::WorkBudget work(core::kMaxPassageWork);
    const core::PassageMap passages = core::find_passages(*r.map, r.T_world_start.position, work).value();
    for (const core::Passage& p : passages.passages)
      g.why += ", " + std::to_string(p.length_m) + " m " + std::to_string(p.middle.sum());
    g.why += ", " + std::to_string(r.battery_seconds_left) + " s";
    d.goals = {g};
    return d;
  }
  void notify(const core::PolicyEvent& e) override { heard.push_back(e.reason); }
  std::vector<std::string> heard;
};

struct Recorded : ::testing::Test {
  fs::path file = fs::temp_directory_path() / ("karst-requests-" + std::to_string(getpid()) + ".bin");
  test::Room room;
  Curious policy;
  std::vector<std::string> answers;

  void SetUp() override {
    RequestLogHeader header{"curious", "1.2.3", 77, {}};
    header.parameters.put("reach", "3 m");
    RecordingPolicy recording(policy, file, header);
    for (std::uint32_t i = 1; i <= 3; ++i) {
      room.request.sequence = i;
      room.request.state.position.x() = 1.5 + i;
      room.map.declare_free({12.5, 4.5, 4.5}, 0.4 * i);  // the map changes between requests
      answers.push_back(answer_text(recording.decide(room.request)));
      core::PolicyEvent event{core::PolicyEvent::Kind::goal_unreachable, 5, {}, "event " + std::to_string(i)};
      event.goal.heading_rad = 0.1;
      recording.notify(event);
    }
    room.request.sequence = 4;
    EXPECT_THROW(recording.decide(room.request), core::PolicyFailure);
  }
  void TearDown() override { fs::remove(file); }

  std::string bytes() const {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void rewrite(const std::string& text) const { std::ofstream(file, std::ios::binary) << text; }
  /// What reading it to the end says; "" if nothing is wrong.
  std::string fault() const {
    try {
      RequestLogReader log(file);
      while (log.next() != RequestLogReader::Kind::end) continue;
    } catch (const core::InputError& e) {
      return e.what();
    }
    return "";
  }
};

TEST_F(Recorded, ComesBackAsItWas) {
  RequestLogReader log(file);
  EXPECT_EQ(log.header().policy, "curious");
  EXPECT_EQ(log.header().version, "1.2.3");
  EXPECT_EQ(log.header().seed, 77u);
  EXPECT_EQ(log.header().parameters.get<std::string>("reach"), "3 m");
  EXPECT_EQ(policy.heard.size(), 3u);
  for (std::uint32_t i = 1; i <= 3; ++i) {
    ASSERT_EQ(log.next(), RequestLogReader::Kind::request);
    EXPECT_EQ(log.request().sequence, i);
    EXPECT_EQ(answer_text(policy.decide(log.request())), answers[i - 1]) << "paths and map as in flight";
    ASSERT_EQ(log.next(), RequestLogReader::Kind::answer);
    EXPECT_EQ(log.answer(), answers[i - 1]);
    ASSERT_EQ(log.next(), RequestLogReader::Kind::event);
    EXPECT_EQ(log.event().kind, core::PolicyEvent::Kind::goal_unreachable);
    EXPECT_EQ(log.event().reason, "event " + std::to_string(i));
    EXPECT_EQ(log.event().goal.heading_rad, 0.1);
  }
  ASSERT_EQ(log.next(), RequestLogReader::Kind::request);
  ASSERT_EQ(log.next(), RequestLogReader::Kind::answer);
  EXPECT_EQ(answer_line(log.answer()), "failed: the fourth is too much");
  EXPECT_EQ(log.next(), RequestLogReader::Kind::end);
}

TEST_F(Recorded, IsReadWithoutRoadmapsByWhoNeedsNone) {
  RequestLogReader log(file, RequestReader::Keeps::map);
  ASSERT_EQ(log.next(), RequestLogReader::Kind::request);
  EXPECT_EQ(log.request().roadmap, nullptr);
  ASSERT_EQ(log.next(), RequestLogReader::Kind::answer);
  EXPECT_EQ(log.answer(), answers[0]);
}

TEST_F(Recorded, MapGoesAsWhatChanged) {
  const std::string all = bytes();
  EXPECT_LT(all.size(), 2 * flatten(room.request).size()) << "four requests, and the whole map once";
}

TEST_F(Recorded, KilledFlightIsReadUpToItsLastRecord) {
  const std::string all = bytes();
  for (const std::size_t cut : {1ul, 10ul, 60ul, all.size() / 3}) {
    rewrite(all.substr(0, all.size() - cut));
    EXPECT_EQ(fault(), "") << cut << " bytes are missing";
  }
}

TEST_F(Recorded, WhatOfARecordCutShortIsPassedOverIsCounted) {
  const std::string all = bytes();
  const auto skipped_bytes = [&](const std::string& text) {
    rewrite(text);
    RequestLogReader log(file);
    while (log.next() != RequestLogReader::Kind::end) continue;
    return log.skipped_bytes();
  };
  EXPECT_EQ(skipped_bytes(all), 0u);
  EXPECT_EQ(skipped_bytes(all + "half"), 4u);
  const std::size_t last = all.rfind("krql");  // the last answer
  EXPECT_EQ(skipped_bytes(all.substr(0, all.size() - 1)), all.size() - 1 - last);
}

TEST_F(Recorded, AnswerOfAnotherShapeIsShownAsItStands) {
  for (const char* text :
       {"{\"goals\": [{\"position\": 5}]}", "{\"goals\": [7]}", "{\"outcome\": 3}", "{\"goals\": \"far\"}"})
    EXPECT_EQ(answer_line(text), text);
}

TEST_F(Recorded, DamageNamesFileRecordAndReason) {
  const std::string all = bytes();
  for (std::size_t at = 24; at < all.size(); at += 1 + all.size() / 300) {
    std::string bad = all;
    bad[at] = static_cast<char>(bad[at] ^ 0x20);
    rewrite(bad);
    try {  // a length that grew looks like a flight killed: fewer records, but none that is false
      RequestLogReader log(file);
      std::size_t seen = 0;
      for (auto kind = log.next(); kind != RequestLogReader::Kind::end; kind = log.next())
        if (kind == RequestLogReader::Kind::answer && seen < 3) {
          EXPECT_EQ(log.answer(), answers[seen++]);
        }
      EXPECT_LT(seen, 4u);
    } catch (const core::InputError& e) {
      EXPECT_THAT(e.what(), AllOf(HasSubstr(file.string()), HasSubstr("record "))) << "byte " << at;
    }
  }
}

TEST_F(Recorded, WhatIsNoRecordIsRefused) {
  rewrite("");
  EXPECT_THAT(fault(), HasSubstr("begins with whom"));
  rewrite("a run's log, perhaps, but no record of requests");
  EXPECT_THAT(fault(), HasSubstr("no record of requests"));
  fs::remove(file);
  EXPECT_THAT(fault(), HasSubstr("cannot be opened"));
}

TEST_F(Recorded, DiskThatCannotBeWrittenIsAnError) {
  EXPECT_THROW(RecordingPolicy(policy, "/dev/full", {"curious", "1.0.0", 1, {}}), core::InputError);
  EXPECT_THROW(RecordingPolicy(policy, "/no/such/folder/requests.bin", {"curious", "1.0.0", 1, {}}),
               core::InputError);
}

}  // namespace
}  // namespace karst::host
