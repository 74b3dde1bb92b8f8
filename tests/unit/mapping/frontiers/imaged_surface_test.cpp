#include "core_stack/mapping/frontiers/imaged_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "core_stack/common/random.h"

namespace karst::core {
namespace {

constexpr float kFree = -2.0f, kRock = 2.0f;
constexpr CellKey kSides[] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};

RgbCameraModel camera(double fov_rad = 1.4, float range_m = 6, double incidence_rad = 1.2) {
  RgbCameraModel m;
  m.camera.width = 320, m.camera.height = 240;
  m.camera.horizontal_fov_rad = fov_rad;
  m.camera.vertical_fov_rad = 0.75 * fov_rad;
  m.camera.min_range_m = 0.3f;
  m.camera.max_range_m = static_cast<float>(range_m);
  m.max_incidence_rad = incidence_rad;
  return m;
}

/// Free space from x = 0 to 4 m before a wall at x = 4 m that fills y and z from -8 to 8 m.
VoxelMap wall() {
  VoxelMap map{MapOptions{}};
  for (int y = -40; y < 40; ++y)
    for (int z = -40; z < 40; ++z) {
      for (int x = -2; x < 20; ++x) map.assign({x, y, z}, 1, kFree);
      map.assign({20, y, z}, 1, kRock);
    }
  return map;
}

// The rules once more, slowly: every cell of the map against the segment, as boxes.

bool passes(const Vec3& from, const Vec3& to, const CellKey& k, double edge) {
  double enter = 0, leave = 1;
  const double low[3] = {k.x * edge, k.y * edge, k.z * edge};
  for (int a = 0; a < 3; ++a) {
    const double d = to[a] - from[a];
    if (std::abs(d) < 1e-12) {
      if (from[a] < low[a] || from[a] > low[a] + edge) return false;
      continue;
    }
    const double t0 = (low[a] - from[a]) / d, t1 = (low[a] + edge - from[a]) / d;
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  return leave > enter + 1e-12;
}

bool imaged_by_the_book(const VoxelMap& map, int side, const Pose& T, const RgbCameraModel& m,
                        const CellKey& k) {
  if (map.at(k) != Cell::occupied) return false;
  Vec3 normal = Vec3::Zero();
  bool surface = false;
  for (const CellKey& s : kSides) surface |= map.at(k + s) == Cell::free;
  for (int i = 0; i < 125; ++i) {
    const CellKey d{i % 5 - 2, i / 5 % 5 - 2, i / 25 - 2};
    if (map.at(k + d) == Cell::free)
      normal += Vec3(d.x, d.y, d.z) / std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
  }
  if (!surface) return false;
  const double edge = map.resolution_m();
  const Vec3 center = map.center_of(k), back = T.position - center;
  if (normal.norm() > 1e-9 &&
      std::acos(std::clamp(normal.dot(back) / normal.norm() / back.norm(), -1.0, 1.0)) > m.max_incidence_rad)
    return false;
  for (const CellKey& s : kSides) {
    if (map.at(k + s) != Cell::free) continue;
    const Vec3 out(s.x, s.y, s.z), place = center + 0.55 * edge * out, away = place - T.position;
    if (out.dot(away) >= 0) continue;
    const Vec3 p = T.orientation.toRotationMatrix().transpose() * away;
    if (away.norm() < static_cast<double>(m.camera.min_range_m) ||
        away.norm() > static_cast<double>(m.camera.max_range_m))
      continue;
    if (p.x() <= 0 || std::atan2(std::abs(p.y()), p.x()) > m.camera.horizontal_fov_rad / 2 ||
        std::atan2(std::abs(p.z()), p.x()) > m.camera.vertical_fov_rad / 2)
      continue;
    bool blocked = false;
    for (int z = -1; z <= side && !blocked; ++z)
      for (int y = -1; y <= side && !blocked; ++y)
        for (int x = -1; x <= side && !blocked; ++x)
          blocked = map.at(CellKey{x, y, z}) != Cell::free && passes(T.position, place, {x, y, z}, edge);
    if (!blocked) return true;
  }
  return false;
}

TEST(ImagedSurface, IsThatOfTheRulesAppliedCellByCell) {
  constexpr int kSide = 12;
  Random random(11);
  std::size_t imaged = 0, surface = 0;
  for (int world = 0; world < 30; ++world) {
    VoxelMap map{MapOptions{}};
    const int rock = 2 + 3 * (world % 4);
    for (int i = 0; i < kSide * kSide * kSide; ++i) {
      const CellKey k{i % kSide, i / kSide % kSide, i / kSide / kSide};
      const auto p = static_cast<int>(random.uniform(0, 100));
      if (p < 99) map.assign(k, 1, p < rock ? kRock : kFree);  // the rest is unknown
    }
    Pose T;
    do T.position = {random.uniform(0.3, 2.1), random.uniform(0.3, 2.1), random.uniform(0.3, 2.1)};
    while (map.at(T.position) != Cell::free);
    T.orientation = Quat(random.normal(), random.normal(), random.normal(), random.normal()).normalized();
    const RgbCameraModel m = camera(1.6, 2.5, world % 2 ? 1.2 : 0.8);
    ImagedSurface account;
    account.take(map, T, m);
    const std::vector<CellKey> cells = account.cells();
    const std::set<CellKey> taken(cells.begin(), cells.end());
    const ImagedSurface none;
    const UnimagedSurface unimaged(map, none);
    std::set<CellKey> looked;
    for (const std::uint32_t i : unimaged.seen_from(T, m)) looked.insert(unimaged.cells()[i].key);
    EXPECT_EQ(taken, looked) << "a picture adds what was foreseen";
    for (int i = 0; i < kSide * kSide * kSide; ++i) {
      const CellKey k{i % kSide, i / kSide % kSide, i / kSide / kSide};
      const bool expected = imaged_by_the_book(map, kSide, T, m, k);
      ASSERT_EQ(taken.count(k) > 0, expected) << world << ": " << k.x << " " << k.y << " " << k.z;
      if (const auto cell = surface_cell(map, k)) {
        ++surface;
        ASSERT_EQ(images(map, T, m, *cell), expected);
      }
    }
    imaged += taken.size();
  }
  EXPECT_GT(imaged, 100u) << "the test looks at something";
  EXPECT_GT(surface, 3 * imaged);
}

TEST(ImagedSurface, OfAWallIsTheDiscWithinRangeAndIncidence) {
  const VoxelMap map = wall();
  const Pose T{{1.0, 0.01, 0.013}, Quat::Identity()};
  const double incidence = 0.7;
  ImagedSurface account;
  account.take(map, T, camera(2.5, 6, incidence));
  const double radius = 2.9 * std::tan(incidence);  // the wall's cells have their centres 3.1 m ahead
  for (int y = -30; y < 30; ++y)
    for (int z = -30; z < 30; ++z) {
      const double away = std::hypot(0.2 * (y + 0.5) - 0.01, 0.2 * (z + 0.5) - 0.013);
      const bool in = account.cells().size() > 0 && !account.contains({20, y, z});
      if (away < radius - 0.3) {
        EXPECT_FALSE(in) << y << " " << z;
      }
      if (away > radius + 0.6) {
        EXPECT_TRUE(in) << y << " " << z;
      }
    }
}

TEST(ImagedSurface, WhatIsNotFreeHidesTheWallWhetherRockOrUnknown) {
  for (const bool rock : {true, false}) {
    VoxelMap map = wall();
    const Pose T{{1.1, 0.1, 0.1}, Quat::Identity()};
    ImagedSurface before, after;
    before.take(map, T, camera());
    EXPECT_TRUE(before.contains({20, 0, 0}));
    for (int y = -2; y <= 2; ++y)
      for (int z = -2; z <= 2; ++z) map.assign({10, y, z}, 1, rock ? kRock : 0.0f);
    if (!rock) {  // a map has no way to forget: a world with a hole in it
      VoxelMap holed{MapOptions{}};
      map.for_each_known([&](const CellKey& k, Cell, float l) {
        if (k.x != 10 || std::abs(k.y) > 2 || std::abs(k.z) > 2) holed.assign(k, 1, l);
      });
      map = std::move(holed);
    }
    after.take(map, T, camera());
    EXPECT_FALSE(after.contains({20, 0, 0}));
    EXPECT_TRUE(after.contains({20, 12, 0}));
  }
}

TEST(ImagedSurface, OneCellBesideCountsAndTwoDoNot) {
  const std::vector<CellKey> one{{5, 5, 5}};
  const ImagedSurface account{std::span<const CellKey>(one)};
  EXPECT_TRUE(account.contains({5, 5, 5}));
  EXPECT_TRUE(account.contains({5, 6, 5}));
  EXPECT_FALSE(account.contains({6, 6, 5}));
  EXPECT_FALSE(account.contains({5, 7, 5}));
}

TEST(ImagedSurface, ASnapshotsFlatFormHoldsAll) {
  const VoxelMap map = wall();
  ImagedSurface account;
  account.take(map, {{1, 0, 0}, Quat::Identity()}, camera());
  const std::vector<CellKey> flat = account.cells();
  ASSERT_GT(flat.size(), 100u);
  EXPECT_TRUE(std::is_sorted(flat.begin(), flat.end()));
  const UnimagedSurface a(map, account), b(map, ImagedSurface(flat));
  EXPECT_EQ(a.cells().size(), b.cells().size());
  EXPECT_EQ(a.surface_cells(), b.surface_cells());
  EXPECT_LT(a.cells().size() + flat.size(), a.surface_cells() + 1)
      << "cells beside imaged ones count as well";
}

TEST(ImagedSurface, PosesThatAreNoneAddNothing) {
  const VoxelMap map = wall();
  ImagedSurface account;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(account.take(map, {{nan, 0, 0}, Quat::Identity()}, camera()), 0u);
  EXPECT_EQ(account.take(map, {{1e9, 0, 0}, Quat::Identity()}, camera()), 0u);
  EXPECT_EQ(account.take(map, {{4.5, 0, 0}, Quat::Identity()}, camera()), 0u) << "from behind the wall";
  EXPECT_EQ(account.size(), 0u);
}

}  // namespace
}  // namespace karst::core
