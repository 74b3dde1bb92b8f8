#include "plugins/simulator/cameras/rgb_camera.h"

#include <thread>

#include "plugins/simulator/cameras/rock_texture.h"
#include "tests/unit/simulator/meshes.h"

namespace karst::test {
namespace {

using core::Pose;
using core::Quat;
using sim::RgbCamera;
using sim::RgbOptions;

/// A smooth Lambert world, so that a pixel has a closed form but for the rock's own look.
RgbOptions plain() {
  RgbOptions o;
  o.fitted = o.pictures = true;
  o.roughness_rad = 0;
  o.noise = 0;
  o.width = 64, o.height = 48;
  return o;
}

/// Where a pixel's ray goes, worked out from the pinhole model alone.
Vec3 pixel_ray(const RgbOptions& o, int row, int column) {
  const double half = std::tan(o.fov_rad / 2), pixel = 2 * half / static_cast<double>(o.width);
  return Vec3(1, half - pixel * (column + 0.5), pixel * (static_cast<double>(o.height) / 2 - row - 0.5))
      .normalized();
}

TEST(RgbCamera, APlaneLitHeadOnHasLambertsLuminance) {
  const RgbOptions o = plain();
  const cave::Cave box = make_cave(box_mesh({-20, -20, -20}, {3.15, 20, 20}));
  const std::vector<core::Vec3f> light = RgbCamera(o).light(box, {});
  const Vec3 eye(0.15, 0, 0), lamp = eye + Vec3(0, 0.08, 0.1);
  double ratio = 0;
  for (int row = 0; row < o.height; ++row)
    for (int column = 0; column < o.width; ++column) {
      const Vec3 ray = pixel_ray(o, row, column), place = eye + 3.0 / ray.x() * ray, to_lamp = lamp - place;
      const double cosine = -to_lamp.x() / to_lamp.norm();  // of the incidence on the wall x = 3.15
      const double lux = o.intensity_cd * cosine / to_lamp.squaredNorm();
      const double expected = box.description.reflectivity * lux / std::numbers::pi * std::pow(ray.x(), 4);
      const double seen = static_cast<double>(light[static_cast<std::size_t>(row * o.width + column)].y());
      // The rock's own look: between 0.15 and 1.9 times the mean, and bumps that tilt it a little.
      EXPECT_GT(seen, 0.02 * expected);
      EXPECT_LT(seen, 2.6 * expected);
      ratio += seen / expected;
    }
  EXPECT_NEAR(ratio / static_cast<double>(o.width * o.height), 1, 0.12);
}

TEST(RgbCamera, OrenAndNayarsHeadOnValueAndLambertsLimit) {
  const core::Vec3f n(0, 0, 1);
  for (const float sigma : {0.1f, 0.35f, 0.8f})
    EXPECT_NEAR(sim::reflected_fraction(n, n, n, sigma), 1 - 0.5f * sigma * sigma / (sigma * sigma + 0.33f),
                1e-6);
  const core::Vec3f in = core::Vec3f(0.5f, 0.2f, 1).normalized(),
                    out = core::Vec3f(-0.3f, 0.6f, 1).normalized();
  EXPECT_FLOAT_EQ(sim::reflected_fraction(n, in, out, 0), in.z());
  EXPECT_EQ(sim::reflected_fraction(n, -in, out, 0.3f), 0);
  EXPECT_EQ(sim::reflected_fraction(n, in, -out, 0.3f), 0);
  // The published form, with its angles.
  const double sigma = 0.35, a = std::acos(in.z()), b = std::acos(out.z());
  const double phi = std::atan2(in.y(), in.x()) - std::atan2(out.y(), out.x());
  const double A = 1 - 0.5 * sigma * sigma / (sigma * sigma + 0.33),
               B = 0.45 * sigma * sigma / (sigma * sigma + 0.09);
  const double expected = std::cos(a) * (A + B * std::max(0.0, std::cos(phi)) * std::sin(std::max(a, b)) *
                                                 std::tan(std::min(a, b)));
  EXPECT_NEAR(sim::reflected_fraction(n, in, out, 0.35f), expected, 1e-5);
}

TEST(RgbCamera, ASpotIsDarkOutsideItsBeamAndAFloodIsNot) {
  RgbOptions o = plain();
  o.light = sim::LampLight::spot;
  o.beam_rad = 0.4;
  EXPECT_EQ(sim::beam_fraction(o, std::cos(0.19f)), 1);
  EXPECT_EQ(sim::beam_fraction(o, std::cos(0.25f)), 0);
  const float edge = sim::beam_fraction(o, std::cos(0.22f));
  EXPECT_GT(edge, 0);
  EXPECT_LT(edge, 1);
  const cave::Cave box = make_cave(box_mesh({-20, -20, -20}, {3.15, 20, 20}));
  const auto spot = RgbCamera(o).light(box, {});
  EXPECT_EQ(spot.front().y(), 0);
  EXPECT_GT(spot[spot.size() / 2 + 32].y(), 0);
  o.light = sim::LampLight::flood;
  EXPECT_GT(RgbCamera(o).light(box, {}).front().y(), 0);
  EXPECT_EQ(sim::beam_fraction(o, -0.1f), 0);
}

TEST(RgbCamera, AKnownPointComesToItsPixel) {
  // A bright ball of rock in a dark room, at (4, 1, -0.8) from a camera that is turned and pitched.
  const RgbOptions o = [] {
    RgbOptions p = plain();
    p.pitch_rad = 0.2;
    return p;
  }();
  cave::Cave box = make_cave(box_mesh({-9, -9, -9}, {9, 9, 9}));
  const Vec3 ball(4, 1, -0.8);
  box.scene = box.scene.with_boulders({{ball, 0.3}});
  box.description.reflectivity = 0.0;
  box.description.patches = {{ball, 0.6, 1.0}};
  const Pose T_world_body{{0.5, -0.3, 0.2}, Quat(Eigen::AngleAxisd(0.3, Vec3::UnitZ()))};
  const auto light = RgbCamera(o).light(box, T_world_body);
  double weight = 0, row_sum = 0, column_sum = 0;
  for (int row = 0; row < o.height; ++row)
    for (int column = 0; column < o.width; ++column) {
      const bool lit = light[static_cast<std::size_t>(row * o.width + column)].y() > 0;
      weight += lit, row_sum += lit * row, column_sum += lit * column;
    }
  ASSERT_GT(weight, 10);
  // By hand: into the body, forward by 0.15 m, down by the pitch, and through the pinhole.
  const Vec3 d = ball - T_world_body.position;
  const double c = std::cos(0.3), s = std::sin(0.3);
  const Vec3 b(c * d.x() + s * d.y() - 0.15, -s * d.x() + c * d.y(), d.z());
  const double x = std::cos(0.2) * b.x() + std::sin(0.2) * b.z(),
               z = -std::sin(0.2) * b.x() + std::cos(0.2) * b.z();
  const double focal = static_cast<double>(o.width) / 2 / std::tan(o.fov_rad / 2);
  EXPECT_NEAR(column_sum / weight, static_cast<double>(o.width) / 2 - 0.5 - focal * b.y() / x, 0.6);
  EXPECT_NEAR(row_sum / weight, static_cast<double>(o.height) / 2 - 0.5 - focal * z / x, 0.6);
}

TEST(RgbCamera, ABallThrowsItsShadowBesideWhatTheLensSees) {
  // A ball before a wall: the lamp sits to the left, above, so the shadow falls to the right, below.
  RgbOptions o = plain();
  o.width = 200, o.height = 150;
  cave::Cave box = make_cave(box_mesh({-9, -9, -9}, {3.15, 9, 9}));
  box.scene = box.scene.with_boulders({{{1.65, 0, 0}, 0.3}});
  const auto light = RgbCamera(o).light(box, {});
  const auto at = [&](double y, double z) {  // pixel that looks at (3.15, y, z)
    const double focal = static_cast<double>(o.width) / 2 / std::tan(o.fov_rad / 2);
    const auto column = static_cast<std::size_t>(static_cast<double>(o.width) / 2 - focal * y / 3);
    const auto row = static_cast<std::size_t>(static_cast<double>(o.height) / 2 - focal * z / 3);
    return light[row * static_cast<std::size_t>(o.width) + column].y();
  };
  // From the lamp at (0.15, 0.08, 0.1) the ball's middle falls on (3.15, -0.08, -0.1); its radius there is
  // 0.6. The lens sees the wall outside a radius of 0.61.
  EXPECT_EQ(at(-0.46, -0.47), 0);
  EXPECT_GT(at(0.46, 0.47), 0);
}

TEST(RgbCamera, HazeTakesLightAwayAsBeerAndLambertSay) {
  RgbOptions o = plain();
  const cave::Cave box = make_cave(box_mesh({-20, -20, -20}, {3.15, 20, 20}));
  sim::Air air;
  cave::Cloud haze;
  haze.half_size_m.setConstant(1000);
  haze.extinction_1pm = 0.2;
  haze.lidar_ratio_sr = 1e12;  // sends nothing back
  air.clouds = {haze};
  const auto clear = RgbCamera(o).light(box, {}), dim = RgbCamera(o).light(box, {}, air);
  for (const int column : {0, 20, 63}) {
    const auto i = static_cast<std::size_t>(24 * o.width + column);
    const double range = 3.0 / pixel_ray(o, 24, column).x();
    EXPECT_NEAR(dim[i].y() / clear[i].y(), std::exp(-2 * 0.2 * range), 2e-3);
  }
  // Real dust sends light back: the picture gains a veil.
  air.clouds[0].lidar_ratio_sr = cave::Cloud::kDust_sr;
  EXPECT_GT(RgbCamera(o).light(box, {}, air)[1500].y(), dim[1500].y());
}

TEST(RgbCamera, TheSamePlaceLooksTheSameFromElsewhereAndOtherPlacesDoNot) {
  const Vec3 place(12.3, -4.56, 7.89);
  const sim::RockLook a = sim::rock_look(place, 0.002f), b = sim::rock_look(place, 0.002f);
  EXPECT_EQ(a.tint, b.tint);
  EXPECT_EQ(a.slope, b.slope);
  double sum = 0, squares = 0;
  const int n = 4000;
  core::Random random(4);
  for (int i = 0; i < n; ++i) {
    const double t = static_cast<double>(
        sim::rock_look({random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-9, 9)}, 0.002f)
            .tint.y());
    sum += t, squares += t * t;
  }
  EXPECT_NEAR(sum / n, 1, 0.05);
  EXPECT_GT(squares / n - sum * sum / n / n, 0.01);  // features to match: a tenth of the mean at least
  // Its slope is the derivative of something: around a small square it adds up to nothing.
  double around = 0;
  const double e = 1e-3;
  const Vec3 x(e, 0, 0), y(0, e, 0);
  const auto slope = [&](const Vec3& p) { return Vec3(sim::rock_look(p, 0.02f).slope.cast<double>()); };
  around += slope(place + x / 2).dot(x) + slope(place + x + y / 2).dot(y) - slope(place + y + x / 2).dot(x) -
            slope(place + y / 2).dot(y);
  EXPECT_NEAR(around / e / e, 0, 0.02 * slope(place).norm() / e + 1e-2);
}

TEST(RgbCamera, AutomaticExposurePutsTheMeanInTheMiddleAndFixedDoesNot) {
  RgbOptions o = plain();
  const auto mean_of = [&](double wall_m, sim::Exposure exposure) {
    o.exposure = exposure;
    const cave::Cave box = make_cave(box_mesh({-20, -20, -20}, {wall_m + 0.15, 20, 20}));
    const auto rgb = RgbCamera(o).picture(box, {}, core::Random(1));
    double sum = 0;
    for (const std::uint8_t v : rgb) sum += v;
    return sum / static_cast<double>(rgb.size());
  };
  EXPECT_NEAR(mean_of(2, sim::Exposure::automatic), mean_of(4, sim::Exposure::automatic), 12);
  EXPECT_NEAR(mean_of(3, sim::Exposure::automatic), 118, 25);  // 18 % of white is 118 in sRGB
  EXPECT_GT(mean_of(2, sim::Exposure::fixed), mean_of(4, sim::Exposure::fixed) + 30);
}

TEST(RgbCamera, PicturesAreTheSameOnAnyThreadAndDifferByTheirNoiseAlone) {
  RgbOptions o = plain();
  o.noise = 0.02;
  const cave::Cave box = make_cave(tunnel_mesh(20, 2.5, 5));
  const RgbCamera camera(o);
  const Pose T{{8, 0, 0}, Quat::Identity()};
  const auto here = camera.picture(box, T, core::Random(7));
  std::vector<std::vector<std::uint8_t>> there(3);
  std::vector<std::thread> threads;
  for (auto& p : there) threads.emplace_back([&] { p = camera.picture(box, T, core::Random(7)); });
  for (auto& t : threads) t.join();
  for (const auto& p : there) EXPECT_EQ(p, here);
  EXPECT_NE(camera.picture(box, T, core::Random(8)), here);
}

TEST(RgbCamera, OptionsOutOfRangeAreRefusedByName) {
  RgbOptions o;
  core::OptionTable t;
  t.section("rgb", o);
  const auto refused = [&](const char* key, const char* text) {
    try {
      t.set("mission.info", key, text);
    } catch (const core::InputError& e) {
      return std::string(e.what()).find(key) != std::string::npos;
    }
    return false;
  };
  EXPECT_TRUE(refused("rgb.fov", "170 deg"));
  EXPECT_TRUE(refused("rgb.width", "3"));
  EXPECT_TRUE(refused("rgb.light", "torch"));
  EXPECT_TRUE(refused("rgb.rate", "0 Hz"));
  EXPECT_TRUE(refused("rgb.intensity", "5 m"));
  t.set("mission.info", "rgb.fov", "90 deg");
  EXPECT_NEAR(sim::rgb_camera_model(o)->camera.horizontal_fov_rad, std::numbers::pi / 2, 1e-12);
}

}  // namespace
}  // namespace karst::test
