#include "plugins/simulator/dynamics/rigid_body.h"

#include "tests/unit/simulator/meshes.h"

namespace karst::test {
namespace {

using sim::BodyModel;
using sim::BodyState;

constexpr double kStep_s = 0.001;

BodyState run(const BodyModel& m, BodyState s, const sim::Wrench& w, const Vec3& wind, int steps) {
  for (int i = 0; i < steps; ++i) s = sim::advance(m, s, w, wind, kStep_s);
  return s;
}

TEST(RigidBody, FallsFreelyAsGalileoSays) {
  BodyModel m;
  m.drag_kgps = 0;
  const BodyState s = run(m, {}, {}, Vec3::Zero(), 2000);
  EXPECT_NEAR(s.velocity_mps.z(), -9.81 * 2, 1e-9);
  EXPECT_NEAR(s.T_world_body.position.z(), -0.5 * 9.81 * 4, 1e-9);
}

TEST(RigidBody, DragLeadsToTerminalVelocity) {
  BodyModel m;
  m.drag_kgps = 1.0;  // time constant m / c = 2 s
  const double terminal = m.mass_kg * 9.81 / m.drag_kgps;
  const BodyState early = run(m, {}, {}, Vec3::Zero(), 2000);
  EXPECT_NEAR(early.velocity_mps.z(), -terminal * (1 - std::exp(-1.0)), 0.01);
  EXPECT_NEAR(run(m, {}, {}, Vec3::Zero(), 40000).velocity_mps.z(), -terminal, 1e-6);
}

TEST(RigidBody, HoversWhereThrustIsWeight) {
  const BodyModel m;
  const BodyState s = run(m, {}, {m.weight_n(), Vec3::Zero()}, Vec3::Zero(), 60000);
  EXPECT_LT(s.T_world_body.position.norm(), 1e-9);
}

TEST(RigidBody, WindCarriesAHoveringVehicleAlong) {
  const BodyModel m;
  const BodyState s = run(m, {}, {m.weight_n(), Vec3::Zero()}, {3, 0, 0}, 60000);
  EXPECT_NEAR(s.velocity_mps.x(), 3 * (1 - std::exp(-60 * m.drag_kgps / m.mass_kg)), 1e-3);
}

TEST(RigidBody, TiltedThrustAcceleratesSideways) {
  BodyModel m;
  m.drag_kgps = 0;
  BodyState s;
  const double tilt = 0.2;
  s.T_world_body.orientation = core::Quat(Eigen::AngleAxisd(tilt, Vec3::UnitY()));
  s = run(m, s, {m.weight_n() / std::cos(tilt), Vec3::Zero()}, Vec3::Zero(), 1000);
  EXPECT_NEAR(s.velocity_mps.x(), 9.81 * std::tan(tilt), 1e-9) << "a positive pitch leans forward";
  EXPECT_NEAR(s.velocity_mps.z(), 0, 1e-9);
}

TEST(RigidBody, TorqueSpinsUpAboutAPrincipalAxis) {
  BodyModel m;
  m.spin_drag_nms = 0;
  const BodyState s = run(m, {}, {0, {0, 0, 0.036}}, Vec3::Zero(), 1000);
  EXPECT_NEAR(s.body_rate_radps.z(), 1.0, 1e-9);
  EXPECT_NEAR(core::heading_of(s.T_world_body.orientation), 0.5, 1e-4);
}

TEST(RigidBody, FreeRotationKeepsAngularMomentumAndEnergy) {
  BodyModel m;
  m.spin_drag_nms = 0;
  m.pitch_inertia_kgm2 = 0.03;
  BodyState s;
  s.body_rate_radps = {2, 3, -1};
  const Vec3 J = m.inertia_kgm2();
  const auto momentum = [&](const BodyState& b) -> Vec3 {
    return b.T_world_body.orientation * J.cwiseProduct(b.body_rate_radps);
  };
  const auto energy = [&](const BodyState& b) {
    return 0.5 * b.body_rate_radps.dot(J.cwiseProduct(b.body_rate_radps));
  };
  const Vec3 L0 = momentum(s);
  const double E0 = energy(s);
  s = run(m, s, {}, Vec3::Zero(), 2000);
  // The rate is integrated to first order: relative error of the order of the step times the rate.
  EXPECT_LT((momentum(s) - L0).norm() / L0.norm(), 0.02);
  EXPECT_NEAR(energy(s) / E0, 1, 0.02);
  EXPECT_NEAR(s.T_world_body.orientation.norm(), 1, 1e-12);
}

}  // namespace
}  // namespace karst::test
