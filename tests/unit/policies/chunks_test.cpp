// Questions and answers larger than the host takes at once, by the test kit's host, which has the same
// limits.
#include <karst/chunks.h>

#include <gtest/gtest.h>

#include <karst/policy.h>
#include <karst/testing/bench.h>

#include <cmath>
#include <utility>

namespace {

using karst::Cell;
using karst::Decision;
using karst::Vec3;
using karst::testing::Bench;
using karst::testing::DrawnHost;
using karst::testing::DrawnMap;

using Pieces = std::vector<std::pair<std::size_t, std::size_t>>;

Pieces pieces_of(std::size_t count, std::size_t limit) {
  Pieces out;
  karst::for_chunks(count, limit,
                    [&](std::size_t begin, std::size_t size) { out.emplace_back(begin, size); });
  return out;
}

TEST(Chunks, CoverEverythingOnceInOrder) {
  EXPECT_EQ(pieces_of(0, 4), (Pieces{{0, 0}})) << "asked all the same: the host's other checks hold";
  EXPECT_EQ(pieces_of(3, 4), (Pieces{{0, 3}}));
  EXPECT_EQ(pieces_of(4, 4), (Pieces{{0, 4}})) << "no empty call at the end";
  EXPECT_EQ(pieces_of(5, 4), (Pieces{{0, 4}, {4, 1}}));
  EXPECT_EQ(pieces_of(12, 4), (Pieces{{0, 4}, {4, 4}, {8, 4}}));
}

/// One free cell and one of rock, and questions about them in turn: the answer tells which was asked.
struct TwoCells {
  DrawnHost host{DrawnMap(1.0, {"a#"})};
  karst_request_t r{};
  const Vec3 free{0.5, 0.5, 0.5}, rock{1.5, 0.5, 0.5};

  TwoCells() {
    r.size = sizeof r;
    r.map = host.map_handle();
  }
  karst::Request request() const { return {host.host(), r}; }
  template <class T>
  static std::vector<T> in_turn(std::size_t count, const T& a, const T& b) {
    std::vector<T> out(count, a);
    for (std::size_t i = 1; i < count; i += 3) out[i] = b;
    return out;
  }
};

const std::size_t kBatch = KARST_MAX_BATCH, kGoals = KARST_MAX_PATH_GOALS,
                  kViewpoints = KARST_MAX_GAIN_VIEWPOINTS, kPaths = KARST_MAX_PATHS;

TEST(Chunks, CellsRaysAndBoxesMayBeMoreThanOneCallTakes) {
  const TwoCells two;
  const karst::MapView map(two.host.host(), two.host.map_handle());
  for (const std::size_t count : {kBatch, kBatch + 2}) {
    const auto cells = map.cells(TwoCells::in_turn(count, two.free, two.rock));
    EXPECT_EQ(cells, TwoCells::in_turn(count, Cell::free, Cell::occupied));
    const auto ends = map.cast(
        TwoCells::in_turn(count, karst_segment_t{two.free, two.free}, karst_segment_t{two.rock, two.rock}),
        false);
    const auto counts =
        map.counts(TwoCells::in_turn(count, karst::Box{two.free, two.free}, karst::Box{two.rock, two.rock}));
    const auto places = map.passages_at(TwoCells::in_turn(count, two.free, {50, 50, 50}));
    ASSERT_EQ(ends.size(), count);
    ASSERT_EQ(counts.size(), count);
    ASSERT_EQ(places.size(), count);
    for (std::size_t i = 0; i < count; ++i) {
      const bool is_rock = i % 3 == 1;
      ASSERT_EQ(ends[i].state == karst_cell_t{KARST_CELL_OCCUPIED}, is_rock) << i;
      ASSERT_EQ(counts[i].occupied, is_rock ? 1u : 0u) << i;
      ASSERT_EQ(places[i].passage, is_rock ? karst::PassagePlace::none : 0u) << i;
    }
  }
  EXPECT_TRUE(map.cells({}).empty());
}

TEST(Chunks, GoalsOfPathsAndViewpointsMayBeMoreThanOneCallTakes) {
  const TwoCells two;
  const karst::Request request = two.request();
  for (const std::size_t count : {kGoals, kGoals + 2}) {
    const auto lengths = request.path_lengths(two.free, TwoCells::in_turn(count, two.free, two.rock), 0.5);
    EXPECT_EQ(lengths, TwoCells::in_turn(count, 0.0, HUGE_VAL));
  }
  for (const std::size_t count : {kPaths, kPaths + 2}) {
    const auto paths = request.paths(two.free, TwoCells::in_turn(count, two.free, two.rock));
    ASSERT_EQ(paths.size(), count);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(paths[i].points.size(), i % 3 == 1 ? 0u : 2u) << i;
      EXPECT_EQ(paths[i].length_m, i % 3 == 1 ? HUGE_VAL : 0.0) << i;
    }
  }
  for (const std::size_t count : {kViewpoints, kViewpoints + 2}) {
    karst::Sensor lidar = karst::testing::lidar(1.2);
    const karst::Viewpoint here{two.free, 0}, inside{two.rock, 0};
    const std::uint64_t seen_here = request.newly_seen(lidar, {here}).at(0),
                        seen_inside = request.newly_seen(lidar, {inside}).at(0);
    ASSERT_NE(seen_here, seen_inside);
    EXPECT_EQ(request.newly_seen(lidar, TwoCells::in_turn(count, here, inside)),
              TwoCells::in_turn(count, seen_here, seen_inside));
  }
}

