#include "plugins/simulator/cameras/depth_camera.h"

#include "tests/unit/simulator/meshes.h"

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

// --- droplets ---

/// What a camera makes of a wall 3 m ahead, with droplets around it.
struct Droplets {
  double missed = 0;    // share of the pixels with rock in reach whose range is not within 0.3 m of it
  double invented = 0;  // share that sees something more than 0.3 m in front of it
};

Droplets before_a_wall(sim::DepthCameraKind kind, double extinction_1pm) {
  const cave::Cave box = make_cave(box_mesh({-9, -9, -9}, {3.15, 9, 9}));
  CameraOptions o;
  o.kind = kind;
  const DepthCamera camera(o, sim::camera_model(o, Facing::forward));
  cave::Cloud cloud;
  cloud.half_size_m.setConstant(1.5);
  cloud.extinction_1pm = extinction_1pm;
  cloud.lidar_ratio_sr = cave::Cloud::kDroplets_sr;
  const DepthImage truth = camera.image(box, {}, 0, core::Random(1)),
                   image = camera.image(box, {}, 0, core::Random(1), {{cloud}, core::Random(2)});
  Droplets d;
  double n = 0;
  for (std::size_t i = 0; i < truth.range_m.size(); ++i) {
    if (!std::isfinite(truth.range_m[i])) continue;
    ++n;
    d.missed += !(std::abs(image.range_m[i] - truth.range_m[i]) < 0.3f);
    d.invented += image.range_m[i] < truth.range_m[i] - 0.3f;
  }
  return {d.missed / n, d.invented / n};
}

TEST(DepthCamera, TimeOfFlightMissesWhatIsBehindDropletsAndStereoHoldsUp) {
  std::printf("  extinction 1/m   missed: stereo    tof    invented: stereo    tof\n");
  for (const double extinction_1pm : {0.02, 0.05, 0.1, 0.2, 0.4, 0.8}) {
    const Droplets stereo = before_a_wall(sim::DepthCameraKind::stereo, extinction_1pm),
                   tof = before_a_wall(sim::DepthCameraKind::tof, extinction_1pm);
    std::printf("  %14.2f %16.3f %6.3f %19.3f %6.3f\n", extinction_1pm, stereo.missed, tof.missed,
                stereo.invented, tof.invented);
    if (extinction_1pm == 0.1) {
      EXPECT_LT(stereo.missed, 0.05);
      EXPECT_GT(tof.missed, 0.5);
    }
    EXPECT_LE(stereo.missed, tof.missed);
    EXPECT_LT(stereo.invented, 0.05) << "what it cannot match it does not measure";
  }
}

TEST(DepthCamera, TwoEchoesOfOnePhasorMixInTimeOfFlight) {
  using sim::PixelLight;
  const auto tof = [](PixelLight a, std::vector<PixelLight> veil) {
    return sim::tof_range(a, veil, static_cast<float>(a.range_m), 0.01);
  };
  EXPECT_NEAR(tof({3, 1}, {}), 3, 1e-5);
  EXPECT_NEAR(tof({2, 1}, {{1, 1}}), 1.5, 1e-5) << "two as strong: half way";
  // arg(e^(i 144 deg) + 0.2 e^(i 48 deg)): law of sines in the triangle of both.
  const double turn = std::atan2(0.2 * std::sin(96 * std::numbers::pi / 180),
                                 1 + 0.2 * std::cos(96 * std::numbers::pi / 180));
  EXPECT_NEAR(tof({3, 1}, {{1, 0.2}}), 3 - 7.5 * turn / (2 * std::numbers::pi), 1e-5);
  EXPECT_TRUE(std::isnan(tof({4, 1}, {{0.5, 1}}))) << "they contradict each other: flagged";
  EXPECT_TRUE(std::isinf(tof({3, 0.001}, {}))) << "too weak: nothing seen";
}

TEST(DepthCamera, StereosNoiseGrowsAsContrastFallsUntilNothingMatches) {
  using sim::PixelLight;
  const auto stereo = [](double veil) {
    const std::vector<PixelLight> v{{1, veil}};
    return sim::stereo_range({3, 1}, v, 3.01f, 0.01f);
  };
  EXPECT_NEAR(stereo(0), 3.01, 1e-6);
  EXPECT_NEAR(stereo(1), 3.02, 1e-6) << "half the contrast, twice the noise";
  EXPECT_TRUE(std::isnan(stereo(10)));
}

TEST(DepthCamera, ClearAirIsTheSameForBothKindsAndForCloudsElsewhere) {
  const cave::Cave box = make_cave(box_mesh({-9, -9, -9}, {3.15, 9, 9}));
  CameraOptions o;
  const auto take = [&](std::vector<cave::Cloud> clouds) {
    const DepthCamera camera(o, sim::camera_model(o, Facing::forward));
    return camera.image(box, {}, 0, core::Random(1), {std::move(clouds), core::Random(2)}).range_m;
  };
  const auto stereo = take({});
  cave::Cloud behind;
  behind.position = {-5, 0, 0};
  EXPECT_EQ(take({behind}), stereo);
  o.kind = sim::DepthCameraKind::tof;
  EXPECT_EQ(take({behind}), stereo);
}

}  // namespace
}  // namespace karst::test
