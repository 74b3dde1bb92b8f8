// Decisions out of a run record written by hand.
#include <gtest/gtest.h>

#include "sdk/evaluation/decisions/decision_record.h"
#include "sdk/evaluation/decisions/decision_text.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::evaluation {
namespace {

using test::TemporaryDirectory;

constexpr const char* kThreeDecisions = R"({"t":2.0,"kind":"phase","phase":"takeoff","reason":""}
{"t":5.0,"kind":"phase","phase":"explore","reason":""}
{"t":10.3,"kind":"decision","appending":false,"frontiers":2,"goals":3,"outcome":"goals","policy":"mine","reason":""}
{"t":10.3,"kind":"frontiers","clusters":[[7,4,0,1,120],[9,-3,1,1,40]]}
{"t":10.3,"kind":"frontier","id":11,"position":[0,0,9],"reason":"no sensor sees it","state":"refused"}
{"t":10.3,"kind":"goal","frontier":9,"heading":null,"position":[-2,1,1],"reason":"it lies in unknown space","score":9.5,"state":"rejected","why":"largest"}
{"t":10.3,"kind":"goal","frontier":7,"heading":0.1,"position":[3,0,1],"reason":"","score":7.25,"state":"accepted","why":"nearest"}
{"t":14.6,"kind":"decision","appending":false,"frontiers":1,"goals":1,"outcome":"goals","policy":"mine","reason":""}
{"t":14.6,"kind":"frontiers","clusters":[[7,4,0,1,80]]}
{"t":16.0,"kind":"goal","frontier":7,"heading":0.1,"position":[3,0,1],"reason":"","score":7.25,"state":"reached","why":"nearest"}
{"t":16.7,"kind":"decision","appending":false,"frontiers":0,"goals":0,"outcome":"explored","policy":"mine","reason":"nothing is left"}
{"t":16.7,"kind":"frontiers","clusters":[]}
{"t":16.7,"kind":"phase","phase":"home","reason":"explored"}
)";

RunRecord record_of(const std::string& events, const std::string& trajectory = "10.3 1 0 1 0 0 0 1\n") {
  const TemporaryDirectory dir;
  dir.write("events.jsonl", events);
  dir.write("trajectory.tum", trajectory);
  return read_run(dir.path());
}

/// The decision at a time, of which the test knows that it is there.
DecisionRecord decision_of(const RunRecord& run, double t_s) {
  const auto found = decision_at(run, t_s);
  EXPECT_TRUE(found) << "no decision at " << t_s;
  return found.value_or(DecisionRecord{});
}

TEST(Decision, IsTheLastOneByThen) {
  const RunRecord run = record_of(kThreeDecisions);
  EXPECT_FALSE(decision_at(run, 10.29));
  for (const auto& [t_s, number] : {std::pair(10.3, 1u), {14.59, 1u}, {14.6, 2u}, {14.597, 2u}, {99.0, 3u}}) {
    const DecisionRecord d = decision_of(run, t_s);
    EXPECT_EQ(d.number, number) << t_s;
    EXPECT_EQ(d.of, 3u);
  }
  EXPECT_FALSE(decision_at(record_of("{\"t\":2.0,\"kind\":\"phase\",\"phase\":\"takeoff\"}\n"), 99));
  EXPECT_FALSE(decision_at(record_of(""), 99));
}

TEST(Decision, HasItsGoalsItsFrontiersAndItsPhase) {
  const DecisionRecord d = decision_of(record_of(kThreeDecisions), 10.3);
  EXPECT_EQ(d.phase, "explore");
  ASSERT_EQ(d.refused.size(), 1u);
  EXPECT_EQ(d.refused[0].reason, "it lies in unknown space");
  ASSERT_TRUE(d.accepted);
  EXPECT_EQ(d.accepted->frontier, 7u);
  ASSERT_EQ(d.offered.size(), 2u);
  EXPECT_EQ(d.offered[1].unknown_cells, 40u);
  ASSERT_EQ(d.unseen.size(), 1u);
  EXPECT_EQ(d.unseen[0].id, 11u);
}

