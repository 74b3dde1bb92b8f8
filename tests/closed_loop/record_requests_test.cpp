// A flight whose requests are recorded, and what a replay of them says.
#include "tests/closed_loop/command.h"

namespace karst {
namespace {

std::string fly_recorded(const std::filesystem::path& run, const std::string& more) {
  const Output out =
      run_karst("fly --cave " + generated_cave("small", 7) +
                " --policy nearest_frontier --set mission.max_flight_time=45s --quiet --no-report "
                "--record-requests --out " +
                run.string() + more);
  EXPECT_TRUE(out.code == 0 || out.code == 2) << out.text;
  return bytes_of(run / "requests.bin");
}

TEST(RecordRequests, ReplayAnswersAsInFlight) {
  const auto dir = fresh_folder("record_requests");
  const std::string first = fly_recorded(dir / "run", "");
  ASSERT_GT(first.size(), 10'000u);
  EXPECT_EQ(fly_recorded(dir / "again", " --threads 1"), first)
      << "the record is the same bytes in every replay";

  const Output same = run_karst("policy replay " + (dir / "run").string() + " --expect-same");
  EXPECT_EQ(same.code, 0) << same.text;
  EXPECT_TRUE(same.says(", 0 different")) << same.text;
  EXPECT_FALSE(same.says("\n0 decisions")) << same.text;

  const Output other =
      run_karst("policy replay " + (dir / "run/requests.bin").string() + " --expect-same --set turn_cost=60");
  EXPECT_EQ(other.code, 2) << other.text;
  EXPECT_TRUE(other.says("DIFFERS") && other.says("recorded: ")) << other.text;
  EXPECT_EQ(run_karst("policy replay " + (dir / "run/requests.bin").string() +
                      " --expect-same --set policy.parameters.turn_cost=60")
                .text,
            other.text)
      << "as karst fly names it";

  const Output part = run_karst("policy replay " + (dir / "run").string() + " --from 3 --to 5 --expect-same");
  EXPECT_EQ(part.code, 0) << part.text;
  EXPECT_TRUE(part.says("3 decisions of nearest_frontier 1.0.0, 3 as recorded, 0 different")) << part.text;

  EXPECT_EQ(run_karst("policy replay " + (dir / "run").string() + " --from 5 --to 3").code, 1);
  std::ofstream(dir / "cut.bin", std::ios::binary) << first.substr(0, first.size() / 2);
  const Output cut = run_karst("policy replay " + (dir / "cut.bin").string());
  EXPECT_EQ(cut.code, 0) << cut.text;
  EXPECT_TRUE(cut.says("its last record is cut short")) << cut.text;
  const Output nothing = run_karst("policy replay " + (dir / "run").string() + " --from 9999 --expect-same");
  EXPECT_EQ(nothing.code, 1) << "a comparison of nothing is no proof";
  EXPECT_TRUE(nothing.says("no decision was compared")) << nothing.text;

  EXPECT_TRUE(run_karst("policy replay " + (dir / "run").string() + " --policy highest_frontier")
                  .says("decisions of highest_frontier"));
}

/// The exit code as the shell reports it: 128 and the number of the signal that ended the process.
Output ended(const std::string& arguments) {
  return run_command("{ " KARST_BINARY_DIR "/bin/karst " + arguments + "; echo ended with $?; }");
}

// As it was: nothing said who had crashed, and where.
TEST(RecordRequests, ACrashInProcessIsNamedAndItsRequestIsKept) {
  const auto dir = fresh_folder("record_requests_crash");
  const std::string plugin = " --plugin " KARST_BINARY_DIR "/tests/plugins/crash_later.so",
                    says = "karst: the policy plain crashed in decide(), request 3 (SIGSEGV)\n";
  const Output flight =
      ended("fly --cave " + generated_cave("small", 7) + " --policy plain" + plugin +
            " --set policy.isolation=in_process --set mission.max_flight_time=45s --quiet --no-report"
            " --record-requests --out " +
            (dir / "run").string());
  EXPECT_TRUE(flight.says(says)) << flight.text;
  EXPECT_TRUE(flight.says("ended with 139")) << flight.text;

  const std::string replay = "policy replay " + (dir / "run").string() + plugin;
  const Output before = run_karst(replay + " --to 2 --expect-same");
  EXPECT_EQ(before.code, 0) << before.text;
  EXPECT_TRUE(before.says("2 decisions of plain 1.2.3, 2 as recorded, 0 different")) << before.text;
  EXPECT_FALSE(before.says("cut short")) << before.text;
  const Output again = ended(replay);
  EXPECT_TRUE(again.says(says)) << "the request that it crashed on is there\n" << again.text;
  EXPECT_TRUE(again.says("ended with 139")) << again.text;
}

TEST(RecordRequests, ADecisionIsExplainedWithItsWholeList) {
  const auto dir = fresh_folder("explain");
  const std::string run = (dir / "run").string();
  fly_recorded(run, "");
  std::istringstream lines(bytes_of(dir / "run/events.jsonl"));
  std::string t_s;  // of the first decision with goals: its line begins with {"t":
  for (std::string line; t_s.empty() && std::getline(lines, line);)
    if (line.find("\"kind\":\"decision\"") != std::string::npos &&
        line.find("\"outcome\":\"goals\"") != std::string::npos)
      t_s = line.substr(5, line.find(',') - 5);
  ASSERT_FALSE(t_s.empty());
  const Output whole = run_karst("explain " + run + " --at " + t_s);
  EXPECT_EQ(whole.code, 0) << whole.text;
  for (const char* part : {"Decision ", ", phase explore, by nearest_frontier: goals",
                           " offered:", "Request ", "best first:", "   1  score "})
    EXPECT_TRUE(whole.says(part)) << part << " in:\n" << whole.text;
  EXPECT_FALSE(whole.says("that were tried")) << "they stand in the whole list\n" << whole.text;
  const Output list = run_karst("explain " + run);
  EXPECT_EQ(list.code, 0) << list.text;
  EXPECT_TRUE(list.says(" decisions") && list.says("`karst explain " + run + " --at ")) << list.text;
  EXPECT_EQ(run_karst("report " + run).code, 0);
  EXPECT_NE(bytes_of(dir / "run/report.html").find("\"recorded\":true"), std::string::npos)
      << "the report has the list, too";
  std::filesystem::remove(dir / "run/requests.bin");
  const Output events = run_karst("explain " + run + " --at " + t_s);
  EXPECT_EQ(events.code, 0) << events.text;
  EXPECT_TRUE(events.says("fly with --record-requests")) << events.text;

  const Output early = run_karst("explain " + run + " --at 0"),
               late = run_karst("explain " + run + " --at 59:00"),
               wrong = run_karst("explain " + run + " --at soon");
  EXPECT_EQ(late.code, 0) << late.text;
  EXPECT_TRUE(late.says("The flight ended at ") && late.says("Its last decision:")) << late.text;
  EXPECT_FALSE(events.says("The flight ended at")) << events.text;
  EXPECT_EQ(early.code, 1);
  EXPECT_TRUE(early.says("--at 0: no decision had been made by then")) << early.text;
  EXPECT_EQ(wrong.code, 1);
  EXPECT_TRUE(wrong.says("--at: soon: expected a time such as 1:34")) << wrong.text;
  EXPECT_EQ(run_karst("explain /no/such/run --at 1:00").code, 1);
}

TEST(RecordRequests, BadInputIsNamed) {
  const auto dir = fresh_folder("record_requests_bad");
  const Output none = run_karst("policy replay " + dir.string());
  EXPECT_EQ(none.code, 1);
  EXPECT_TRUE(none.says("fly with --record-requests")) << none.text;
  std::ofstream(dir / "requests.bin") << "not what it says it is, by far";
  const Output wrong = run_karst("policy replay " + dir.string());
  EXPECT_EQ(wrong.code, 1);
  EXPECT_TRUE(wrong.says("requests.bin") && wrong.says("no record of requests")) << wrong.text;
  EXPECT_EQ(run_karst("policy replay /no/such/run").code, 1);
}

}  // namespace
}  // namespace karst