TEST(Chunks, TheTestKitRefusesWhatTheHostRefuses) {
  const TwoCells two;
  const karst_host_t* h = two.host.host();
  const karst_map_t* m = two.host.map_handle();
  karst_error_t e{};
  EXPECT_EQ(h->map->cell_states(h, m, nullptr, kBatch + 1, nullptr, &e), KARST_ERROR_LIMIT);
  EXPECT_STREQ(e.text, "more items than one call takes");
  EXPECT_EQ(e.code, KARST_ERROR_LIMIT);
  EXPECT_EQ(h->map->cast_rays(h, m, nullptr, kBatch + 1, 0, nullptr, nullptr), KARST_ERROR_LIMIT);
  EXPECT_EQ(h->map->count_in_boxes(h, m, nullptr, kBatch + 1, nullptr, &e), KARST_ERROR_LIMIT);
  EXPECT_EQ(h->map->distances_to_rock(h, m, nullptr, kBatch + 1, 1, nullptr, &e), KARST_ERROR_LIMIT);
  EXPECT_EQ(h->map->passages_at(h, m, nullptr, kBatch + 1, nullptr, &e), KARST_ERROR_LIMIT);
  EXPECT_EQ(h->path->lengths(h, two.free, nullptr, kGoals + 1, 1, nullptr, &e), KARST_ERROR_LIMIT);
  EXPECT_EQ(h->path->paths(h, two.free, nullptr, kPaths + 1, 1, nullptr, nullptr, 0, &e), KARST_ERROR_LIMIT);
  EXPECT_EQ(h->gain->newly_seen(h, m, nullptr, 1, nullptr, kViewpoints + 1, nullptr, &e), KARST_ERROR_LIMIT);
  EXPECT_EQ(h->gain->newly_seen(h, m, nullptr, 17, nullptr, 1, nullptr, &e), KARST_ERROR_LIMIT);
}