TEST(Decision, OnWhichTheVehicleFliesHomeWasMadeWhileItExplored) {
  const DecisionRecord d = decision_of(record_of(kThreeDecisions), 20);
  EXPECT_EQ(d.phase, "explore");
  EXPECT_EQ(d.decision.outcome, core::Outcome::explored);
  EXPECT_FALSE(d.accepted);
  EXPECT_FALSE(d.flown);
}

TEST(Decision, KnowsWhatBecameOfItsGoal) {
  const RunRecord run = record_of(kThreeDecisions);
  const auto first = decision_of(run, 10.3).flown;
  ASSERT_TRUE(first);
  EXPECT_EQ(first->accepted_s, 10.3);
  EXPECT_EQ(first->until_s, 16.0);
  EXPECT_EQ(first->fate, "reached");
  const auto second = decision_of(run, 14.6).flown;
  ASSERT_TRUE(second) << "it flew on";
  EXPECT_EQ(second->accepted_s, 10.3);
}

TEST(Decision, FollowsAGoalThatWasPlannedAnew) {
  const std::string goal =
      R"("kind":"goal","frontier":7,"position":[3,0,1],"score":1,"why":"","reason":"","state":)";
  const std::string decision = R"("kind":"decision","outcome":"goals"})",
                    phase = R"({"t":0,"kind":"phase","phase":"explore"})";
  const std::string events = phase + "\n{\"t\":1," + decision + "\n{\"t\":1," + goal +
                             "\"accepted\"}\n{\"t\":2," + decision + "\n{\"t\":2," + goal +
                             "\"accepted\"}\n{\"t\":3," + goal + "\"abandoned\"}\n";
  const auto flown = decision_of(record_of(events), 1).flown;
  ASSERT_TRUE(flown);
  EXPECT_EQ(flown->planned_anew, 1);
  EXPECT_EQ(flown->fate, "abandoned");
  EXPECT_EQ(flown->until_s, 3);
}

/// A goal, and 0.6 m beside it the one that the policy chose instead.
std::string two_goals_at_once(const std::string& decision_at_2) {
  const auto goal = [](const char* t, const char* x, const std::string& state, const char* reason) {
    return std::string("{\"t\":") + t + R"(,"kind":"goal","frontier":7,"position":[)" + x +
           R"(,0,1],"score":1,"why":"near","reason":")" + reason + R"(","state":")" + state + "\"}\n";
  };
  return "{\"t\":0,\"kind\":\"phase\",\"phase\":\"explore\"}\n"
         "{\"t\":1,\"kind\":\"decision\",\"outcome\":\"goals\"}\n" +
         goal("1", "3", "accepted", "") + decision_at_2 + goal("2", "3.6", "accepted", "") +
         goal("2", "3", "superseded", "the policy chose another") + goal("5", "3.6", "reached", "");
}

// The new goal was taken for the one superseded: "superseded at 0:02.00, 0.0 s later".
TEST(Decision, ItsGoalIsNotTheOneNearbyThatItReplacesAtTheSameTime) {
  const RunRecord run =
      record_of(two_goals_at_once("{\"t\":2,\"kind\":\"decision\",\"outcome\":\"goals\"}\n"));
  const auto first = decision_of(run, 1).flown, second = decision_of(run, 2).flown;
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->fate, "superseded");
  EXPECT_EQ(first->reason, "the policy chose another");
  EXPECT_EQ(first->until_s, 2);
  EXPECT_EQ(first->planned_anew, 0);
  EXPECT_EQ(second->fate, "reached");
  EXPECT_EQ(second->until_s, 5);
}

// It was taken for the same goal, planned anew.
TEST(Decision, AGoalThatFollowsANearbyOneDoesNotEndIt) {
  const std::string goal = R"("kind":"goal","frontier":7,"score":1,"why":"","reason":"","position":)";
  const std::string decision = R"("kind":"decision","outcome":"goals","appending":)";
  const RunRecord run =
      record_of("{\"t\":0,\"kind\":\"phase\",\"phase\":\"explore\"}\n{\"t\":1," + decision +
                "false}\n{\"t\":1," + goal + "[3,0,1],\"state\":\"accepted\"}\n{\"t\":2," + decision +
                "true}\n{\"t\":2," + goal + "[3.5,0,1],\"state\":\"accepted\"}\n{\"t\":4," + goal +
                "[3,0,1],\"state\":\"reached\"}\n{\"t\":6," + goal + "[3.5,0,1],\"state\":\"reached\"}\n");
  const auto first = decision_of(run, 1).flown, second = decision_of(run, 2).flown;
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->planned_anew, 0);
  EXPECT_EQ(first->until_s, 4);
  EXPECT_EQ(second->fate, "reached");
  EXPECT_EQ(second->until_s, 6);
}

