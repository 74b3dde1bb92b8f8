#include "sdk/evaluation/metrics/object_figures.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numeric>

#include "core_stack/common/random.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::evaluation {
namespace {

using core::Vec3;
using test::TemporaryDirectory;

TEST(ObjectFigures, OfAHandMadeSearch) {
  const std::vector<TrueObject> truth{{"rope", {0, 0, 0}, true},
                                      {"rope", {10, 0, 0}, true},
                                      {"lamp", {20, 0, 0}, true},
                                      {"person", {30, 0, 0}, true},
                                      {"phone", {40, 0, 0}, false}};
  const std::vector<KnownObject> at_base{{"rope", {0.3, 0.4, 0}, 100.0},  // 0.5 m off
                                         {"rope", {2, 0, 0}, 110.0},      // the same once more: false
                                         {"lamp", {20, 1, 0}, 200.0},
                                         {"lamp", {30, 0, 0}, 50.0},     // no lamp there
                                         {"phone", {40, 0, 0}, 300.0}};  // found though hardly in view
  std::vector<KnownObject> found = at_base;
  found.push_back({"person", {30, 0, 1}, std::nullopt});
  const ObjectFigures f = object_figures(truth, found, at_base);
  EXPECT_EQ(f.placed, 5);
  EXPECT_EQ(f.seen, 4);
  EXPECT_EQ(f.found, 4);
  EXPECT_EQ(f.reported, 3);
  EXPECT_EQ(f.reported_fraction, 0.5) << "of the four seen a rope and the lamp";
  EXPECT_EQ(f.wrong, 2);
  EXPECT_NEAR(*f.error_m, (0.5 + 1 + 0) / 3, 1e-12);
  EXPECT_NEAR(*f.report_time_s, (100 + 200 + 300) / 3.0, 1e-12);
}

RC_GTEST_PROP(MatchObjects, TakesTheNearestPairThatIsLeftAgainAndAgain, (std::uint64_t seed)) {
  core::Random random(seed);
  std::vector<TrueObject> truth;
  std::vector<KnownObject> known;
  const auto what = [&] { return random.uniform() < 0.5 ? "rope" : "lamp"; };
  const auto place = [&] { return Vec3(random.uniform(0, 8), random.uniform(0, 8), 0); };
  for (int i = 0; i < 5; ++i)
    truth.push_back({what(), place(), true}), known.push_back({what(), place(), {}});
  // By searching all pairs for the least, as often as there is one.
  std::vector<std::optional<std::size_t>> expected(known.size());
  std::vector<bool> used(truth.size(), false);
  for (;;) {
    double least = 3;
    std::optional<std::pair<std::size_t, std::size_t>> best;
    for (std::size_t k = 0; k < known.size(); ++k)
      for (std::size_t t = 0; t < truth.size(); ++t)
        if (const double d = (known[k].position - truth[t].position).norm();
            !expected[k] && !used[t] && known[k].what == truth[t].what && d <= least)
          least = d, best = {k, t};
    if (!best) break;
    expected[best->first] = best->second;
    used[best->second] = true;
  }
  RC_ASSERT(match_objects(known, truth) == expected);
}

constexpr const char* kTruth =
    R"({"time_s": 0.000, "event": "placed", "number": 1, "what": "rope", "position": [1, 0, 0]}
{"time_s": 0.000, "event": "placed", "number": 2, "what": "drill", "position": [9, 0, 0]}
{"time_s": 4.000, "event": "in view", "number": 1, "what": "rope", "position": [1, 0, 0]}
{"time_s": 5.000, "event": "seen", "number": 1, "what": "rope", "position": [1, 0, 0]}
)";
constexpr const char* kFound =
    R"({"t": 6, "kind": "object", "number": 1, "state": "found", "what": "rope", "position": [2, 0, 0], "deviation": 0.3}
{"t": 9, "kind": "object", "number": 2, "state": "found", "what": "rope", "position": [7, 0, 0], "deviation": 0.3}
{"t": 11, "kind": "object", "number": 1, "state": "revised", "what": "rope", "position": [1.5, 0, 0], "deviation": 0.1}
{"t": 12, "kind": "object", "number": 2, "state": "withdrawn", "what": "rope", "position": [7, 0, 0], "deviation": 0.3}
)";

TEST(ObjectFigures, OfARunThatReportedAtTheStart) {
  TemporaryDirectory dir;
  dir.write("truth_objects.jsonl", kTruth);
  dir.write("events.jsonl", std::string(kFound) +
                                R"({"t": 80, "kind": "object", "number": 1, "state": "reported"})"
                                "\n");
  const ObjectFigures f = object_figures(read_run(dir.path()));
  EXPECT_EQ(f.placed, 2);
  EXPECT_EQ(f.seen, 1);
  EXPECT_EQ(f.found, 1);
  EXPECT_EQ(f.reported, 1);
  EXPECT_EQ(f.reported_fraction, 1);
  EXPECT_EQ(f.wrong, 0);
  EXPECT_NEAR(*f.error_m, 0.5, 1e-12);
  EXPECT_EQ(f.report_time_s, 80);
}

TEST(ObjectFigures, OfARunThatNeverCameBackOrHadNoneToFind) {
  TemporaryDirectory lost, none;
  lost.write("truth_objects.jsonl", kTruth);
  lost.write("events.jsonl", kFound);
  const ObjectFigures f = object_figures(read_run(lost.path()));
  EXPECT_EQ(f.found, 1);
  EXPECT_EQ(f.reported, 0);
  EXPECT_EQ(f.reported_fraction, 0);
  EXPECT_FALSE(f.error_m || f.report_time_s);
  none.write("events.jsonl", kFound);
  const ObjectFigures nothing = object_figures(read_run(none.path()));
  EXPECT_FALSE(nothing.placed || nothing.found || nothing.reported || nothing.wrong);
}

}  // namespace
}  // namespace karst::evaluation
