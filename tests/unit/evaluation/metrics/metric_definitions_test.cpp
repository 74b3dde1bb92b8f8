// One table of figures: metrics.json and docs/metrics.md must say the same.
#include "sdk/evaluation/metrics/metric_definitions.h"

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <set>
#include <string>

#include "sdk/evaluation/metrics/metrics.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::evaluation {
namespace {

/// What metrics.json holds beside the figures that campaigns compare.
const std::set<std::string> kBeside{"schema", "policy", "cave", "seed", "outcome", "reason", "horizon_s"};

std::vector<std::string> names_in_table() {
  std::vector<std::string> names;
  for (const MetricDefinition& d : metric_definitions()) names.emplace_back(d.name);
  return names;
}

TEST(MetricDefinitions, AreTheFiguresOfMetricsJsonInItsOrder) {
  test::TemporaryDirectory dir;
  dir.write("unsurveyed.csv", "t_s,unsurveyed_m3\n1,0\n");  // of a mission with a survey: it has all of them
  dir.write("events.jsonl", R"({"t":4,"kind":"earlier_map","state":"found","attempt":1,"free_m3":9})"
                            "\n");
  std::vector<std::string> names;
  const nlohmann::ordered_json metrics = evaluate_run(dir.path(), {});
  for (const auto& [key, value] : metrics.items())
    if (!kBeside.count(key)) names.push_back(key);
  EXPECT_EQ(names, names_in_table());
}

TEST(MetricDefinitions, AreAllDefinedInTheDocsInTheSameOrder) {
  std::ifstream in(std::string(KARST_SOURCE_DIR) + "/docs/metrics.md");
  ASSERT_TRUE(in);
  std::vector<std::string> names;
  const std::regex name("`([a-z0-9_]+)`");
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("| `", 0) != 0) continue;
    const std::string cell = line.substr(2, line.find(" | ") - 2);
    for (std::sregex_iterator m(cell.begin(), cell.end(), name), end; m != end; ++m)
      if (!kBeside.count((*m)[1])) names.push_back((*m)[1]);
  }
  EXPECT_EQ(names, names_in_table());
}

TEST(MetricDefinitions, HaveNamesThatSayTheirUnit) {
  std::set<std::string_view> seen;
  for (const MetricDefinition& d : metric_definitions()) {
    EXPECT_TRUE(seen.insert(d.name).second) << d.name;
    EXPECT_FALSE(d.meaning.empty()) << d.name;
    const auto ends_in = [&](std::string_view e) {
      return d.name.size() > e.size() && d.name.substr(d.name.size() - e.size()) == e;
    };
    for (const auto& [ending, unit] : {std::pair("_s", "s"),
                                       {"_m", "m"},
                                       {"_mps", "m/s"},
                                       {"_m3", "m^3"},
                                       {"_wh", "Wh"},
                                       {"_rad", "rad"},
                                       {"_percent", "%"}})
      EXPECT_EQ(ends_in(ending), d.unit == unit) << d.name;
  }
}

TEST(MetricDefinitions, AreFoundByName) {
  for (std::size_t i = 0; i < metric_definitions().size(); ++i)
    EXPECT_EQ(metric_index(metric_definitions()[i].name), static_cast<int>(i));
  EXPECT_EQ(metric_index("speed"), -1);
  EXPECT_EQ(metric_index(""), -1);
}

TEST(MetricDefinitions, LetAFailedTrialCountAsTheWorstWhereThatCanBeSaid) {
  for (const MetricDefinition& d : metric_definitions()) {
    EXPECT_TRUE(d.if_failed != IfFailed::nothing || d.better == Better::more) << d.name;
    EXPECT_TRUE(d.if_failed != IfFailed::horizon || d.better == Better::less) << d.name;
  }
}

}  // namespace
}  // namespace karst::evaluation
