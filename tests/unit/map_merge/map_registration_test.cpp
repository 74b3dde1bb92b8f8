// Maps of one tunnel are put together; maps of two tunnels, and of a smooth tube, are refused.
#include "sdk/map_merge/map_registration.h"

#include <gtest/gtest.h>

#include "core_stack/common/random.h"
#include "sdk/map_merge/merge_maps.h"
#include "tests/unit/map_merge/tunnels.h"

namespace karst::map_merge {
namespace {

using core::MapOptions;
using core::PointTree;
using core::Pose;
using core::Quat;
using core::Random;
using core::Vec3;
using core::Vec3f;
using core::VoxelMap;
using test::Tunnel;

MapPiece piece(VoxelMap map) { return piece_of(std::make_shared<VoxelMap>(std::move(map))); }

VoxelMap moved(const VoxelMap& map, const Pose& T) {
  VoxelMap out{MapOptions{}};
  add_map(out, map, T, {});
  return out;
}

double worst_error_m(const MapPiece& source, const Pose& found, const Pose& truth) {
  double worst = 0;
  for (const Vec3f& p : source.surface)
    worst = std::max(worst, (found * p.cast<double>() - truth * p.cast<double>()).norm());
  return worst;
}

TEST(PlaceDescriptor, KnowsAPlaceAgainAndByHowMuchItIsTurned) {
  Random random(2);
  std::vector<Vec3f> rock;
  for (int i = 0; i < 800; ++i)
    rock.push_back(Vec3(random.uniform(-7, 7), random.uniform(-7, 7), random.uniform(-4, 4)).cast<float>());
  const PlaceDescriptor here(PointTree(rock), {Vec3::Zero(), Quat::Identity()}, 1.0);
  for (const double turn : {0.0, 0.5, -2.0, 3.1}) {
    std::vector<Vec3f> turned;
    const Quat q = core::from_heading(-turn);
    for (const Vec3f& p : rock) turned.push_back((q * p.cast<double>()).cast<float>() + Vec3f(30, -5, 2));
    const PlaceDescriptor there(PointTree(turned), {Vec3(30, -5, 2), Quat::Identity()}, 1.0);
    EXPECT_GT(here.invariants().dot(there.invariants()), 0.97f);
    EXPECT_NEAR(core::wrap_angle(here.turn_of(there).angle_rad - turn), 0, 0.1);
  }
  std::vector<Vec3f> other;
  for (int i = 0; i < 800; ++i)
    other.push_back(Vec3(random.uniform(-7, 7), random.uniform(-7, -2), random.uniform(-4, 1)).cast<float>());
  const PlaceDescriptor elsewhere(PointTree(other), {Vec3::Zero(), Quat::Identity()}, 1.0);
  EXPECT_LT(here.invariants().dot(elsewhere.invariants()), 0.9f);
}

TEST(MapRegistration, PutsTwoStretchesOfATunnelTogether) {
  const Tunnel tunnel{.phase = 0.4};
  const Pose T_source_target{Vec3(12, -30, 4), core::from_heading(2.2)};
  const MapPiece target = piece(tunnel.map(0, 32)),
                 source = piece(moved(tunnel.map(18, 50), T_source_target));
  const MapRegistration r = register_maps(target, source, {});
  EXPECT_TRUE(r.trusted) << r.reason;
  EXPECT_LT(worst_error_m(source, r.T_target_source, T_source_target.inverse()), 0.3);
  EXPECT_NEAR(r.overlay.source_overlap(), 14.0 / 32, 0.1);
  EXPECT_GT(r.overlay.agreement(), 0.98);
  EXPECT_LT(r.overlay.residual_m(), 0.2);
  const MapRegistration again = register_maps(target, source, {});
  EXPECT_EQ(again.T_target_source.position, r.T_target_source.position);
  EXPECT_EQ(again.T_target_source.orientation.coeffs(), r.T_target_source.orientation.coeffs());
}

TEST(MapRegistration, WithoutGravityFindsAnyTurn) {
  const Tunnel tunnel{.phase = 1.3};
  const Pose T_source_target{Vec3(5, 8, -4), Quat(Eigen::AngleAxisd(2.0, Vec3(1, 2, 3).normalized()))};
  const MapPiece target = piece(tunnel.map(0, 36)), source = piece(moved(tunnel.map(8, 44), T_source_target));
  MapRegistrationOptions options;
  options.coarse.gravity_known = false;
  const MapRegistration r = register_maps(target, source, options);
  EXPECT_TRUE(r.trusted) << r.reason;
  EXPECT_LT(worst_error_m(source, r.T_target_source, T_source_target.inverse()), 0.4);
}

TEST(MapRegistration, RefusesTwoTunnelsThatHaveNothingInCommon) {
  for (const double phase : {2.0, 5.1}) {
    const MapRegistration r =
        register_maps(piece(Tunnel{.phase = 0.4}.map(0, 32)), piece(Tunnel{.phase = phase}.map(0, 32)), {});
    EXPECT_FALSE(r.trusted) << "phase " << phase;
    EXPECT_FALSE(r.reason.empty());
  }
}

TEST(MapRegistration, RefusesASmoothStraightTubeWhichSlides) {
  const Tunnel tube{.phase = 0, .bend_m = 0, .knobs_m = 0};
  const MapRegistration r = register_maps(piece(tube.map(0, 30)), piece(tube.map(12, 42)), {});
  EXPECT_FALSE(r.trusted);
  EXPECT_LT(r.hold, 0.01);
}

TEST(MapRegistration, SaysThatTooLittleRockIsTooLittle) {
  VoxelMap few{MapOptions{}};
  for (int i = 0; i < 5; ++i) few.assign({i, 0, 0}, 1, 1.0f);
  const MapRegistration r = register_maps(piece(Tunnel{}.map(0, 20)), piece(std::move(few)), {});
  EXPECT_FALSE(r.trusted);
  EXPECT_NE(r.reason.find("too little rock"), std::string::npos) << r.reason;
  EXPECT_THROW(piece(VoxelMap(MapOptions{})), std::invalid_argument);
  EXPECT_THROW(piece_of({Vec3f::Constant(std::nanf(""))}, 0.2), std::invalid_argument);
}

TEST(HoldOf, IsTheLeastHeldDirectionsMeanSquaredCosine) {
  // Three planes at right angles, equally large: each translation is held by a third of the points.
  std::vector<Vec3f> corner, floor;
  for (float a = 0.1f; a < 8; a += 0.2f)
    for (float b = 0.1f; b < 8; b += 0.2f) {
      corner.insert(corner.end(), {Vec3f(a, b, 0), Vec3f(a, 0, b), Vec3f(0, a, b)});
      floor.push_back({a, b, 0});
    }
  const MapPiece c = piece_of(corner, 0.2), f = piece_of(floor, 0.2);
  const double held = hold_of(c, c, {}, 0.3, true);
  EXPECT_GT(held, 0.1);
  EXPECT_LT(held, 1.0 / 3 + 0.02);
  EXPECT_LT(hold_of(f, f, {}, 0.3, true), 1e-3);
}

TEST(AddMap, LogOddsAddAndAreClamped) {
  const MapOptions options;
  VoxelMap a(options), b(options);
  a.assign({0, 0, 0}, 1, 0.5f);
  a.assign({1, 0, 0}, 1, 2.0f);
  b.assign({0, 0, 0}, 1, -1.25f);
  b.assign({1, 0, 0}, 1, 3.0f);
  b.assign({2, 0, 0}, 1, -0.5f);
  add_map(a, b, {}, options);
  EXPECT_NEAR(*a.log_odds({0, 0, 0}), -0.75, 1e-3);
  EXPECT_NEAR(*a.log_odds({1, 0, 0}), std::log(0.97 / 0.03), 1e-3);
  EXPECT_NEAR(*a.log_odds({2, 0, 0}), -0.5, 1e-3);
  VoxelMap coarse(MapOptions{.resolution_m = 0.4});
  EXPECT_THROW(add_map(a, coarse, {}, options), std::invalid_argument);
}

TEST(AddMap, EveryCentreTakesTheCellItLiesInOnceHoweverTheMapIsTurned) {
  const MapOptions options;
  VoxelMap source(options);
  for (int x = -12; x < 12; ++x)
    for (int y = -12; y < 12; ++y)
      for (int z = -6; z < 6; ++z)
        source.assign({x, y, z}, 1, 0.01f * static_cast<float>(1 + (x * 7 + y * 3 + z + 400) % 50));
  const Pose T{Vec3(3.3, -1.7, 0.45),
               (core::from_heading(0.7) * Quat(Eigen::AngleAxisd(0.3, Vec3::UnitX()))).normalized()};
  const VoxelMap turned = moved(source, T);
  std::size_t known = 0;
  for (int x = -30; x < 60; ++x)
    for (int y = -50; y < 40; ++y)
      for (int z = -30; z < 30; ++z) {
        const auto expected = source.log_odds(source.key_of(T.inverse() * turned.center_of({x, y, z})));
        const auto found = turned.log_odds({x, y, z});
        ASSERT_EQ(found.has_value(), expected.has_value());
        if (!found) continue;
        ++known;
        ASSERT_NEAR(*found, *expected, 1e-3);
      }
  EXPECT_NEAR(static_cast<double>(known), 24 * 24 * 12, 300);
}

}  // namespace
}  // namespace karst::map_merge