/// Answers what the test has put here.
Decision next_answer;
class Scripted : public karst::Policy {
  Decision decide(const karst::Request&) override { return next_answer; }
};
const karst_plugin_t* scripted() {
  static const auto policy = [](std::uint32_t) noexcept {
    return karst::border::entry<Scripted>("scripted", "1.0.0", "As told.");
  };
  static const karst_plugin_t plugin{sizeof(karst_plugin_t), KARST_ABI_MAJOR, KARST_ABI_MINOR, 1, policy};
  return &plugin;
}
/// The answer as the host gets it, and what was logged.
struct Heard {
  Decision decision;
  std::vector<std::string> log;
};
Heard heard(const Decision& answer) {
  next_answer = answer;
  Bench bench(scripted(), DrawnMap(1.0, {"."}));
  Heard out{bench.decide(), {}};
  out.log = bench.host().log_lines;
  return out;
}
Decision with_goals(std::size_t count, const std::string& why) {
  std::vector<karst::Goal> goals(count);
  for (std::size_t i = 0; i < count; ++i) {
    goals[i].frontier_id = static_cast<std::uint32_t>(i + 1);
    goals[i].why = why;
  }
  return Decision::fly(goals);
}

TEST(Answers, AsManyGoalsAsTheHostTakesGoThroughInSilence) {
  const Heard h = heard(with_goals(64, std::string(240, 'x')));
  EXPECT_EQ(h.decision.goals.size(), 64u);
  EXPECT_EQ(h.decision.goals.back().why.size(), 240u);
  EXPECT_TRUE(h.log.empty());
}

// As it was: the whole decision was an error, and the vehicle held.
TEST(Answers, OfMoreGoalsTheFirstAreOfferedAndOneLineSaysSo) {
  const Heard h = heard(with_goals(70, ""));
  ASSERT_EQ(h.decision.goals.size(), 64u);
  EXPECT_EQ(h.decision.goals.back().frontier_id, 64u);
  EXPECT_EQ(h.log,
            std::vector<std::string>{"of 70 goals only the first 64 are offered: the host takes no more"});
}

TEST(Answers, LongReasonsAreCutBetweenLettersAndOneLineSaysSo) {
  Decision long_whys = with_goals(3, std::string(239, 'x') + "\u00e9 and more");  // two bytes, over the limit
  long_whys.goals[1].why = "short";
  const Heard h = heard(long_whys);
  EXPECT_EQ(h.decision.goals[0].why, std::string(239, 'x'));
  EXPECT_EQ(h.decision.goals[1].why, "short");
  EXPECT_EQ(h.log, std::vector<std::string>{"2 texts are cut to 240 bytes: the host takes no longer lines"});

  const Heard reason = heard(Decision::hold(std::string(238, 'x') + "\U0001F987 and more"));  // four bytes
  EXPECT_EQ(reason.decision.reason, std::string(238, 'x'));
  EXPECT_EQ(reason.log,
            std::vector<std::string>{"1 text is cut to 240 bytes: the host takes no longer lines"});
  EXPECT_EQ(heard(Decision::hold(std::string(238, 'x') + "\u00e9!")).decision.reason,
            std::string(238, 'x') + "\u00e9")
      << "what ends at the limit stays whole";
}

TEST(Answers, AnErrorsTextIsCutBetweenLettersToo) {
  karst_error_t e{};
  const std::string bat = "\U0001F987";
  karst::border::fill(&e, KARST_ERROR_FAILED, (std::string(253, 'x') + bat).c_str());
  EXPECT_EQ(std::string(e.text), std::string(253, 'x')) << "two of its four bytes were within the limit";
}

TEST(Answers, TheBenchTakesNoMoreGoalsThanTheHost) {
  karst_goal_t goals[65] = {};
  static const karst_goal_t* offered = nullptr;
  offered = goals;
  karst_policy_t policy = *scripted()->policy(0);
  policy.decide = [](void*, const karst_request_t*, const karst_decision_sink_t* sink,
                     karst_error_t* error) noexcept { return sink->add_goals(sink, offered, 65, error); };
  static const karst_policy_t* table = nullptr;
  table = &policy;
  const karst_plugin_t plugin{sizeof(karst_plugin_t), KARST_ABI_MAJOR, KARST_ABI_MINOR, 1,
                              [](std::uint32_t) noexcept { return table; }};
  Bench bench(&plugin, DrawnMap(1.0, {"."}));
  EXPECT_THROW(bench.decide(), karst::Error);
}

}  // namespace
