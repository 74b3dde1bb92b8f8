#include "core_stack/common/geometry.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "core_stack/common/random.h"
#include "core_stack/common/time.h"

namespace karst::core {
namespace {

Pose random_pose(Random& r) {
  const Vec3 axis = Vec3(r.normal(), r.normal(), r.normal()).normalized();
  return {Vec3(r.uniform(-50, 50), r.uniform(-50, 50), r.uniform(-50, 50)),
          Quat(Eigen::AngleAxisd(r.uniform(-4, 4), axis))};
}

Eigen::Isometry3d isometry(const Pose& p) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translate(p.position);
  T.rotate(p.orientation);
  return T;
}

RC_GTEST_PROP(Pose, ComposesAndInvertsAsEigensIsometries, (std::uint64_t seed)) {
  Random r(seed);
  const Pose a = random_pose(r), b = random_pose(r);
  const Vec3 p(r.normal(), r.normal(), r.normal());
  RC_ASSERT((isometry(a * b).matrix() - (isometry(a) * isometry(b)).matrix()).norm() < 1e-10);
  RC_ASSERT((isometry(a.inverse()).matrix() - isometry(a).inverse().matrix()).norm() < 1e-10);
  RC_ASSERT((a * p - isometry(a) * p).norm() < 1e-10);
  RC_ASSERT((a.inverse() * (a * p) - p).norm() < 1e-10);
}

TEST(Pose, ALongChainOfProductsStaysARotation) {
  Random r(1);
  const Pose step{{0.01, 0, 0}, Quat(Eigen::AngleAxisd(0.013, Vec3(1, 2, 3).normalized()))};
  Pose p;
  for (int i = 0; i < 200000; ++i) p = p * step;
  EXPECT_NEAR(p.orientation.norm(), 1.0, 1e-14);
  EXPECT_NEAR(p.orientation.toRotationMatrix().determinant(), 1.0, 1e-12);
}

RC_GTEST_PROP(WrapAngle, IsTheSameDirectionInTheHalfOpenRange, (int turns, double unit)) {
  const double fraction = std::isfinite(unit) ? std::sin(unit) : 0;
  const double a = std::numbers::pi * (fraction + (turns % 1000));
  const double w = wrap_angle(a);
  RC_ASSERT(w >= -std::numbers::pi);
  RC_ASSERT(w < std::numbers::pi);
  RC_ASSERT(std::abs(std::sin(w) - std::sin(a)) < 1e-9);
  RC_ASSERT(std::abs(std::cos(w) - std::cos(a)) < 1e-9);
}

TEST(WrapAngle, AtTheEndsOfTheRange) {
  EXPECT_EQ(wrap_angle(0), 0);
  EXPECT_DOUBLE_EQ(wrap_angle(std::numbers::pi), -std::numbers::pi);
  EXPECT_DOUBLE_EQ(wrap_angle(-std::numbers::pi), -std::numbers::pi);
  EXPECT_NEAR(wrap_angle(7), 7 - 2 * std::numbers::pi, 1e-15);
  // Just below -pi, where adding a turn rounds to pi itself.
  const double below = std::nextafter(-std::numbers::pi, -4.0);
  EXPECT_LT(wrap_angle(below), std::numbers::pi);
  EXPECT_LT(wrap_angle(-1e-17 - std::numbers::pi), std::numbers::pi);
}

TEST(Heading, IsCounterClockwiseFromEast) {
  EXPECT_NEAR((from_heading(std::numbers::pi / 2) * Vec3::UnitX() - Vec3::UnitY()).norm(), 0, 1e-15);
  for (double h = -3.1; h < 3.1; h += 0.1) {
    EXPECT_NEAR(heading_of(from_heading(h)), h, 1e-12);
    // Leaning forward or to the side about the body's own axes leaves or hardly moves where x points.
    const Quat nose_down(Eigen::AngleAxisd(0.3, Vec3::UnitY()));
    EXPECT_NEAR(wrap_angle(heading_of(from_heading(h) * nose_down) - h), 0, 1e-12);
  }
}

TEST(Time, SecondsAndNanosecondsAgree) {
  EXPECT_EQ(from_seconds(0.01), 10 * kMillisecond);
  EXPECT_EQ(from_seconds(-1.5), -1500 * kMillisecond);
  EXPECT_EQ(from_seconds(seconds(123456789)), 123456789);
  EXPECT_DOUBLE_EQ(seconds(2500 * kMillisecond), 2.5);
}

}  // namespace
}  // namespace karst::core
