#include "core_stack/planning/trajectory/join.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace karst::core {
namespace {

std::vector<Vec3> line(const Vec3& from, const Vec3& to) {
  std::vector<Vec3> points;
  const int n = static_cast<int>(std::lround((to - from).norm() / 0.1));
  for (int i = 0; i <= n; ++i) points.push_back(from + (to - from) * i / n);
  return points;
}

double sharpest_turn_rad(const std::vector<Vec3>& points) {
  double most = 0;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Vec3 a = points[i] - points[i - 1], b = points[i + 1] - points[i];
    if (a.norm() > 1e-9 && b.norm() > 1e-9) most = std::max(most, std::atan2(a.cross(b).norm(), a.dot(b)));
  }
  return most;
}

const auto everywhere = [](const Vec3&, const Vec3&) { return true; };
const auto always = [](const std::vector<Vec3>&, const std::vector<Vec3>&) { return true; };

TEST(JoinPaths, ACornerBecomesACurveThatPassesItClosely) {
  const std::vector<Vec3> committed = line({0, 0, 0}, {3, 0, 0}),
                          path = line({3, 0, 0}, {3 + 3 * std::cos(0.4), 3 * std::sin(0.4), 0});
  const std::vector<Vec3> joined = join_paths(committed, path, 0.3, everywhere, always);
  EXPECT_LT(sharpest_turn_rad(joined), 0.03);
  EXPECT_EQ(joined.front(), committed.front());
  EXPECT_EQ(joined.back(), path.back());
  double nearest = 1e9;
  for (const Vec3& p : joined) nearest = std::min(nearest, (p - committed.back()).norm());
  EXPECT_LT(nearest, 0.3);
}

TEST(JoinPaths, WhereNoCurveIsClearTheCornerStays) {
  const std::vector<Vec3> committed = line({0, 0, 0}, {3, 0, 0}), path = line({3, 0, 0}, {3, 3, 0});
  const auto nowhere = [](const Vec3&, const Vec3&) { return false; };
  EXPECT_EQ(join_paths(committed, path, 0.3, nowhere, always).size(), committed.size() + path.size() - 1);
}

TEST(JoinPaths, NeverLeavesWhatIsClear) {
  // A pillar inside of the bend: only short curves pass it.
  const Vec3 pillar(2.6, 0.4, 0);
  const auto clear = [&](const Vec3& a, const Vec3& b) {
    return (a - pillar).norm() > 0.35 && (b - pillar).norm() > 0.35;
  };
  const std::vector<Vec3> joined =
      join_paths(line({0, 0, 0}, {3, 0, 0}), line({3, 0, 0}, {3, 3, 0}), 0.3, clear, always);
  EXPECT_LT(sharpest_turn_rad(joined), 1.0);
  for (std::size_t i = 1; i < joined.size(); ++i) EXPECT_TRUE(clear(joined[i - 1], joined[i])) << i;
}

TEST(JoinPaths, ACurveWithWhichThePathCannotBeFlownIsNotTaken) {
  const std::vector<Vec3> committed = line({0, 0, 0}, {3, 0, 0}), path = line({3, 0, 0}, {0, 0.5, 0});
  const auto reaches = [](const std::vector<Vec3>& points) {
    double most = 0;
    for (const Vec3& p : points) most = std::max(most, p.x());
    return most;
  };
  EXPECT_LT(reaches(join_paths(committed, path, 0.3, everywhere, always)), 2.8);
  const auto late = [&](const std::vector<Vec3>& points, const std::vector<Vec3>&) {
    return reaches(points) > 2.8;
  };
  EXPECT_GT(reaches(join_paths(committed, path, 0.3, everywhere, late)), 2.8);
  const auto never = [](const std::vector<Vec3>&, const std::vector<Vec3>&) { return false; };
  EXPECT_EQ(join_paths(committed, path, 0.3, everywhere, never).size(), committed.size() + path.size() - 1);
}

TEST(JoinPaths, AShortLeadOrATurnBackIsLeftAlone) {
  const std::vector<Vec3> path = line({3, 0, 0}, {0, 0.2, 0});
  EXPECT_EQ(join_paths({{3, 0, 0}}, path, 0.3, everywhere, always).size(), path.size());
  const std::vector<Vec3> committed = line({0, 0, 0}, {3, 0, 0});
  const std::vector<Vec3> joined = join_paths(committed, path, 0.3, everywhere, always);
  double nearest = 1e9;
  for (const Vec3& p : joined) nearest = std::min(nearest, (p - committed.back()).norm());
  EXPECT_LE(nearest, 0.3) << "the goal that was turned back at";
}

}  // namespace
}  // namespace karst::core
