// A real system of 30 km: the Jean-Bernard, in ../shared/data/surveys (its README.md says whose it is).
#include <deque>
#include <map>

#include "sdk/survey/read_survey.h"
#include "tests/unit/survey/survey_files.h"

namespace karst::survey {
namespace {

const std::string kRoot = KARST_SOURCE_DIR "/../shared/data/surveys/jean_bernard/Data/jb.th";

/// Legs that no loop and no way between fixed stations moves: those that fall off when ends are cut again and
/// again.
std::vector<std::size_t> trailing_legs(const Survey& s) {
  std::vector<std::vector<std::size_t>> at(s.stations.size());
  for (std::size_t i = 0; i < s.legs.size(); ++i)
    for (const std::uint32_t end : {s.legs[i].from, s.legs[i].to}) at[end].push_back(i);
  std::vector<bool> cut(s.legs.size(), false);
  std::deque<std::uint32_t> ends;
  for (std::uint32_t i = 0; i < s.stations.size(); ++i) ends.push_back(i);
  std::vector<std::size_t> trailing;
  for (; !ends.empty(); ends.pop_front()) {
    const std::uint32_t end = ends.front();
    if (s.stations[end].fixed) continue;
    std::erase_if(at[end], [&](std::size_t leg) { return cut[leg]; });
    if (at[end].size() != 1) continue;
    const std::size_t leg = at[end].front();
    cut[leg] = true;
    trailing.push_back(leg);
    ends.push_back(s.legs[leg].from == end ? s.legs[leg].to : s.legs[leg].from);
  }
  return trailing;
}

core::Vec3 measured(const Leg& leg) {
  const double slope = leg.inclination_rad.value_or(0), bearing = leg.bearing_rad.value_or(0);
  const double level = leg.bearing_rad ? *leg.length_m * std::cos(slope) : 0;
  return {level * std::sin(bearing), level * std::cos(bearing), *leg.length_m * std::sin(slope)};
}

// Therion 6.1.6 counts 9247 stations, the ends of splays included, and 5066 with names, of which five are
// part of nothing that a leg ties; cavern counts 50 loops beside ten ways between the fixed stations.
TEST(JeanBernard, IsReadAsAWhole) {
  SKIP_WITHOUT_SURVEX();
  if (!std::filesystem::exists(kRoot)) GTEST_SKIP() << "skipped: no ../shared";
  const Survey s = read_survey(kRoot);
  std::size_t names = 0, entrances = 0;
  for (const Station& station : s.stations) {
    names += 1 + station.aliases.size();
    entrances += station.entrance ? 1 : 0;
  }
  EXPECT_EQ(names, 5061u);
  EXPECT_EQ(s.legs.size(), 5006u);
  EXPECT_EQ(s.splays.size(), 4185u);
  EXPECT_EQ(s.loops.count, 60u);
  EXPECT_GT(entrances, 5u);
  EXPECT_NEAR(length_m(s), 30'500, 200);
  EXPECT_TRUE(test::notes_say(s.notes, "drawings (.th2) are not read"));
  EXPECT_TRUE(test::notes_say(s.notes, "no input is called Data/AffluentC14/AffluentC14-tot.th"));
  EXPECT_TRUE(test::notes_say(s.notes, "no leg leads to Jean-Bernard.jb-amonts2.Ih.40"));
}

TEST(JeanBernard, LegsOutsideOfLoopsKeepTheirReadingsToTheCentimetre) {
  SKIP_WITHOUT_SURVEX();
  if (!std::filesystem::exists(kRoot)) GTEST_SKIP() << "skipped: no ../shared";
  const Survey s = read_survey(kRoot);
  const std::vector<std::size_t> trailing = trailing_legs(s);
  EXPECT_GT(trailing.size(), 500u);
  for (const std::size_t i : trailing) {
    const Leg& leg = s.legs[i];
    if (!leg.length_m) continue;
    const core::Vec3 adjusted = s.stations[leg.to].position_m - s.stations[leg.from].position_m;
    EXPECT_LT((adjusted - measured(leg)).norm(), 0.0175) << place_of(s, leg.source);
  }
}

TEST(JeanBernard, SectionsFaceLevelAndTheirRunsStandTogether) {
  SKIP_WITHOUT_SURVEX();
  if (!std::filesystem::exists(kRoot)) GTEST_SKIP() << "skipped: no ../shared";
  const Survey s = read_survey(kRoot);
  std::map<std::uint32_t, std::size_t> last_of_run;
  EXPECT_GT(s.sections.size(), 4000u);
  for (std::size_t i = 0; i < s.sections.size(); ++i) {
    const Section& section = s.sections[i];
    EXPECT_NEAR(section.facing.norm(), 1, 1e-9);
    EXPECT_EQ(section.facing.z(), 0);
    const auto it = last_of_run.find(section.run);
    if (it != last_of_run.end()) {
      EXPECT_EQ(it->second + 1, i) << section.run;
    }
    last_of_run[section.run] = i;
  }
}

}  // namespace
}  // namespace karst::survey