TEST(Decision, IsWhatARequestBetweenTheLastOneAndItselfWasFor) {
  const RunRecord run = record_of(kThreeDecisions);
  const DecisionRecord first = decision_of(run, 10.3), second = decision_of(run, 14.6);
  EXPECT_TRUE(was_asked_for(first, 10.0));
  EXPECT_FALSE(was_asked_for(first, 10.3)) << "it takes effect some time after it was asked for";
  EXPECT_FALSE(was_asked_for(second, 10.0));
  EXPECT_TRUE(was_asked_for(second, 10.3)) << "asked for as soon as the first was there";
  EXPECT_TRUE(was_asked_for(second, 14.3));
}

TEST(DecisionText, TellsAllThatWasRecorded) {
  EXPECT_EQ(decision_text(decision_of(record_of(kThreeDecisions), 10.3), {}),
            "Decision 1 of 3 at 0:10.30, phase explore, by mine: goals. 3 goals proposed.\n"
            "Goals of mine that were tried, best first:\n"
            "   1  score 9.500  (-2.00 1.00 1.00) m, frontier 9, largest\n"
            "        refused: it lies in unknown space\n"
            "   2  score 7.250  (3.00 0.00 1.00) m, frontier 7, nearest\n"
            "        accepted\n"
            "The goal was reached at 0:16.00, 5.7 s later.\n"
            "2 frontiers were offered:\n"
            "    id  unknown cells  straight, m  centroid, m\n"
            "     7            120          3.0  (4.00 0.00 1.00)\n"
            "     9             40          4.1  (-3.00 1.00 1.00)\n"
            "Left out: frontier 11 at (0.00 0.00 9.00) m: no sensor sees it\n");
}

TEST(DecisionText, OfAGoalUnderWayAndOfNone) {
  const RunRecord run = record_of(kThreeDecisions, "");
  EXPECT_EQ(decision_text(decision_of(run, 14.6), {}),
            "Decision 2 of 3 at 0:14.60, phase explore, by mine: goals. 1 goal proposed.\n"
            "Flew on to the goal accepted at 0:10.30, which was reached at 0:16.00, 1.4 s later.\n"
            "1 frontier was offered:\n"
            "    id  unknown cells  straight, m  centroid, m\n"
            "     7             80            ?  (4.00 0.00 1.00)\n");
  EXPECT_EQ(
      decision_text(decision_of(run, 16.7), {}),
      "Decision 3 of 3 at 0:16.70, phase explore, by mine: explored, nothing is left. 0 goals proposed.\n"
      "The vehicle flew to no goal.\n"
      "No frontiers were offered.\n");
}

