#include "core_stack/mapping/registration/upright_icp.h"

#include <gtest/gtest.h>

#include "tests/unit/map_merge/tunnels.h"

namespace karst::core {
namespace {

using test::Tunnel;

const std::vector<IcpRound> kRounds = {{1.0, 20, 3000}, {0.4, 20, 3000}};

/// A stretch of a tunnel in a frame of its own: its cells are drawn there, not moved.
MapPiece piece(const Tunnel& tunnel, double begin, double end) {
  return piece_of(std::make_shared<VoxelMap>(tunnel.map(begin, end)));
}

TEST(UprightIcp, ComesBackFromAMetreAndTenDegrees) {
  const MapPiece target = piece({.phase = 0.4}, 4, 30), source = piece({.phase = 0.4}, 10, 24);
  const Vec3 place(17, 0, 0);
  for (const double turn : {-0.17, 0.1}) {
    const Quat q = from_heading(turn);
    const Pose off{place - q * place + Vec3(0.6, -0.5, 0.4), q};
    const Pose T = upright_icp(target, source, off, kRounds);
    EXPECT_LT((T * place - place).norm(), 0.03) << turn;
    EXPECT_LT(T.orientation.angularDistance(Quat::Identity()), 0.01) << turn;
  }
}

TEST(UprightIcp, NeverTilts) {
  const MapPiece target = piece({.phase = 0.4}, 0, 32), source = piece({.phase = 2.0}, 5, 20);
  const Pose T = upright_icp(target, source, {Vec3(0.5, 0, 0.3), from_heading(1)}, kRounds);
  EXPECT_NEAR((T.orientation * Vec3::UnitZ() - Vec3::UnitZ()).norm(), 0, 1e-9);
}

TEST(UprightIcp, StaysWhereNothingIsNear) {
  const MapPiece target = piece({.phase = 0.4}, 0, 20), source = piece({.phase = 0.4}, 0, 20);
  const Pose far{Vec3(500, 0, 0), Quat::Identity()};
  EXPECT_EQ(upright_icp(target, source, far, kRounds).position, far.position);
}

}  // namespace
}  // namespace karst::core
