// Which legs lie on a loop, against what is still connected without them.
#include "sdk/survey/loop_legs.h"

#include <random>

#include "sdk/survey/place_sets.h"
#include "tests/unit/survey/adjusted_surveys.h"

namespace karst::survey {
namespace {

std::vector<bool> found(Readings readings) {
  const Network network = network_of(readings);
  return legs_on_loops(readings, network);
}
using test::kNormal;
using Found = std::vector<bool>;

TEST(LoopLegs, ALegToALoopAndOneBetweenTwoLoopsAreOnNone) {
  EXPECT_EQ(found(test::readings_of(kNormal + "1 2 9 0 0\n2 3 9 120 0\n3 1 9 240 0\n3 4 9 0 0\n"
                                              "4 5 9 0 0\n5 6 9 120 0\n6 4 9 240 0\n6 7 9 0 0\n")),
            (Found{true, true, true, false, true, true, true, false}));
}

TEST(LoopLegs, TwoLegsBetweenTheSameStationsAreALoop) {
  EXPECT_EQ(found(test::readings_of(kNormal + "1 2 9 0 0\n2 1 9 180 0\n2 3 9 0 0\n")),
            (Found{true, true, false}));
}

TEST(LoopLegs, FixedPlacesCountAsOne) {
  EXPECT_EQ(
      found(test::readings_of("fix 1 0 0 0\nfix 3 0 18 0\n" + kNormal + "1 2 9 0 0\n2 3 9 0 0\n3 4 9 0 0\n")),
      (Found{true, true, false}));
}

TEST(LoopLegs, LegsThatWereNotMeasuredCloseNone) {
  EXPECT_EQ(found(test::readings_of(kNormal + "1 2 9 0 0\n2 3 9 0 0\ndata nosurvey from to\n3 1\n")),
            (Found{false, false, true}));
}

TEST(LoopLegs, ALegLiesOnALoopIfItsEndsAreConnectedWithoutIt) {
  std::mt19937 random(1);
  for (int round = 0; round < 50; ++round) {
    std::string text = round % 2 == 0 ? "fix 0 0 0 0\nfix 5 1 1 1\n" : "";
    for (const char* data : {"data normal from to length compass clino\n", "data nosurvey from to\n"}) {
      text += data;
      const bool measured = text.ends_with("clino\n");
      for (int i = 0; i < (measured ? 22 : 4); ++i) {
        const auto from = random() % 20, to = (from + 1 + random() % 19) % 20;
        text += std::to_string(from) + " " + std::to_string(to) + (measured ? " 9 0 0\n" : "\n");
      }
    }
    Readings readings = test::readings_of(text + kNormal + "0 5 9 0 0\n");
    const Network network = network_of(readings);
    const Found made = legs_on_loops(readings, network);
    ASSERT_EQ(made.size(), network.legs.size());
    for (std::size_t i = 0; i < made.size(); ++i) {
      const auto ends = [&](std::size_t leg) {
        const Reading& r = readings.legs[network.legs[leg]];
        return std::pair(network.place[r.from], network.place[r.to]);
      };
      PlaceSets without(network.stations.size());
      for (const std::uint32_t f : network.fixes)
        without.unite(network.place[readings.fixes[f].station],
                      network.place[readings.fixes[network.fixes.front()].station]);
      for (std::size_t k = 0; k < made.size(); ++k)
        if (k != i && readings.legs[network.legs[k]].style != Style::no_survey)
          without.unite(ends(k).first, ends(k).second);
      const bool connected = without.root(ends(i).first) == without.root(ends(i).second);
      const bool measured = readings.legs[network.legs[i]].style != Style::no_survey;
      EXPECT_EQ(made[i], connected || !measured) << round << ": leg " << i << " of\n" << text;
    }
  }
}

}  // namespace
}  // namespace karst::survey
