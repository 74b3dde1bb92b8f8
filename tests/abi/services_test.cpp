// Every service through the border, from a plugin in C++.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "sdk/abi/karst_abi.h"
#include "tests/abi/room.h"

namespace karst::test {
namespace {

std::vector<double> answers(core::Decision d) {
  std::vector<double> out;
  for (const core::Goal& g : d.goals) out.push_back(std::stod(g.why));
  return out;
}

TEST(Services, AnswerAsTheRoomIsBuilt) {
  Room room;
  const auto policy = load("inquisitive", "inquisitive");
  const core::Decision d = policy->decide(room.request);
  const std::vector<double> said = answers(d);
  ASSERT_EQ(said.size(), 38u);
  EXPECT_EQ(said[0], 1000) << "free cells: 10 x 10 x 10";
  EXPECT_EQ(said[1], 12 * 12 * 12 - 1000 - 4) << "occupied cells: the shell without the window";
  EXPECT_EQ(said[2], 1) << "the corner inside is free";
  EXPECT_DOUBLE_EQ(said[3], 9.0) << "a ray along the floor passes to its end";
  EXPECT_EQ(said[4], 0) << "no unknown cell in the corner";
  EXPECT_EQ(said[5], 6 * 100 - 4) << "walls that face the room, without the window";
  EXPECT_EQ(said[6], 1) << "one LiDAR";
  EXPECT_GE(said[7], 4) << "the window's own cells at the least";
  EXPECT_EQ(said[8], 0) << "no way to where it is";
  EXPECT_GE(said[9], 0);
  EXPECT_LT(said[9], 1);
  EXPECT_EQ(said[10], 1000) << "the copy";
  EXPECT_EQ(said[11], 0.5) << "of the battery";
  EXPECT_EQ(said[12], 400) << "seconds of battery";
  EXPECT_EQ(said[13], 1800) << "seconds of the mission";
  EXPECT_EQ(said[14], 3) << "no rock within the limit";
  EXPECT_EQ(said[15], 5) << "to the walls";
  EXPECT_EQ(said[16], 2) << "a straight line to the window";
  EXPECT_EQ(said[17], 3);
  EXPECT_EQ(said[18], 2) << "to the window's unknown cells";
  EXPECT_NEAR(said[19], 3 / 1.6 + 1.6 / 2, 1e-5) << "cruising at 0.8 of 2 m/s";
  EXPECT_GE(said[20], 2);
  EXPECT_GE(said[21], std::sqrt(3 * 4 * 4) - 1e-4) << "into the corner";
  EXPECT_LE(said[21], 1.3 * std::sqrt(3 * 4 * 4));
  EXPECT_NEAR(said[22], 2, 1e-9) << "where it ends: two walls, a floor";
  EXPECT_EQ(said[24], 0) << "no way out of the room";
  EXPECT_TRUE(std::isinf(said[25]));
  EXPECT_EQ(said[26], 0);
  EXPECT_TRUE(std::isinf(said[27]));
  EXPECT_EQ(said[28], 1) << "the room is one passage";
  EXPECT_NEAR(said[29], 15, 2) << "across it";
  EXPECT_NEAR(said[30], 8, 1);
  EXPECT_EQ(said[31], 1000) << "m^3";
  EXPECT_EQ(said[32], KARST_PASSAGE_DEAD_END);
  EXPECT_EQ(said[33], KARST_PASSAGE_DEAD_END) << "the window is in its side";
  EXPECT_EQ(said[34], 0) << "the vehicle is in that passage";
  EXPECT_NEAR(said[35], 10, 0.1) << "from wall to wall";
  EXPECT_EQ(said[36], 1) << "nothing is known there";
  EXPECT_EQ(said[37], 1000) << "of the copy";
  ASSERT_EQ(d.drawings.size(), 3u);
  EXPECT_EQ(d.drawings[0].rgb, 0x123456u);
  EXPECT_EQ(d.drawings[1].points.size(), 2u);
  EXPECT_EQ(d.drawings[2].text, "here");
  EXPECT_EQ(d.log, std::vector<std::string>{"asked everything"});
}

TEST(Services, RetainedMapDoesNotChangeWithTheCoresMap) {
  Room room;
  const auto policy = load("inquisitive", "inquisitive");
  policy->decide(room.request);
  room.map.assign({40, 40, 40}, 4, -2.0f);
  const std::vector<double> said = answers(policy->decide(room.request));
  EXPECT_EQ(said[0], 1064);
  EXPECT_EQ(said[10], 1000);
  EXPECT_EQ(said[37], 1000) << "and its passages stay";
}

TEST(Services, ChanceDependsOnTheMissionsSeedOnly) {
  const auto draws = [](std::uint64_t seed) {
    Room room;
    host::PolicyChoice c = choice_of("inquisitive");
    c.seed = seed;
    const auto policy = load("inquisitive", c);
    return std::pair(answers(policy->decide(room.request))[9], answers(policy->decide(room.request))[9]);
  };
  EXPECT_EQ(draws(1), draws(1));
  EXPECT_NE(draws(1), draws(2));
  EXPECT_NE(draws(1).first, draws(1).second);
}

}  // namespace
}  // namespace karst::test
