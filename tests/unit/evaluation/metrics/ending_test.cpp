// How flights end, in words, for every reason that mission control gives and every outcome.
#include "sdk/evaluation/metrics/ending.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>
#include <string>

#include "core_stack/common/input_file.h"
#include "core_stack/common/time.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::evaluation {
namespace {

namespace event = core::event;
using core::MissionOutcome;
using core::SafetyAction;
using test::TemporaryDirectory;

std::string line(double t_s, const event::Event& e) {
  return event::line_of(core::from_seconds(t_s), e) + "\n";
}
std::string phase(double t_s, core::Phase to, const std::string& reason = "") {
  return line(t_s, event::Phase{to, reason});
}
std::string home(double t_s, const std::string& reason) { return phase(t_s, core::Phase::home, reason); }
std::string land(double t_s, const std::string& reason = "") { return phase(t_s, core::Phase::land, reason); }
std::string safety(double t_s, SafetyAction action, const std::string& reason) {
  return line(t_s, event::Safety{action, reason});
}
std::string over(double t_s, MissionOutcome outcome, const std::string& reason) {
  return phase(t_s, core::Phase::done, reason) + line(t_s, event::Outcome{outcome, reason});
}
std::string landed(double t_s) { return over(t_s, MissionOutcome::landed, "at the start"); }
/// Takes off at 1 s and explores from 4 s on.
std::string explores() {
  return phase(0, core::Phase::standby) + phase(1, core::Phase::takeoff) + phase(4, core::Phase::explore);
}

Ending ending(const std::string& events, const EndFigures& figures = {}) {
  TemporaryDirectory dir;
  dir.write("events.jsonl", events);
  return ending_of(read_events_alone(dir.path()), figures);
}

/// What sends a vehicle home without the supervisor: the mission goes as meant.
struct HomeReason {
  std::string source;  // as it stands in the sources of mission control
  std::string more;    // what follows it in the event
  std::string sentence;
};
const HomeReason kHome[] = {
    {"explored: ", "no frontier can be reached", "home because nothing was left to explore"},
    {"explored: ", "no frontier left that can be accepted", "home because nothing was left to explore"},
    {"explored: ", "", "home because nothing was left to explore"},
    {"explored: ", "all walls seen", "home because nothing was left to explore (all walls seen)"},
    {"what is left is too far for the battery", "", "home because what was left was too far for the battery"},
    {"what is left is too far for the time allowed", "",
     "home because what was left was too far for the time allowed"},
    {"the policy asked for it: ", "", "home because the policy asked for it"},
    {"the policy asked for it: ", "late", "home because the policy asked for it (late)"},
    {"an error of the core: ", "", ""},  // the next one's detail
    {"the policy asked for it: ", "an error of the core: no memory",
     "home because the core failed (no memory)"},
    {"the battery only just suffices for the way home", "",
     "home because the battery only just sufficed for the way home"},
    {"the time allowed only just suffices for the way home", "",
     "home because the time allowed only just sufficed for the way home"},
    {"the run directory cannot be written any more (disk full?)", "",
     "home because the run directory could not be written any more (disk full?)"},
};

/// What makes the supervisor send it home, with what follows "home after 9 s: ".
struct SupervisorsReason {
  std::string source, why;
};
const SupervisorsReason kSentHome[] = {
    {"the state estimate stays degraded", "the state estimate stayed degraded"},
    {"no sensor sees the cave any more", "no sensor saw the cave any more"},
};

/// What makes it land, with what follows "home after 9 s: ".
struct LandReason {
  std::string source, more, why;
};
const LandReason kLand[] = {
    {"the state estimate is lost: ", "no pose for too long", "the pose was lost (no pose for too long)"},
    {"the state estimate is lost: ", "", "the pose was lost"},
    {"the battery ends", "", "the battery was nearly empty"},
    {"no way home, and waiting does not help", "", "there was no way home, and waiting did not help"},
    {"supervision does not come any more", "", "the supervision did not come any more"},
    {"control does not come any more", "", "the control did not come any more"},
    {"stopped by the operator", "", "stopped by the operator"},
    {"an unknown exception", "", "an unknown exception"},
};

/// All .cpp files of mission control; a text that is broken over two lines is joined.
std::string sources() {
  std::string all;
  for (const auto& e :
       std::filesystem::recursive_directory_iterator(std::string(KARST_SOURCE_DIR) + "/core_stack/mission"))
    if (e.path().extension() == ".cpp") all += core::read_input(e.path(), core::kMaxTextFileBytes);
  return std::regex_replace(all, std::regex("\"\\s*\n\\s*\""), "");
}

TEST(Ending, KnowsTheReasonsByTheWordsOfMissionControl) {
  const std::string all = sources();
  std::set<std::string> known;
  for (const HomeReason& r : kHome) known.insert(r.source);
  for (const SupervisorsReason& r : kSentHome) known.insert(r.source);
  for (const LandReason& r : kLand) known.insert(r.source);
  for (const std::string reason :
       {"it does not lift off: ", "in contact", "out of contact, but there is no time for another place",
        "the policy failed: "})
    known.insert(reason);
  for (const std::string& reason : known)
    EXPECT_NE(all.find("\"" + reason), std::string::npos) << reason << ": it says something else now";

  // And no reason that it gives in so many words is left out here.
  // A second homing, of which the first one's reason is told.
  known.insert("the pose is known again");
  known.insert("the core steers again");
  const std::regex given("\\b(begin|land_now|land_here|end_flight)\\(\"([^\"]+)\"");
  std::size_t found = 0;
  for (auto m = std::sregex_iterator(all.begin(), all.end(), given); m != std::sregex_iterator();
       ++m, ++found)
    EXPECT_TRUE(known.contains((*m)[2])) << "to be told in words for people: " << (*m)[2];
  EXPECT_GE(found, 6u) << "the sources are read wrongly";
}

TEST(Ending, SaysWhyAVehicleWentHome) {
  for (const HomeReason& r : kHome) {
    if (r.sentence.empty()) continue;
    const Ending e = ending(explores() + home(64, r.source + r.more) + land(90) + landed(92), {0.01, 0.62});
    EXPECT_EQ(e.sentence, r.sentence + "; 62 % battery left");
    EXPECT_TRUE(e.as_meant) << r.source;
  }
}

TEST(Ending, OfAVehicleThatTheSupervisorSentHomeSaysWhenAndIsNotAsMeant) {
  for (const SupervisorsReason& r : kSentHome) {
    const Ending e = ending(explores() + safety(10, SafetyAction::home, r.source) + home(10, r.source) +
                            land(90) + landed(92));
    EXPECT_EQ(e.sentence, "home after 9 s: " + r.why);
    EXPECT_FALSE(e.as_meant);
  }
}

TEST(Ending, SaysWhyAVehicleCameDownAtTheStart) {
  for (const LandReason& r : kLand) {
    const std::string reason = r.source + r.more;
    const Ending e = ending(
        explores() + safety(10, SafetyAction::land, reason) + land(10, reason) + landed(14), {0.2, 0.9});
    EXPECT_EQ(e.sentence, "home after 9 s: " + r.why + "; 90 % battery left");
    EXPECT_FALSE(e.as_meant) << r.source;
  }
}

TEST(Ending, SaysWhyAVehicleCameDownElsewhere) {
  for (const LandReason& r : kLand) {
    const std::string reason = r.source + r.more, place = "on the ground 11.39 m from the start";
    const std::string down = safety(10, SafetyAction::land, reason) + land(10, reason);
    const Ending early = ending(explores() + down + over(14, MissionOutcome::stuck, place));
    EXPECT_EQ(early.sentence, place + " after 9 s: " + r.why);
    EXPECT_FALSE(early.as_meant);
    const Ending on_the_way = ending(explores() + home(8, "explored: no frontier can be reached") + down +
                                     over(14, MissionOutcome::stuck, place));
    EXPECT_EQ(on_the_way.sentence,
              place + ": " + r.why + "; it had turned back because nothing was left to explore");
    EXPECT_FALSE(on_the_way.as_meant);
  }
}

TEST(Ending, OfAVehicleThatMissedItsStartInLandingSaysWhyItHadTurnedBack) {
  const Ending e = ending(explores() + home(8, "explored: ") + land(12) +
                          over(14, MissionOutcome::stuck, "on the ground 1.3 m from the start"));
  EXPECT_EQ(e.sentence,
            "on the ground 1.3 m from the start; it had turned back because nothing was left to explore");
}

TEST(Ending, OfAPoseThatWasFoundAgainTellsOfTheLoss) {
  const std::string lost = "the state estimate is lost: no pose for too long";
  const Ending e = ending(explores() + safety(22, SafetyAction::land, lost) + land(22, lost) +
                          home(23.6, "the pose is known again") + land(40) + landed(42));
  EXPECT_EQ(e.sentence, "home after 21 s: the pose was lost (no pose for too long)");
  EXPECT_FALSE(e.as_meant);
}

TEST(Ending, ByTheOperatorOrAnErrorIsGivenUp) {
  for (const std::string reason : {"stopped by the operator", "std::bad_alloc"}) {
    const std::string down = safety(19, SafetyAction::land, reason) + land(19, reason),
                      place = ": on the ground 23.02 m from the start";
    EXPECT_EQ(ending(explores() + down + over(25, MissionOutcome::aborted, reason + place)).sentence,
              "given up after 18 s: " + reason + place);
    EXPECT_EQ(
        ending(explores() + home(15, "the policy asked for it: ") + down +
               over(25, MissionOutcome::aborted, reason + place))
            .sentence,
        "given up after 18 s: " + reason + place + "; it had turned back because the policy asked for it");
  }
  const Ending never_back =
      ending(explores() + home(61, "explored: ") +
             over(661, MissionOutcome::aborted,
                  "the vehicle did not come back within ten minutes after the time limit"));
  EXPECT_EQ(never_back.sentence,
            "given up after 660 s: the vehicle did not come back within ten minutes after the time limit; it "
            "had turned back because nothing was left to explore");
  EXPECT_FALSE(never_back.as_meant);
}

TEST(Ending, OfAContactALossOrAnEmptyBatterySaysWhenAndInWhichPhase) {
  EXPECT_EQ(ending(explores() + over(65, MissionOutcome::contact, "touched rock")).sentence,
            "contact after 64 s while exploring: touched rock");
  EXPECT_EQ(ending(phase(0, core::Phase::standby) + phase(1, core::Phase::takeoff) +
                   over(3, MissionOutcome::contact, "touched rock"))
                .sentence,
            "contact after 2 s while taking off: touched rock");
  EXPECT_EQ(
      ending(phase(0, core::Phase::standby) + over(3, MissionOutcome::contact, "touched robot 2")).sentence,
      "contact before take-off: touched robot 2");
  const std::string on_the_way = explores() + home(60, "explored: ");
  EXPECT_EQ(ending(on_the_way + land(64) + over(65, MissionOutcome::contact, "touched rock")).sentence,
            "contact after 64 s while landing: touched rock; it had turned back because nothing was left to "
            "explore");
  EXPECT_EQ(
      ending(on_the_way + over(65, MissionOutcome::battery, "the battery is empty"), {{}, 0.0}).sentence,
      "battery empty after 64 s on the way home; it had turned back because nothing was left to explore");
  const Ending lost = ending(explores() + over(30, MissionOutcome::lost, "as team.lost_robot has it"));
  EXPECT_EQ(lost.sentence, "lost after 29 s while exploring: as team.lost_robot has it");
  EXPECT_FALSE(lost.as_meant);
}

TEST(Ending, OfAVehicleThatIsTooHeavySaysSo) {
  const Ending e =
      ending(phase(0, core::Phase::standby) + phase(1, core::Phase::takeoff) +
                 over(4, MissionOutcome::stuck, "it does not lift off: too heavy for its motors?"),
             {{}, 0.99});
  EXPECT_EQ(e.sentence, "it did not lift off (too heavy for its motors?); 99 % battery left");
  EXPECT_FALSE(e.as_meant);
}

TEST(Ending, AsARelayIsAsMeantHoweverFarFromTheStart) {
  event::Landing claimed;
  claimed.state = event::LandingState::claimed;
  event::Landing start;
  start.state = event::LandingState::start;
  const std::string turns = explores() + home(46, "explored: no frontier can be reached");
  const auto down = [](const std::string& why) {
    return land(80, why) + over(82, MissionOutcome::landed, "as a relay");
  };
  const Ending relay = ending(turns + line(47, claimed) + down("in contact"), {12.3, 0.28});
  EXPECT_EQ(relay.sentence, "landed as a relay because nothing was left to explore; 28 % battery left");
  EXPECT_TRUE(relay.as_meant);
  EXPECT_EQ(ending(turns + line(47, claimed) + down("out of contact, but there is no time for another place"))
                .sentence,
            "landed as a relay, out of contact with the base, because nothing was left to explore");
  const Ending back = ending(turns + line(47, claimed) + line(60, start) + land(80) + landed(82), {0.1, {}});
  EXPECT_EQ(back.sentence, "home because nothing was left to explore") << "it went on to its start";
}

TEST(Ending, TrulyElsewhereThanTheVehicleBelievesIsNotAsMeant) {
  const std::string flight = explores() + home(64, "explored: ") + land(90) + landed(92);
  const Ending off = ending(flight, {1.99, {}});
  EXPECT_EQ(off.sentence, "home because nothing was left to explore; landed 2.0 m from the start");
  EXPECT_FALSE(off.as_meant);
  EXPECT_TRUE(ending(flight, {0.99, {}}).as_meant);
  EXPECT_TRUE(ending(flight).as_meant) << "without ground truth the vehicle's own estimate counts";
}

TEST(Ending, OfARecordCutShortSaysWhenAndInWhichPhase) {
  const Ending e = ending(explores() + line(65, event::Log{"the last that was heard"}), {{}, 0.5});
  EXPECT_EQ(e.sentence, "the record ends after 64 s while exploring; 50 % battery left");
  EXPECT_FALSE(e.as_meant);
}

TEST(Ending, OfAReplayIsThatOfTheRecording) {
  const std::string begin = phase(0, core::Phase::replay, "900 scans");
  const Ending all =
      ending(begin + line(90, event::Outcome{MissionOutcome::replayed, "the recording ended"}));
  EXPECT_EQ(all.sentence, "replayed: the recording ended");
  EXPECT_TRUE(all.as_meant);
  const Ending stopped =
      ending(begin + line(9, event::Outcome{MissionOutcome::aborted, "stopped by the operator"}));
  EXPECT_EQ(stopped.sentence, "given up: stopped by the operator");
  EXPECT_FALSE(stopped.as_meant);
}

TEST(Ending, OfWhatNobodyWroteDownSaysNothing) {
  const Ending e = ending("");
  EXPECT_EQ(e.sentence, "");
  EXPECT_FALSE(e.as_meant);
  EXPECT_FALSE(e.failed_policy);
}

TEST(Ending, AReasonOfAnotherVersionIsToldAsItStands) {
  EXPECT_EQ(ending(explores() + home(64, "the bats are awake") + land(90) + landed(92)).sentence,
            "home because the bats are awake");
  EXPECT_EQ(ending(explores() + home(64, "") + land(90) + landed(92)).sentence, "home after 63 s");
}

TEST(Ending, NamesAPolicyThatFailedOnTheWay) {
  const Ending e =
      ending(explores() +
             safety(6.7, SafetyAction::fallback, "the policy failed: plain: its process ended in decide()") +
             home(64, "explored: ") + land(90) + landed(92));
  ASSERT_TRUE(e.failed_policy);
  EXPECT_EQ(e.failed_policy->time_s, 6.7);
  EXPECT_EQ(e.failed_policy->why, "plain: its process ended in decide()");
  EXPECT_TRUE(e.as_meant) << "the fallback explored to the end";
  EXPECT_EQ(e.sentence,
            "home because nothing was left to explore; the policy failed, and the fallback took over");
}

// An exception in a decision or two was told by a line of the log alone.
TEST(Ending, CountsDecisionsThatThePolicyFailed) {
  const auto decision = [](double t, const std::string& reason) {
    return line(t, event::Decision{core::Outcome::hold, "mine", reason});
  };
  const Ending e = ending(
      explores() + decision(5, "mine failed: decide(): KeyError: 'x' (mine.py, line 3), request 4 at 5.0 s") +
      decision(6, "the goal is near") +
      decision(7, "mine failed: decide(): ValueError: y, request 6 at 7.0 s") + home(64, "explored: ") +
      land(90) + landed(92));
  EXPECT_EQ(e.lost_decisions.count, 2u);
  EXPECT_EQ(e.lost_decisions.last, "decide(): ValueError: y, request 6 at 7.0 s");
  EXPECT_EQ(e.sentence, "home because nothing was left to explore; the policy failed in 2 decisions");
  EXPECT_TRUE(e.as_meant);
  EXPECT_EQ(ending(explores() + landed(92)).lost_decisions.count, 0u);
}

std::string restarted(const std::string& why) {
  return line(8.7, event::Log{"warning: half_visits broke, and was started once more: " + why});
}

// Nothing but events.jsonl said so: a green "landed", and exit code 0.
TEST(Ending, NamesAPolicyThatWasStartedOnceMore) {
  const Ending e = ending(explores() +
                              restarted("its process ended in decide(): killed by signal 11 (Segmentation "
                                        "fault), request 5 at 8.4 s") +
                              home(64, "explored: ") + land(90) + landed(92),
                          {0.01, 0.62});
  ASSERT_TRUE(e.restart);
  EXPECT_EQ(sentence_of(*e.restart),
            "half_visits crashed at 8.4 s in decide(), request 5 (SIGSEGV), and was started once more");
  EXPECT_EQ(e.sentence,
            "home because nothing was left to explore; 62 % battery left; the policy crashed and was started "
            "once more");
  EXPECT_TRUE(e.as_meant) << "the exit code stays as it was";
  EXPECT_FALSE(e.failed_policy);
  EXPECT_FALSE(ending(explores() + landed(92)).restart);
  EXPECT_FALSE(
      ending(explores() + line(8, event::Log{"warning: half_visits begins anew"}) + landed(92)).restart);
}

TEST(PolicyRestart, SaysWhatTheRecordHas) {
  const auto told = [](const std::string& why) {
    const Ending e = ending(explores() + restarted(why) + landed(92));
    return e.restart ? sentence_of(*e.restart) : "";
  };
  const std::string end = ", and was started once more";
  EXPECT_EQ(told("its process ended in on_event(): killed by signal 6 (Aborted), event reached at 5.6 s"),
            "half_visits crashed at 5.6 s in on_event(), event reached (SIGABRT)" + end);
  EXPECT_EQ(told("its process ended in decide(): exit code 3, request 2 at 5.0 s"),
            "half_visits ended its process at 5.0 s in decide(), request 2 (exit code 3)" + end);
  EXPECT_EQ(told("its process stopped itself in decide(), request 2 at 5.0 s"),
            "half_visits broke at 5.0 s, request 2 (its process stopped itself in decide())" + end);
  EXPECT_EQ(told("garbage came from its process in decide(): a count of 7"),
            "half_visits broke at 8.7 s (garbage came from its process in decide(): a count of 7)" + end)
      << "without a request the time of the event";
  EXPECT_EQ(told("its process ended in decide(): killed by signal 4711 (?), request 2 at"),
            "half_visits crashed at 8.7 s in decide(), request 2 at (killed by signal 4711 (?))" + end);
}

// A flight that was allowed 60 s landed after 38 s, and nothing said why.
TEST(Ending, SaysWhatWasKeptForAfterTheWayHome) {
  for (const std::string of : {"battery", "time allowed"}) {
    const auto told = [&](const std::string& reason) {
      const EndFigures figures{{}, 0.94, 20.0};
      return ending(explores() + home(37, reason) + land(40) + landed(42), figures).sentence;
    };
    EXPECT_EQ(told("the " + of + " only just suffices for the way home"),
              "home because the " + of +
                  " only just sufficed for the way home, with 20 s in reserve; 94 % battery left");
    EXPECT_EQ(
        told("what is left is too far for the " + of),
        "home because what was left was too far for the " + of + ", with 20 s in reserve; 94 % battery left");
    EXPECT_EQ(told("explored: "), "home because nothing was left to explore; 94 % battery left");
  }
}

TEST(Ending, OfAWholeRecordTakesBatteryAndLandingFromIt) {
  TemporaryDirectory dir;
  test::write_fake_run(dir.path());  // down after 76 s of 600 s; its homing has no reason
  const Ending e = ending_of(read_run(dir.path()));
  EXPECT_TRUE(e.as_meant);
  EXPECT_EQ(e.sentence.substr(0, 10), "home after");
  EXPECT_NE(e.sentence.find("87 % battery left"), std::string::npos) << e.sentence;
}

TEST(JointEnding, IsThatOfTheOneVehicle) {
  const Ending e{.as_meant = true, .sentence = "home"};
  EXPECT_EQ(joint_ending({e}).sentence, "home");
  EXPECT_TRUE(joint_ending({e}).as_meant);
}

TEST(JointEnding, OfATeamNamesThoseThatDidNotDoAsMeant) {
  const Ending well{.as_meant = true, .sentence = "home"}, lost{.as_meant = false, .sentence = "lost"},
      none{};
  EXPECT_EQ(joint_ending({well, well}).sentence, "all 2 robots flew as planned");
  EXPECT_TRUE(joint_ending({well, well}).as_meant);
  EXPECT_EQ(joint_ending({well, lost, none}).sentence, "robot 2: lost. Robot 3: nothing recorded");
  EXPECT_FALSE(joint_ending({well, lost, none}).as_meant);
  EXPECT_EQ(joint_ending({none, none}).sentence, "");
  EXPECT_FALSE(joint_ending({none, none}).as_meant);
  EXPECT_FALSE(joint_ending({}).as_meant);
}

TEST(JointEnding, NamesTheRobotsWhosePoliciesBroke) {
  const Ending well{.as_meant = true, .sentence = "home"};
  Ending crashed = well, failed = well;
  crashed.restart = PolicyRestart{"mine", 8.4, "crashed", " in decide()"};
  failed.failed_policy = FailedPolicy{9.1, "mine: it hangs"};
  EXPECT_EQ(joint_ending({well, crashed, failed}).sentence,
            "all 3 robots flew as planned; robot 2: the policy crashed and was started once more; robot 3: "
            "the policy failed, and the fallback took over");
}

}  // namespace
}  // namespace karst::evaluation
