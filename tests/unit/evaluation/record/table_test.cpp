#include "sdk/evaluation/record/table.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sdk/evaluation/record/poses.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::evaluation {
namespace {

using test::TemporaryDirectory;

TEST(Table, GivesColumnsByNameWhateverTheirOrder) {
  TemporaryDirectory dir;
  dir.write("a.csv", "b,phase,a\n1,go,2\n3,stop,4.5\n");
  std::vector<std::string> problems;
  const Table t = read_table(dir.path() / "a.csv", {"phase"}, problems);
  EXPECT_TRUE(problems.empty());
  ASSERT_EQ(t.rows, 2u);
  EXPECT_EQ(*t.column("a"), (std::vector<double>{2, 4.5}));
  EXPECT_EQ(*t.column("b"), (std::vector<double>{1, 3}));
  EXPECT_EQ(t.text.at("phase"), (std::vector<std::string>{"go", "stop"}));
  EXPECT_EQ(t.column("c"), nullptr);
}

TEST(Table, NamesFileLineAndColumnOfWhatItLeavesOut) {
  TemporaryDirectory dir;
  dir.write("a.csv", "x,y\n1,2\n3,oops\n4\n5,6\n7,8");
  std::vector<std::string> problems;
  const Table t = read_table(dir.path() / "a.csv", {}, problems);
  EXPECT_EQ(*t.column("x"), (std::vector<double>{1, 5}));
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_EQ(problems[0], "a.csv: line 6: cut off; only the lines before it are used");
  EXPECT_EQ(problems[1],
            "a.csv: line 3: column y: \"oops\" is not a number (and 1 more such lines); left out");
}

TEST(Table, ReadsEmptyCellsAndNanAsNotKnown) {
  TemporaryDirectory dir;
  dir.write("a.csv", "x,y\r\n,nan\r\n1,inf\r\n");
  std::vector<std::string> problems;
  const Table t = read_table(dir.path() / "a.csv", {}, problems);
  EXPECT_TRUE(problems.empty());
  EXPECT_TRUE(std::isnan((*t.column("x"))[0]));
  EXPECT_TRUE(std::isnan((*t.column("y"))[0]));
  EXPECT_TRUE(std::isinf((*t.column("y"))[1]));
}

TEST(Table, OfAnAbsentFileIsEmptyWithoutComplaint) {
  std::vector<std::string> problems;
  EXPECT_EQ(read_table("/nowhere/a.csv", {}, problems).rows, 0u);
  EXPECT_TRUE(problems.empty());
}

TEST(Poses, AreReadAndBadLinesNamed) {
  TemporaryDirectory dir;
  dir.write(
      "t.tum",
      "# comment\n0 1 2 3 0 0 0 1\n1 2 2 3 0 0 0 1\n1.5 nan 2 3 0 0 0 1\n2 3 2 3 0 0 0 9\n0.5 0 0 0 0 0 0 1\n"
      "3 4 2 3 0 0 1 0\n");
  std::vector<std::string> problems;
  const auto poses = read_tum(dir.path() / "t.tum", problems);
  ASSERT_EQ(poses.size(), 3u);
  EXPECT_EQ(poses[2].T_world_body.position, core::Vec3(4, 2, 3));
  EXPECT_NEAR(std::abs(core::heading_of(poses[2].T_world_body.orientation)), std::numbers::pi, 1e-12);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0], "t.tum: line 4: is not eight numbers (and 2 more such lines); left out");
}

TEST(Poses, InterpolateLinearlyAndHoldAtTheEnds) {
  const std::vector<StampedPose> poses{{1, {core::Vec3(0, 0, 0), core::from_heading(0)}},
                                       {3, {core::Vec3(4, 0, 2), core::from_heading(1)}}};
  EXPECT_EQ(pose_at(poses, 0).position, core::Vec3(0, 0, 0));
  EXPECT_TRUE(pose_at(poses, 1.5).position.isApprox(core::Vec3(1, 0, 0.5)));
  EXPECT_NEAR(core::heading_of(pose_at(poses, 1.5).orientation), 0.25, 1e-12);
  EXPECT_EQ(pose_at(poses, 9).position, core::Vec3(4, 0, 2));
}

TEST(Poses, PathLengthCountsOnlyWhatLiesWithinTheTimes) {
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 10; ++i)
    poses.push_back({double(i), {core::Vec3(3.0 * i, 4.0 * i, 0), core::Quat::Identity()}});
  EXPECT_NEAR(path_length_m(poses, 0, 10), 50, 1e-12);
  EXPECT_NEAR(path_length_m(poses, 2, 5), 15, 1e-12);
}

}  // namespace
}  // namespace karst::evaluation
