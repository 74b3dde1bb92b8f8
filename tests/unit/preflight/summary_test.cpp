// The summary in words, as JSON and as a page.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sdk/preflight/preflight_json.h"
#include "sdk/preflight/preflight_page.h"
#include "sdk/preflight/preflight_words.h"
#include "tests/unit/preflight/known_mission.h"

namespace karst::preflight {
namespace {

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++n;
  return n;
}

void expect_parts(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << part << " is not in:\n" << text;
}

Finding watched(const std::string& text) { return {Severity::watch, Subject::hole, text}; }
Finding refused(const std::string& text) { return {Severity::no_go, Subject::start, text}; }

TEST(PreflightWords, OfDurations) {
  EXPECT_EQ(duration_text(48.4), "48 s");
  EXPECT_EQ(duration_text(59.6), "1:00 min");
  EXPECT_EQ(duration_text(400), "6:40 min");
  EXPECT_EQ(duration_text(3605), "60:05 min");
}

TEST(PreflightWords, OfTheVerdict) {
  EXPECT_EQ(verdict_text({}), "GO");
  EXPECT_EQ(verdict_text({watched("a")}), "GO, with 1 thing to watch for");
  EXPECT_EQ(verdict_text({watched("a"), watched("b")}), "GO, with 2 things to watch for");
  EXPECT_EQ(verdict_text({refused("a"), watched("b")}), "NO-GO");
}

TEST(PreflightWords, FindingsAreNamedWithWhatTheyAreAbout) {
  const std::string text = findings_text(test::known_mission(), {refused("in rock"), watched("a hole")});
  EXPECT_EQ(text, "NO-GO: caves/demo.info\nReasons:\n  start: in rock\nWatch for:\n  hole: a hole\n");
  EXPECT_EQ(findings_text(test::known_mission(), {}), "GO: caves/demo.info\n");
}

TEST(PreflightWords, SayWhatIsKnownOfTheMission) {
  const std::string text = facts_text(test::known_mission());
  expect_parts(
      text,
      {"Time:\n", "  battery              8:00 min of hovering\n", "time of return", "with 20 s in reserve",
       "policy               deep_cave, selected for this cave\n",
       "confidence           first in 80 % of 1000 resamplings", "70 %, 90 % interval 60 % to 80 %",
       "95 % of the reachable volume, 1900 m³, landed after 6:40 min",
       "ranked by            coverage averaged over the flight (coverage_auc), in flights of at most 480 s",
       "runner-up            nearest, 60 %", "2000 m³, by which coverage is measured",
       "210 m in all; the widest ball that fits has a diameter of 2.4 m", "wall to wall         4.0 m wide",
       "1.00 2.00 1.50, 1.2 m from rock", "hull 0.60 m wide, flies where passages are 1.10 m wide",
       "86 deg up and 80 deg down"});
}

// Beside a battery of a few minutes an hour was "allowed".
TEST(PreflightWords, TheFlightTimeAllowedIsLeftOutWhereTheBatteryEndsLongBefore) {
  Preflight p = test::known_mission();
  EXPECT_EQ(facts_text(p).find("flight time allowed"), std::string::npos);
  p.time->limits.max_flight_time_s = 900;
  expect_parts(facts_text(p), {"flight time allowed  15:00 min"});
  p.time->limits.max_flight_time_s = 3600;
  p.time->limits.battery_s.reset();
  expect_parts(facts_text(p), {"flight time allowed  60:00 min"});
}

// Of a cave of half a minute only the time of return was said, which the battery decides.
TEST(PreflightWords, SayWhenTheCaveIsExplored) {
  Preflight p = test::known_mission();
  p.policy->expected[2].value = p.time->home_s + 95;
  expect_parts(facts_text(p), {"explored             after about 1:35 min, as in the flights known\n"});
  p.policy->expected[2].value = p.time->return_s;
  EXPECT_EQ(facts_text(p).find("  explored "), std::string::npos) << "the time ends before";
}

TEST(PreflightWords, OfACaveUnlikeAllFlownTheTimeToExploreItIsRough) {
  Preflight p = test::known_mission();
  p.policy->expected.clear();
  p.cave->figures.length_m = 30;
  const std::string text = facts_text(p);
  expect_parts(text, {"explored             roughly after ", "to fly once along the 30 m of passages\n"});
  p.cave->figures.length_m = 3000;
  EXPECT_EQ(facts_text(p).find("  explored "), std::string::npos) << "no such flight is possible";
}

TEST(PreflightWords, OfANamedPolicyTheBestIsNamedToo) {
  Preflight p = test::known_mission();
  p.policy->selected = false;
  p.policy->policy = "nearest_frontier";
  p.policy->own = 1;
  const std::string text = facts_text(p);
  expect_parts(text, {"nearest_frontier, as named", "best                 deep_cave, 70 %"});
  EXPECT_EQ(text.find("runner-up"), std::string::npos);
  EXPECT_EQ(text.find("confidence"), std::string::npos) << "it is that of the first";
}

// All of them stood in one line.
TEST(PreflightWords, ParametersAreOnThePageOnly) {
  Preflight p = test::known_mission();
  p.policy->parameters.emplace_back("even_volume", "10 m^3");
  EXPECT_EQ(facts_text(p).find("60 m, even_volume"), std::string::npos);
  expect_parts(preflight_page(p, {}),
               {"<th scope=\"row\">parameters</th><td>horizon 60 m, even_volume 10 m³"});
}

TEST(PreflightWords, SayThatThePolicyIsAFallback) {
  Preflight p = test::known_mission();
  p.policy = PolicyFacts{};
  p.policy->policy = "nearest_frontier";
  p.policy->fallback = true;
  expect_parts(facts_text(p), {"nearest_frontier, because no policy could be selected for this cave"});
}

// Of 0.9996, 100 % was said.
TEST(PreflightWords, NearlyAllIsNotAll) {
  Preflight p = test::known_mission();
  p.policy->expected[0].value = 0.9996;
  expect_parts(facts_text(p), {">99 % of the reachable volume"});
}

TEST(PreflightWords, OfAShortCaveThereIsNoVerticality) {
  Preflight p = test::known_mission();
  expect_parts(facts_text(p), {"12 m from the lowest to the highest place, verticality 0.10; 3.0 junctions"});
  p.cave->figures.verticality = selection::kUnknown;
  expect_parts(facts_text(p), {"12 m from the lowest to the highest place; 3.0 junctions"});
}

TEST(PreflightWords, WhatIsNotKnownIsLeftOut) {
  Preflight p;
  p.cave_file = "x.ply";
  EXPECT_EQ(facts_text(p), "");
  p.time = time_budget({}, 50);
  EXPECT_EQ(facts_text(p).find("battery"), std::string::npos);
  EXPECT_EQ(facts_text(p).find("nan"), std::string::npos);
}

TEST(PreflightJson, HasItsSchemaAndEveryPart) {
  const Preflight p = test::known_mission();
  const nlohmann::ordered_json j = to_json(p, {watched("a hole")});
  std::vector<std::string> keys;
  for (const auto& [key, value] : j.items()) keys.push_back(key);
  EXPECT_EQ(keys, (std::vector<std::string>{"schema", "cave_file", "verdict", "findings", "time", "policy",
                                            "cave", "vehicle"}));
  EXPECT_EQ(j["schema"], "karst.preflight/1");
  EXPECT_EQ(j["verdict"], "go");
  ASSERT_EQ(j["findings"].size(), 1u);
  EXPECT_EQ(j["findings"][0]["severity"], "watch");
  EXPECT_EQ(j["findings"][0]["subject"], "hole");
  EXPECT_EQ(j["findings"][0]["text"], "a hole");
  EXPECT_EQ(j["time"]["battery_s"], 480);
  EXPECT_EQ(j["time"]["return_s"], p.time->return_s);
  EXPECT_EQ(j["policy"]["name"], "deep_cave");
  EXPECT_EQ(j["policy"]["parameters"]["horizon"], "60 m");
  EXPECT_EQ(j["policy"]["rank"], 1);
  EXPECT_EQ(j["policy"]["ranking"][1]["contestant"], "nearest");
  EXPECT_EQ(j["policy"]["expected"]["coverage"], 0.95);
  EXPECT_EQ(j["cave"]["figures"]["volume"], 2100);
  EXPECT_EQ(j["cave"]["start"][2], 1.5);
  EXPECT_EQ(j["vehicle"]["radius_m"], 0.3);
}

TEST(PreflightJson, WhatIsNotKnownIsNull) {
  Preflight p;
  const nlohmann::ordered_json j = to_json(p, {refused("in rock")});
  EXPECT_EQ(j["verdict"], "no_go");
  for (const char* part : {"time", "policy", "cave", "vehicle"}) EXPECT_TRUE(j[part].is_null()) << part;
  p.time = time_budget({}, 50);
  p.policy = PolicyFacts{};
  const nlohmann::ordered_json some = to_json(p, {});
  EXPECT_TRUE(some["time"]["battery_s"].is_null());
  EXPECT_TRUE(some["policy"]["confidence"].is_null());
  EXPECT_TRUE(some["policy"]["rank"].is_null());
}

TEST(PreflightPage, IsOnePageOfA4WithTheCaveFromAbove) {
  const std::string page = preflight_page(test::known_mission(), {watched("a hole")});
  expect_parts(page, {"<!doctype html>", "size: A4", "@media print", "GO, with 1 thing to watch for",
                      "<b>hole</b>: a hole", "time of return", "<svg ", "</html>"});
  EXPECT_EQ(count_of(page, "<svg "), 1u);
  EXPECT_EQ(page.find("http://"), page.find("http://www.w3.org/2000/svg")) << "nothing comes from elsewhere";
  EXPECT_EQ(page.find("https://"), std::string::npos);
}

TEST(PreflightPage, TextsOfOthersStayTexts) {
  Preflight p = test::known_mission();
  p.cave_file = "<img src=x>@data@</script>.ply";
  p.policy->reason = "a < b @style@";
  const std::string page = preflight_page(p, {watched("<script>alert(1)</script>")});
  EXPECT_EQ(page.find("<img"), std::string::npos);
  EXPECT_EQ(page.find("<script>"), std::string::npos);
  EXPECT_EQ(count_of(page, "</script>"), 1u) << "that of the data";
  expect_parts(page, {"&lt;img src=x&gt;@data@", "a &lt; b @style@"});
}

TEST(PreflightPage, ItsDataAreTheJson) {
  const Preflight p = test::known_mission();
  const std::string page = preflight_page(p, {}), begin = "id=\"data\">";
  const std::size_t from = page.find(begin) + begin.size();
  EXPECT_EQ(nlohmann::ordered_json::parse(page.substr(from, page.find("</script>") - from)), to_json(p, {}));
}

TEST(PreflightPage, OfARefusedCaveHasNoPicture) {
  Preflight p;
  p.cave_file = "x.ply";
  const std::string page = preflight_page(p, {refused("the start lies in rock")});
  expect_parts(page, {"NO-GO", "Reasons against it", "the start lies in rock"});
  EXPECT_EQ(page.find("<svg"), std::string::npos);
}

}  // namespace
}  // namespace karst::preflight
