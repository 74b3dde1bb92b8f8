// From a survey to a cave to a flight, by the commands alone.
#include <nlohmann/json.hpp>

#include "tests/closed_loop/command.h"
#include "tests/unit/survey/skip_without_survex.h"

namespace karst {
namespace {

TEST(SurveyFlight, ACaveMadeOfASurveyIsFlownAndLandedIn) {
  SKIP_WITHOUT_SURVEX();
  const auto folder = fresh_folder("survey_flight");
  std::ofstream(folder / "cave.th")
      << "survey cave\n  centreline\n    station 0 \"\" entrance\n"
         "    data normal from to tape compass clino left right up down\n"
         "    0 1 8 90 0 2 2 2 1\n    1 2 8 60 0 2 2 2 1\n    2 3 8 90 5 2 2 2 1\n"
         "    3 4 4 90 0 2 2 2 1\n"
         "  endcentreline\nendsurvey\n";
  const std::string out = (folder / "cave").string();
  const Output made = run_karst("cave from-survey " + out + ".th --out " + out);
  ASSERT_EQ(made.code, 0) << made.text;
  const Output info = run_karst("cave info " + out + ".info");
  EXPECT_EQ(info.code, 0) << info.text;
  EXPECT_TRUE(info.says("closed             yes")) << info.text;
  const Output flown = run_karst("fly --cave " + out +
                                 ".info --policy nearest_frontier --seed 1 --quiet "
                                 "--no-report --set mission.max_flight_time=60s --out " +
                                 (folder / "run").string());
  const auto m = nlohmann::json::parse(bytes_of(folder / "run" / "metrics.json"), nullptr, false);
  ASSERT_TRUE(m.is_object()) << flown.text;
  EXPECT_EQ(m["outcome"], "landed") << flown.text;
  EXPECT_EQ(m["contacts"], 0);
}

}  // namespace
}  // namespace karst