TEST(DecisionText, OfARecordThatEndsSaysSo) {
  const std::string all = kThreeDecisions;
  const std::string cut = all.substr(0, all.find("{\"t\":14.6"));
  EXPECT_NE(decision_text(decision_of(record_of(cut), 10.3), {})
                .find("The goal was still flown to when the record ends."),
            std::string::npos);
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

// The goals that were tried stood there twice.
TEST(DecisionText, HasEachGoalOnceWhereTheAnswerIsRecorded) {
  const std::string answer =
      R"({"outcome":"goals","reason":"","goals":[)"
      R"({"position":[-2.0,1.0,1.0],"heading":null,"frontier":9,"score":9.5,"why":"largest"},)"
      R"({"position":[3.0,0.0,1.0],"heading":0.1,"frontier":7,"score":7.25,"why":"nearest"}]})";
  const std::string text = decision_text(decision_of(record_of(kThreeDecisions), 10.3), {{2, 10.0, answer}});
  EXPECT_EQ(count_of(text, "(-2.00 1.00 1.00) m, frontier 9"), 1u) << text;
  EXPECT_EQ(count_of(text, "(3.00 0.00 1.00) m, frontier 7"), 1u) << text;
  EXPECT_NE(text.find("largest\n        refused: it lies in unknown space\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("that were tried"), std::string::npos) << text;
}

// The header had another time than the request, without a word why.
TEST(DecisionText, SaysWhenItWasAskedForAndWhenItWasDecided) {
  const DecisionRecord d = decision_of(record_of(kThreeDecisions), 10.3);
  const std::string answer = R"({"outcome":"goals","reason":"","goals":[]})";
  EXPECT_TRUE(decision_text(d, {}).starts_with("Decision 1 of 3 at 0:10.30, phase explore"));
  EXPECT_TRUE(decision_text(d, {{2, 10.0, answer}})
                  .starts_with("Decision 1 of 3, asked at 0:10.00, decided at 0:10.30, phase explore"))
      << decision_text(d, {{2, 10.0, answer}});
  EXPECT_TRUE(decision_text(d, {{2, 9.5, answer}, {3, 10.0, answer}})
                  .starts_with("Decision 1 of 3, last asked at 0:10.00, decided at 0:10.30, "));
}

// "by fallback" and "explored" stood there in a flight in which nothing failed.
TEST(DecisionText, SaysWhyTheFallbackDecided) {
  const auto text_of = [](const std::string& reason, const std::string& more) {
    return decision_text(
        decision_of(
            record_of(
                std::string(kThreeDecisions) +
                R"({"t":20.0,"kind":"decision","goals":1,"outcome":"explored","policy":"fallback","reason":")" +
                reason + "\"}\n" + more),
            20),
        {});
  };
  const std::string refused =
      R"({"t":20.0,"kind":"goal","frontier":7,"position":[3,0,1],"reason":"too far","score":2,"state":"rejected","why":"nearest"})"
      "\n";
  const std::string of_fallback =
      R"({"t":20.0,"kind":"goal","frontier":7,"position":[3,0,1],"reason":"too far","score":2,"state":"rejected","why":"fallback: the nearest frontier"})"
      "\n";
  const std::string failed =
      R"({"t":20.0,"kind":"safety","action":"fallback","reason":"the policy failed: it hangs"})"
      "\n";
  const auto has = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  const std::string time = text_of("what is left is too far for the time allowed", refused + of_fallback);
  EXPECT_TRUE(has(time,
                  ", by the fallback, because all goals of mine were refused: nothing within reach in the "
                  "time left. 1 goal proposed"))
      << time;
  const std::string battery = text_of("what is left is too far for the battery", of_fallback);
  EXPECT_TRUE(has(
      battery, ", by the fallback, because mine gave no goal: nothing within reach with the battery left."))
      << battery;
  const std::string broken = text_of("no frontier left that can be accepted", failed + of_fallback);
  EXPECT_TRUE(
      has(broken, ", by the fallback, because mine failed: explored, no frontier left that can be accepted."))
      << broken;
}

TEST(DecisionLine, SaysThatTheTimeLeftEndedItAndNotTheCave) {
  const std::string events =
      std::string(kThreeDecisions) +
      R"({"t":20.0,"kind":"decision","goals":1,"outcome":"explored","policy":"fallback","reason":"what is left is too far for the time allowed"})"
      "\n";
  EXPECT_EQ(decision_line(decision_of(record_of(events), 20)),
            "  0:20.00  nothing within reach in the time left\n");
}

// "by fallback" stood above the policy's own goals.
TEST(DecisionText, SaysWhichPolicyProposedWhat) {
  std::string events = kThreeDecisions;
  events +=
      R"({"t":20.0,"kind":"decision","frontiers":1,"goals":1,"outcome":"explored","policy":"fallback","reason":"too far"}
{"t":20.0,"kind":"goal","frontier":7,"position":[3,0,1],"reason":"too far","score":2,"state":"rejected","why":"nearest"}
{"t":20.0,"kind":"goal","frontier":7,"position":[3,0,1],"reason":"too far","score":-2,"state":"rejected","why":"fallback: the nearest frontier"}
)";
  const DecisionRecord d = decision_of(record_of(events), 20);
  EXPECT_NE(decision_text(d, {}).find("Goals of mine that were tried, best first:\n"
                                      "   1  score 2.000  (3.00 0.00 1.00) m, frontier 7, nearest\n"
                                      "        refused: too far\n"
                                      "Goals of the fallback policy that were tried, best first:\n"
                                      "   1  score -2.000  (3.00 0.00 1.00) m, frontier 7, fallback: the "
                                      "nearest frontier\n        refused: too far\n"),
            std::string::npos)
      << decision_text(d, {});
  const std::string untried =
      R"({"outcome":"goals","goals":[{"position":[8,0,1],"frontier":8,"score":1,"why":"last"}]})";
  DecisionRecord other = d;
  other.refused.back().position = {8, 0, 1};
  EXPECT_NE(answer_table({4, 19.0, untried}, other).find("last\n        not tried\n"), std::string::npos)
      << "it was the fallback's goal at the same place that was refused";
}

TEST(DecisionLine, HasTheGoalOrWhyThereIsNone) {
  const RunRecord run = record_of(kThreeDecisions);
  EXPECT_EQ(decision_line(decision_of(run, 10.3)), "  0:10.30  (3.00 0.00 1.00) m, frontier 7, nearest\n");
  EXPECT_EQ(decision_line(decision_of(run, 14.6)), "  0:14.60  (3.00 0.00 1.00) m, as before\n");
  EXPECT_EQ(decision_line(decision_of(run, 16.7)), "  0:16.70  explored, nothing is left\n");
}

TEST(AnswerTable, HasTheWholeRankedListWithWhatBecameOfEachGoal) {
  const std::string answer =
      R"({"outcome":"goals","reason":"","goals":[)"
      R"({"position":[-2.0,1.0,1.0],"heading":null,"frontier":9,"score":9.5,"why":"largest"},)"
      R"({"position":[3.0,0.0,1.0],"heading":0.1,"frontier":7,"score":7.25,"why":"nearest"},)"
      R"({"position":[5.0,5.0,1.0],"heading":null,"frontier":0,"score":1.0,"why":"last"}]})";
  const RunRecord run = record_of(kThreeDecisions);
  EXPECT_EQ(answer_table({2, 10.0, answer}, decision_of(run, 10.3)),
            "Request 2 at 0:10.00, answered by mine: goals, 3 goals, best first:\n"
            "   1  score 9.500  (-2.00 1.00 1.00) m, frontier 9, largest\n"
            "        refused: it lies in unknown space\n"
            "   2  score 7.250  (3.00 0.00 1.00) m, frontier 7, nearest\n"
            "        accepted\n"
            "   3  score 1.000  (5.00 5.00 1.00) m, no frontier, last\n"
            "        not tried\n");
  EXPECT_NE(
      answer_table({3, 14.3, answer}, decision_of(run, 14.6)).find("nearest\n        under way already\n"),
      std::string::npos);
}

TEST(AnswerTable, OfAFailureOrOfAnotherShapeSaysWhatItIs) {
  const DecisionRecord d = decision_of(record_of(kThreeDecisions), 10.3);
  EXPECT_EQ(answer_table({1, 10, R"({"failure":"it hangs"})"}, d),
            "Request 1 at 0:10.00, answered by mine: the policy failed: it hangs\n");
  EXPECT_EQ(answer_table({1, 10, R"({"outcome":"hold","reason":"wait","goals":[]})"}, d),
            "Request 1 at 0:10.00, answered by mine: hold, wait, 0 goals\n");
  for (const char* text : {"no JSON", "[1]", "{\"outcome\":3}", "{\"goals\":7}"})
    EXPECT_EQ(answer_table({1, 10, text}, d),
              std::string("Request 1 at 0:10.00, answered by mine: ") + text + "\n");
  EXPECT_NE(
      answer_table({1, 10, "{\"goals\":[7,{\"position\":[1]}]}"}, d).find("score ?  (?) m, no frontier"),
      std::string::npos);
}

}  // namespace
}  // namespace karst::evaluation
