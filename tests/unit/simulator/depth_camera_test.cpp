#include "plugins/simulator/depth_camera.h"

#include "meshes.h"

namespace karst::test {
namespace {

using core::DepthImage;
using core::Pose;
using sim::CameraOptions;
using sim::DepthCamera;
using sim::Facing;

DepthImage picture(Facing facing, const cave::Cave& cave, const Pose& pose) {
  CameraOptions o;
  o.noise_at_1m_m = 0;
  const DepthCamera camera(o, sim::camera_model(o, facing));
  return camera.image(cave, pose, 3, core::Random(1));
}

TEST(DepthCamera, AWallAheadIsFlatInDepthAndPinholeInRange) {
  const cave::Cave box = make_cave(box_mesh({-9, -9, -9}, {3.15, 9, 9}));
  const DepthImage image = picture(Facing::forward, box, {});
  const auto& m = *image.model;
  ASSERT_EQ(image.range_m.size(), static_cast<std::size_t>(m.width * m.height));
  EXPECT_EQ(image.stamp, 3);
  for (int row = 0; row < m.height; ++row)
    for (int column = 0; column < m.width; ++column) {
      // A pinhole spaces its pixels evenly on the image plane at distance 1.
      const double y = std::tan(m.horizontal_fov_rad / 2) * (1 - (2.0 * column + 1) / m.width);
      const double z = std::tan(m.vertical_fov_rad / 2) * (1 - (2.0 * row + 1) / m.height);
      const double expected = 3.0 * std::sqrt(1 + y * y + z * z);  // the camera sits 0.15 m ahead
      const float range = image.range_m[static_cast<std::size_t>(row * m.width + column)];
      if (expected < m.max_range_m) {
        ASSERT_NEAR(range, expected, 1e-4);
      } else {
        ASSERT_TRUE(std::isinf(range));
      }
    }
}

TEST(DepthCamera, UpLooksUpAndDownLooksDown) {
  const cave::Cave box = make_cave(box_mesh({-20, -20, -2.1}, {20, 20, 3.1}));
  const auto centre = [](const DepthImage& i) {
    return i.range_m[static_cast<std::size_t>(i.model->height / 2 * i.model->width + i.model->width / 2)];
  };
  EXPECT_NEAR(centre(picture(Facing::up, box, {})), 3.0, 0.01);
  EXPECT_NEAR(centre(picture(Facing::down, box, {})), 2.0, 0.01);
  EXPECT_TRUE(std::isinf(centre(picture(Facing::forward, box, {}))));
}

TEST(DepthCamera, LeftIsLeftAndTopIsTop) {
  // Rock near on the left and above only.
  const cave::Cave box = make_cave(box_mesh({-50, -50, -50}, {50, 1, 0.8}));
  const DepthImage image = picture(Facing::forward, box, {});
  const auto& m = *image.model;
  const auto at = [&](int row, int column) {
    return image.range_m[static_cast<std::size_t>(row * m.width + column)];
  };
  EXPECT_TRUE(std::isfinite(at(m.height / 2, 0)));
  EXPECT_TRUE(std::isinf(at(m.height / 2, m.width - 1)));
  EXPECT_TRUE(std::isfinite(at(0, m.width - 1)));
  EXPECT_TRUE(std::isinf(at(m.height - 1, m.width - 1)));
}

TEST(DepthCamera, ItsNeighbouringPixelsAreDenserThanMapCellsAtFullRange) {
  const auto m = sim::camera_model({}, Facing::forward);
  EXPECT_NEAR(m->horizontal_fov_rad * 180 / std::numbers::pi, 79, 1e-9);
  EXPECT_NEAR(m->vertical_fov_rad * 180 / std::numbers::pi, 64, 1e-9);
  const int row = m->height / 2, column = m->width / 2;
  const double apart = (m->direction(row, column) - m->direction(row, column + 1)).norm() * m->max_range_m;
  EXPECT_LT(apart, 0.1);
}

TEST(DepthCamera, NoiseGrowsWithTheSquareOfTheRange) {
  const CameraOptions o;
  const DepthCamera camera(o, sim::camera_model(o, Facing::down));
  for (const double height : {1.0, 3.0}) {
    const cave::Cave box = make_cave(box_mesh({-50, -50, -0.1 - height}, {50, 50, 50}));
    const DepthImage truth = picture(Facing::down, box, {});
    const DepthImage noisy = camera.image(box, {}, 0, core::Random(1));
    double square = 0, n = 0;
    for (std::size_t i = 0; i < truth.range_m.size(); ++i)
      if (std::isfinite(truth.range_m[i])) {
        const double scaled = (noisy.range_m[i] - truth.range_m[i]) / (truth.range_m[i] * truth.range_m[i]);
        square += scaled * scaled, ++n;
      }
    EXPECT_NEAR(std::sqrt(square / n), o.noise_at_1m_m, 0.05 * o.noise_at_1m_m);
  }
}

}  // namespace
}  // namespace karst::test
