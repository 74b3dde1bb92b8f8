// A vehicle's place in a map of earlier: found in the map of the same tunnel, refused in all others.
#include "core_stack/mapping/prior/earlier_map.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <map>

#include "core_stack/common/random.h"
#include "tests/unit/map_merge/tunnels.h"

namespace karst::core {
namespace {

using test::Tunnel;

std::shared_ptr<const EarlierMap> earlier(VoxelMap map) {
  return earlier_map_of("earlier.bt", std::make_shared<VoxelMap>(std::move(map)));
}

/// The tunnel's cells at p -> f(p), in cells of the new frame.
template <class F>
std::shared_ptr<const VoxelMap> seen_through(const VoxelMap& map, const F& into_map, const Vec3& low,
                                             const Vec3& high) {
  auto seen = std::make_shared<VoxelMap>(MapOptions{});
  const CellKey a = seen->key_of(low), b = seen->key_of(high);
  for (int z = a.z; z <= b.z; ++z)
    for (int y = a.y; y <= b.y; ++y)
      for (int x = a.x; x <= b.x; ++x) {
        const Cell cell = map.at(into_map(seen->center_of({x, y, z})));
        if (cell != Cell::unknown) seen->assign({x, y, z}, 1, cell == Cell::free ? -1.0f : 1.0f);
      }
  return seen;
}

const Vec3 kLow(-18, -18, -12), kHigh(18, 18, 12);
/// The vehicle sees 18 m of tunnel, turned by 2.2 rad.
const Pose kTruth{Vec3(16, 1, 0.4), from_heading(2.2)};  // two cells up: half cells would be rounded one way

std::shared_ptr<const VoxelMap> seen_in(const Tunnel& tunnel) {
  return seen_through(
      tunnel.map(7, 25), [](const Vec3& p) -> Vec3 { return kTruth * p; }, kLow, kHigh);
}

// Drawn once for all tests.
const Tunnel kTunnel{.phase = 0.4};
std::shared_ptr<const EarlierMap> same_tunnel() {
  static const auto map = earlier(kTunnel.map(0, 40));
  return map;
}
std::shared_ptr<const VoxelMap> seen_there() {
  static const auto seen = seen_in(kTunnel);
  return seen;
}

TEST(EarlierMap, ThePlaceIsFoundInTheMapOfTheSameTunnel) {
  const MapRegistration r = locate_in(*same_tunnel(), seen_there());
  ASSERT_TRUE(r.trusted) << r.reason;
  EXPECT_LT((r.T_target_source.position - kTruth.position).norm(), 0.02);
  EXPECT_LT(r.T_target_source.orientation.angularDistance(kTruth.orientation), 0.005);
  EXPECT_LT(r.surface_residual_m.value(), 0.04);
  const MapRegistration again = locate_in(*same_tunnel(), seen_there());
  EXPECT_EQ(again.T_target_source.position, r.T_target_source.position);
  EXPECT_EQ(again.T_target_source.orientation.coeffs(), r.T_target_source.orientation.coeffs());
}

/// Half a cell off, the steps of the cells of two maps in one frame fit, too.
TEST(EarlierMap, ThePlaceIsRightToCentimetresWhereTheCellsOfBothMapsFit) {
  const auto map = same_tunnel();
  for (const double begin : {3.0, 12.0}) {
    const auto seen = std::make_shared<VoxelMap>(kTunnel.map(begin, begin + 18));
    const MapRegistration r = locate_in(*map, seen);
    ASSERT_TRUE(r.trusted) << r.reason;
    const Vec3 place = kTunnel.centre(begin + 9);
    EXPECT_LT((r.T_target_source * place - place).norm(), 0.02) << begin;
  }
}

/// In a tunnel that hardly bends, other places fit within the cells nearly as well; but their surfaces lie
/// apart.
TEST(EarlierMap, ARivalThatItsSurfacesRefuteDoesNotCount) {
  const Tunnel tunnel{.phase = 0.4, .bend_m = 0.8, .knobs_m = 0.15};
  const auto map = earlier(tunnel.map(0, 40));
  const auto seen = seen_in(tunnel);
  const MapRegistration r = locate_in(*map, seen);
  ASSERT_TRUE(r.trusted) << r.reason;
  EXPECT_LT((r.T_target_source.position - kTruth.position).norm(), 0.02);
  MapRegistrationOptions all_are_rivals = localization_limits();
  all_are_rivals.limits.max_surface_residual_cells = 100;
  const MapRegistration refused = locate_in(*map, seen, all_are_rivals);
  EXPECT_TRUE(refused.reason.starts_with("another pose fits nearly as well")) << refused.reason;
  EXPECT_FALSE(
      locate_in(*earlier(Tunnel{.phase = 2, .bend_m = 0.8, .knobs_m = 0.15}.map(0, 40)), seen).trusted);
}

/// Passages that repeat: whichever it is in, another is as good.
TEST(EarlierMap, APlaceThatIsThereTwiceIsRefused) {
  VoxelMap twice = kTunnel.map(0, 26);
  kTunnel.map(0, 26).for_each_known([&](const CellKey& k, Cell, float value) {
    twice.assign(k + CellKey{0, 250, 0}, 1, value);
  });
  const MapRegistration r = locate_in(*earlier(std::move(twice)), seen_there());
  EXPECT_FALSE(r.trusted);
  EXPECT_TRUE(r.reason.starts_with("another pose fits nearly as well")) << r.reason;
}

/// "2 % stands in free space; at most 2 % may" says nothing.
TEST(EarlierMap, ARefusalNamesAFigureThatBreaksItsLimit) {
  const auto map = same_tunnel();
  const double overlap = locate_in(*map, seen_there()).overlay.overlap();
  MapRegistrationOptions just_refused = localization_limits();
  just_refused.limits.min_overlap = overlap + 1e-5;
  const std::string reason = locate_in(*map, seen_there(), just_refused).reason;
  double is = 0, must_be = 0;
  ASSERT_EQ(
      std::sscanf(reason.c_str(), "only %lf %% of the rock coincides; at least %lf %% must", &is, &must_be),
      2)
      << reason;
  EXPECT_LT(is, must_be) << reason;
}

TEST(EarlierMap, OtherTunnelsAreRefused) {
  for (const double phase : {2.0, 5.1}) {
    const MapRegistration r = locate_in(*earlier(Tunnel{.phase = phase}.map(0, 40)), seen_there());
    EXPECT_FALSE(r.trusted) << "phase " << phase;
    EXPECT_NE(r.reason, "");
  }
  const MapRegistration elsewhere = locate_in(*earlier(kTunnel.map(40, 80)), seen_there());
  EXPECT_FALSE(elsewhere.trusted) << "another part of it";
}

TEST(EarlierMap, AMirroredAndAScaledMapAreRefused) {
  const auto of = [&](const auto& into_map) {
    const auto map = seen_through(kTunnel.map(0, 40), into_map, Vec3(-5, -20, -12), Vec3(50, 20, 12));
    return locate_in(*earlier_map_of("m", map), seen_there());
  };
  ASSERT_TRUE(of([](const Vec3& p) -> Vec3 { return p; }).trusted) << "as it is";
  EXPECT_FALSE(of([](const Vec3& p) -> Vec3 { return {p.x(), -p.y(), p.z()}; }).trusted);
  EXPECT_FALSE(of([](const Vec3& p) -> Vec3 { return 0.85 * p; }).trusted);
}

TEST(EarlierMap, ASmoothTubeIsRefusedAsItSlides) {
  const Tunnel tube{.phase = 0, .bend_m = 0, .knobs_m = 0};
  EXPECT_FALSE(locate_in(*earlier(tube.map(0, 40)), seen_in(tube)).trusted);
}

TEST(EarlierMap, WithoutRockOrFreeSpaceItIsNone) {
  VoxelMap rock{MapOptions{}}, free{MapOptions{}};
  rock.assign({0, 0, 0}, 4, 1.0f);
  free.assign({0, 0, 0}, 4, -1.0f);
  EXPECT_THROW(earlier(std::move(rock)), std::invalid_argument);
  EXPECT_THROW(earlier(std::move(free)), std::invalid_argument);
  const auto nothing = std::make_shared<VoxelMap>(MapOptions{});
  EXPECT_EQ(locate_in(*earlier(Tunnel{}.map(0, 10)), nothing).reason, "no rock is seen");
}

TEST(EarlierMap, MovedCellsKeepAllRockAndInventNoFreeSpace) {
  const auto map = earlier(Tunnel{.phase = 1.0}.map(0, 12));
  const VoxelMap& from = *map->piece.cells;
  const MapOptions options;
  Random random(5);
  for (int i = 0; i < 4; ++i) {
    const Pose T{Vec3(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-2, 2)),
                 from_heading(random.uniform(-3, 3))};
    const std::vector<CellValue> cells = moved_cells(*map, T, options);
    std::map<CellKey, float> by_key;
    for (const CellValue& c : cells) EXPECT_TRUE(by_key.emplace(c.key, c.log_odds).second) << "twice";
    from.for_each_known([&](const CellKey& k, Cell cell, float) {
      if (cell != Cell::occupied) return;
      const auto there = by_key.find(from.key_of(T * from.center_of(k)));
      ASSERT_NE(there, by_key.end());
      EXPECT_GT(there->second, 0);
    });
    for (const auto& [key, log_odds] : by_key)
      if (log_odds < 0) {
        EXPECT_EQ(from.at(T.inverse() * from.center_of(key)), Cell::free);
      }
  }
}

/// What is seen now wins over what was seen earlier: a hit over free space, six clear scans over rock.
TEST(EarlierMap, OneHitOutweighsItsFreeCellsAndFewMissesItsRock) {
  const auto map = earlier(Tunnel{.phase = 1.0}.map(0, 6));
  VoxelMap now{MapOptions{}};
  now.fill_unknown(moved_cells(*map, Pose{}, {}));
  const CellKey free_cell = now.key_of(Tunnel{.phase = 1.0}.centre(3));
  ASSERT_EQ(now.at(free_cell), Cell::free);
  const Vec3f centre = now.center_of(free_cell).cast<float>();
  now.insert(std::vector<Ray>{{centre + Vec3f(0.6f, 0, 0), centre, true}});
  EXPECT_EQ(now.at(free_cell), Cell::occupied);

  const Vec3f rock = map->piece.surface[map->piece.surface.size() / 2];
  const CellKey rock_cell = now.key_of(rock.cast<double>());
  ASSERT_EQ(now.at(rock_cell), Cell::occupied);
  int scans = 0;
  for (; now.at(rock_cell) == Cell::occupied && scans < 50; ++scans)
    now.insert(std::vector<Ray>{{rock + Vec3f(0.5f, 0, 0), rock - Vec3f(0.5f, 0, 0), false}});
  EXPECT_GE(scans, 2) << "one grazing ray clears no rock";
  EXPECT_LE(scans, 6);
}

TEST(EarlierMap, FillsOnlyUnknownCells) {
  VoxelMap map{MapOptions{}};
  map.assign({0, 0, 0}, 1, 2.0f);
  map.assign({1, 0, 0}, 1, -1.0f);
  const std::vector<CellValue> cells = {
      {{2, 0, 0}, -0.4f}, {{0, 0, 0}, -0.4f}, {{1, 0, 0}, 1.0f}, {{-3, 0, 0}, 1.0f}, {{40000, 0, 0}, 1.0f}};
  const auto changes = map.fill_unknown(cells);
  ASSERT_EQ(changes.size(), 2u);
  EXPECT_EQ(changes[0].key, (CellKey{-3, 0, 0}));
  EXPECT_EQ(changes[0].after, Cell::occupied);
  EXPECT_EQ(changes[1].key, (CellKey{2, 0, 0}));
  EXPECT_EQ(changes[1].before, Cell::unknown);
  EXPECT_EQ(map.at(CellKey{0, 0, 0}), Cell::occupied);
  EXPECT_EQ(map.at(CellKey{1, 0, 0}), Cell::free);
  EXPECT_EQ(map.free_cells(), 2u);
  EXPECT_EQ(map.occupied_cells(), 2u);
}

TEST(EarlierMap, SurroundingsAreTheCellsOfTheBox) {
  const VoxelMap map = Tunnel{}.map(0, 30);
  const Vec3 place = Tunnel{}.centre(15);
  const auto near = surroundings(map, place, 5);
  std::size_t expected = 0;
  map.for_each_known([&](const CellKey& k, Cell cell, float) {
    const CellKey low = map.key_of(place - Vec3::Constant(5)), high = map.key_of(place + Vec3::Constant(5));
    const bool inside =
        k.x >= low.x && k.y >= low.y && k.z >= low.z && k.x <= high.x && k.y <= high.y && k.z <= high.z;
    expected += inside;
    EXPECT_EQ(near->at(k), inside ? cell : Cell::unknown);
  });
  EXPECT_EQ(near->free_cells() + near->occupied_cells(), expected);
  EXPECT_GT(expected, 1000u);
}

}  // namespace
}  // namespace karst::core
