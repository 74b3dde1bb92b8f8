// Answers as bytes: the same out as in, and nothing out of any bytes that an answer in process could not be.
#include "sdk/host/serialization/flat_answer.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <limits>

namespace karst::test {
namespace {

using host::Bytes;
using host::DecisionReport;

DecisionReport report() {
  DecisionReport r;
  r.decision.outcome = core::Outcome::goals;
  r.decision.goals = {{{1, 2, 3}, std::numeric_limits<double>::quiet_NaN(), 0.5, 0, 7, 2.5, "grün"},
                      {{-1, 0, 0.25}, 1.0, 0.3, 1.5, 0, -1, ""}};
  r.decision.drawings = {{core::Drawing::Kind::lines, {{0, 0, 0}, {1, 1, 1}}, 0x00ff00, ""},
                         {core::Drawing::Kind::text, {{5, 5, 5}}, 0xffffff, "here"}};
  r.decision.log = {"one", "warning: two"};
  r.legacy.numbers_drawn = 12;
  r.legacy.state = Bytes{std::byte{1}, std::byte{2}};
  return r;
}

TEST(FlatAnswer, DecisionComesOutAsItWentIn) {
  const DecisionReport in = report(), out = host::read_decision_report(host::flatten(in));
  ASSERT_EQ(out.decision.goals.size(), 2u);
  EXPECT_EQ(out.decision.goals[0].position, in.decision.goals[0].position);
  EXPECT_TRUE(std::isnan(out.decision.goals[0].heading_rad));
  EXPECT_EQ(out.decision.goals[0].why, "grün");
  EXPECT_EQ(out.decision.goals[1].max_speed_mps, 1.5);
  EXPECT_EQ(out.decision.drawings[0].points, in.decision.drawings[0].points);
  EXPECT_EQ(out.decision.drawings[1].text, "here");
  EXPECT_EQ(out.decision.log, in.decision.log);
  EXPECT_EQ(out.legacy.numbers_drawn, 12u);
  EXPECT_EQ(out.legacy.state, in.legacy.state);
  EXPECT_EQ(host::flatten(out), host::flatten(in));
}

TEST(FlatAnswer, EventComesOutAsItWentIn) {
  const core::PolicyEvent in{core::PolicyEvent::Kind::goal_abandoned, 42, report().decision.goals[1],
                             "stuck"};
  const core::PolicyEvent out = host::read_event(host::flatten(in));
  EXPECT_EQ(out.kind, in.kind);
  EXPECT_EQ(out.stamp, 42);
  EXPECT_EQ(out.goal.score, -1);
  EXPECT_EQ(out.reason, "stuck");
}

TEST(FlatAnswer, EveryCutIsRefused) {
  const Bytes bytes = host::flatten(report());
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_THROW(host::read_decision_report({bytes.data(), n}), host::FlatError) << n;
}

/// Damaged bytes give a FlatError or an answer that keeps the rules.
TEST(FlatAnswer, DamagedBytesNeverGiveABrokenAnswer) {
  const Bytes good = host::flatten(report());
  EXPECT_TRUE(rc::check([&] {
    Bytes bytes = good;
    const int damages = *rc::gen::inRange(1, 6);
    for (int i = 0; i < damages; ++i)
      bytes[*rc::gen::inRange<std::size_t>(0, bytes.size())] =
          static_cast<std::byte>(*rc::gen::inRange(0, 256));
    try {
      const DecisionReport r = host::read_decision_report(bytes);
      RC_ASSERT(r.decision.goals.size() <= 64u);
      for (const core::Goal& g : r.decision.goals) {
        RC_ASSERT(g.position.allFinite());
        RC_ASSERT(g.tolerance_m > 0 && std::isfinite(g.score));
      }
      for (const core::Drawing& d : r.decision.drawings)
        for (const core::Vec3& p : d.points) RC_ASSERT(p.allFinite());
    } catch (const host::FlatError&) {
    }
  }));
}

TEST(FlatAnswer, GoalsWithoutTheOutcomeGoalsAreRefused) {
  DecisionReport r = report();
  r.decision.outcome = core::Outcome::explored;
  EXPECT_THROW(host::read_decision_report(host::flatten(r)), host::FlatError);
}

/// A ready message whose parameters are `info`, which no honest child writes.
Bytes ready_with(const std::string& info) {
  host::FlatWriter out;
  out.put(std::string("1.0.0"));
  out.put(info);
  return out.take();
}

// The host, in flight, opened what a policy's process named: a FIFO, /dev/zero, /etc/shadow.
TEST(FlatAnswer, AReadyMessageOpensNoFileInTheHost) {
  for (const char* file : {"/dev/zero", "/etc/passwd", "/proc/self/environ"}) {
    const Bytes bytes = ready_with("ratio 1\n#include \"" + std::string(file) + "\"\n");
    try {
      host::read_ready_report(bytes);
      ADD_FAILURE() << file;
    } catch (const host::FlatError& e) {
      EXPECT_NE(std::string(e.what()).find("parameters: line 2: #include"), std::string::npos) << e.what();
    }
  }
  EXPECT_EQ(host::read_ready_report(ready_with("ratio 1\n")).parameters.get<int>("ratio"), 1);
}

TEST(FlatAnswer, AReadyMessageOfManyLevelsIsRefused) {
  std::string deep;
  for (int i = 0; i < 16'000; ++i) deep += "a {\n";
  EXPECT_THROW(host::read_ready_report(ready_with(deep)), host::FlatError);
}

TEST(FlatAnswer, PathsBetweenNoPlacesAreRefused) {
  host::LengthsQuestion q{{0, 0, 0}, {{1, 1, 1}}, 0.5};
  EXPECT_EQ(host::read_lengths_question(host::flatten(q)).goals, q.goals);
  q.goals[0].x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(host::read_lengths_question(host::flatten(q)), host::FlatError);
  q.goals.assign(5000, core::Vec3::Zero());
  EXPECT_THROW(host::read_lengths_question(host::flatten(q)), host::FlatError);
}

TEST(FlatAnswer, AnswersAboutPathsComeThroughWhole) {
  using Status = host::PathAnswer::Status;
  for (const Status status : {Status::answered, Status::no_roadmap, Status::too_much}) {
    const host::PathAnswer answer{status, {1.5, std::numeric_limits<double>::infinity()}};
    const host::PathAnswer read = host::read_path_answer(host::flatten(answer));
    EXPECT_EQ(read.status, status);
    EXPECT_EQ(read.lengths_m, answer.lengths_m);
  }
}

TEST(FlatAnswer, PathsComeThroughWhole) {
  const host::PathsAnswer answer{host::PathAnswer::Status::answered,
                                 {{{{0, 0, 0}, {3, 4, 0}}, 5, 0.7}, host::FoundPath{}}};
  const Bytes bytes = host::flatten(answer);
  const host::PathsAnswer read = host::read_paths_answer(bytes);
  EXPECT_EQ(read.status, answer.status);
  ASSERT_EQ(read.paths.size(), 2u);
  EXPECT_EQ(read.paths[0].points, answer.paths[0].points);
  EXPECT_EQ(read.paths[0].length_m, 5);
  EXPECT_EQ(read.paths[0].clearance_m, 0.7);
  EXPECT_TRUE(read.paths[1].points.empty());
  EXPECT_EQ(read.paths[1].length_m, std::numeric_limits<double>::infinity());
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_THROW(host::read_paths_answer({bytes.data(), n}), host::FlatError) << n;
}

}  // namespace
}  // namespace karst::test
