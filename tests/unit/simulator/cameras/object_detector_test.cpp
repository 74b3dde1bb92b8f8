#include "plugins/simulator/cameras/object_detector.h"

#include <gtest/gtest.h>

#include "plugins/simulator/cameras/depth_camera.h"
#include "tests/unit/simulator/meshes.h"

namespace karst::test {
namespace {

using core::ObjectKind;
using core::Pose;
using core::Quat;
using core::Random;

/// Möller and Trumbore's test against every triangle.
bool blocked(const cave::TriangleMesh& m, const Vec3& from, const Vec3& to) {
  const Vec3 d = to - from;
  for (const auto& t : m.triangles) {
    const Vec3 a = m.vertices[t[0]].cast<double>(), e1 = m.vertices[t[1]].cast<double>() - a,
               e2 = m.vertices[t[2]].cast<double>() - a, p = d.cross(e2);
    const double det = e1.dot(p);
    if (std::abs(det) < 1e-12) continue;
    const Vec3 s = from - a, q = s.cross(e1);
    const double u = s.dot(p) / det, v = d.dot(q) / det, fraction = e2.dot(q) / det;
    if (u >= 0 && v >= 0 && u + v <= 1 && fraction > 0 && fraction < 1) return true;
  }
  return false;
}

TEST(ObjectDetector, SeesWhatBruteForceSees) {
  const cave::TriangleMesh mesh = tunnel_mesh(30, 2.5, 9);
  cave::Cave c = make_cave(mesh, {5, 0, 0});
  Random random(2);
  // On the walls all around, and behind them.
  for (int i = 0; i < 300; ++i) {
    const double a = random.uniform(0, 6.28), r = random.uniform(1.5, 3.0);
    c.description.objects.push_back(
        {ObjectKind::rope, {random.uniform(2, 28), r * std::cos(a), r * std::sin(a)}, random_unit(random)});
  }
  sim::ObjectOptions o;
  o.range_m = 4;
  const sim::ObjectDetector detector(o, {});
  int seen = 0, hidden = 0;
  for (const sim::Facing facing : {sim::Facing::forward, sim::Facing::up, sim::Facing::down}) {
    const core::CameraModel camera = *sim::camera_model({}, facing);
    for (int i = 0; i < 40; ++i) {
      const Pose T{{random.uniform(4, 26), random.uniform(-1, 1), random.uniform(-1, 1)},
                   Quat(Eigen::AngleAxisd(random.uniform(-3, 3), random_unit(random)))};
      std::vector<bool> told(c.description.objects.size(), false);
      for (const sim::InView& v : detector.in_view(c, T, camera, sim::Light::own)) {
        told[v.object] = true;
        EXPECT_LT((T * v.place - c.description.objects[v.object].position).norm(), 1e-9);
      }
      for (std::size_t k = 0; k < told.size(); ++k) {
        const auto& object = c.description.objects[k];
        const Vec3 offset = object.position - T.position, in = T.orientation.inverse() * offset;
        const bool in_field = std::abs(std::atan2(in.y(), in.x())) <= camera.horizontal_fov_rad / 2 &&
                              std::abs(std::atan2(in.z(), in.x())) <= camera.vertical_fov_rad / 2;
        const double limit = std::min(4.0, static_cast<double>(camera.max_range_m));
        const bool near = offset.norm() <= limit && offset.norm() >= static_cast<double>(camera.min_range_m);
        const bool facing_us = std::acos(-offset.normalized().dot(object.normal)) <= o.max_incidence_rad;
        const bool clear = !blocked(mesh, T.position, object.position);
        EXPECT_EQ(told[k], in_field && near && facing_us && clear) << k << " from pose " << i;
        seen += told[k];
        hidden += in_field && near && facing_us && !clear;
      }
    }
  }
  EXPECT_GT(seen, 50) << "or the test says nothing";
  EXPECT_GT(hidden, 20);
}

TEST(ObjectDetector, AnotherVehicleHidesWhatIsBehindIt) {
  cave::Cave c = make_cave(box_mesh({-6, -6, 0}, {6, 6, 4}));
  c.description.objects = {{ObjectKind::backpack, {3, 0, 2}, Vec3::Zero()}};
  const core::CameraModel camera = *sim::camera_model({}, sim::Facing::forward);
  Pose eye{{0, 0, 2}, Quat::Identity()};
  eye = eye * camera.T_body_camera;
  const sim::ObjectDetector detector({}, {});
  EXPECT_EQ(detector.in_view(c, eye, camera, sim::Light::own).size(), 1u);
  c.scene = c.scene.with_boulders({{{1.5, 0, 2}, 0.3}});
  EXPECT_TRUE(detector.in_view(c, eye, camera, sim::Light::own).empty());
}

TEST(ObjectDetector, TheColourCameraNeedsItsLampAndDustDims) {
  cave::Cave c = make_cave(box_mesh({-9, -9, 0}, {9, 9, 4}));
  c.description.objects = {{ObjectKind::backpack, {4, 1.5, 2}, Vec3::Zero()}};
  sim::RgbOptions rgb;
  rgb.fitted = true;
  const core::CameraModel camera = sim::rgb_camera_model(rgb)->camera;
  const Pose eye{{0, 0, 2}, Quat::Identity()};
  EXPECT_EQ(sim::ObjectDetector({}, rgb).in_view(c, eye, camera, sim::Light::lamp).size(), 1u);
  rgb.light = sim::LampLight::spot;
  rgb.beam_rad = 0.3;  // 8.6 degrees to each side; the object is 20 degrees off
  EXPECT_TRUE(sim::ObjectDetector({}, rgb).in_view(c, eye, camera, sim::Light::lamp).empty());
  rgb.light = sim::LampLight::flood;
  rgb.intensity_cd = 30;  // 1.6 lux at 4.3 m
  EXPECT_TRUE(sim::ObjectDetector({}, rgb).in_view(c, eye, camera, sim::Light::lamp).empty());
  rgb.intensity_cd = 1000;
  cave::Cloud dust;
  dust.position = {2, 0.75, 2}, dust.half_size_m.setConstant(1);
  for (const auto& [extinction, seen] :
       {std::pair{0.3, 1u}, {1.0, 0u}}) {  // exp(-2 * 2 m * extinction) is left
    dust.extinction_1pm = extinction;
    const auto in_view = sim::ObjectDetector({}, rgb).in_view(c, eye, camera, sim::Light::lamp,
                                                              std::vector<cave::Cloud>{dust});
    EXPECT_EQ(in_view.size(), seen) << extinction;
    if (seen && !in_view.empty()) {
      EXPECT_NEAR(in_view[0].clear, std::exp(-4 * extinction), 0.02);
    }
  }
}

TEST(ObjectDetector, MissesAndErrsAsOftenAndAsMuchAsItSays) {
  cave::Cave c = make_cave(box_mesh({-2, -2, 0}, {3, 2, 4}));
  c.description.objects = {{ObjectKind::drill, {2.5, 0.5, 2.5}, Vec3::Zero()}};
  const core::CameraModel camera = *sim::camera_model({}, sim::Facing::forward);
  const Pose eye{{0, 0, 2}, Quat::Identity()};
  sim::ObjectOptions o;
  o.detection = 0.8;
  o.false_per_min = 30;  // at 5 images a second: in a tenth of them
  const sim::ObjectDetector detector(o, {});
  const auto in_view = detector.in_view(c, eye, camera, sim::Light::own);
  ASSERT_EQ(in_view.size(), 1u);
  const Vec3 truth = in_view[0].place;
  constexpr int kImages = 20000;
  int found = 0, wrong = 0;
  double range2 = 0, off2 = 0;
  for (int i = 0; i < kImages; ++i)
    for (const core::ObjectDetection& d :
         detector.detect(c, eye, camera, sim::Light::own, in_view, Random::stream(7, std::to_string(i)))) {
      EXPECT_NEAR(d.direction.norm(), 1, 1e-9);
      if (d.kind != ObjectKind::drill || d.direction.dot(truth.normalized()) < 0.98) {
        ++wrong;
        EXPECT_LE(d.confidence, 0.7);
        continue;
      }
      ++found;
      range2 += std::pow(d.range_m - truth.norm(), 2);
      off2 += 1 - std::pow(d.direction.dot(truth.normalized()), 2);
    }
  EXPECT_NEAR(found, 0.8 * kImages, 300);  // five deviations
  EXPECT_NEAR(wrong, 30 * core::seconds(camera.period) / 60 * kImages, 250);
  EXPECT_NEAR(std::sqrt(range2 / found), 0.02 * truth.norm(), 0.004);
  EXPECT_NEAR(std::sqrt(off2 / found), std::sqrt(2) * o.bearing_noise_rad, 0.001);
}

}  // namespace
}  // namespace karst::test
