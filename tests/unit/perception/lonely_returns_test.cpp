#include "core_stack/perception/lonely_returns.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core_stack/common/random.h"

namespace karst::core {
namespace {

std::shared_ptr<const LidarModel> unit(int columns, int channels, double half_fov_rad) {
  auto model = std::make_shared<LidarModel>();
  model->columns = columns;
  for (int i = 0; i < channels; ++i)
    model->elevation_rad.push_back(static_cast<float>(half_fov_rad * (1 - 2.0 * i / (channels - 1))));
  return model;
}

/// The walls of a box around the sensor, turned, so that beams meet them at every incidence.
LidarScan room(const std::shared_ptr<const LidarModel>& model, double turn_rad, float intensity = 0.05f) {
  LidarScan scan{0, model, {}, {}};
  const Eigen::Matrix3f R =
      Eigen::AngleAxisf(static_cast<float>(turn_rad), Vec3f(0.2f, 0.3f, 1).normalized()).toRotationMatrix();
  for (int c = 0; c < model->channels(); ++c)
    for (int j = 0; j < model->columns; ++j) {
      const Vec3f d = R * model->direction(c, j);
      scan.range_m.push_back((Vec3f(5, 2.5f, 2).array() / d.array().abs()).minCoeff());
      scan.intensity.push_back(intensity);
    }
  return scan;
}

double dropped_fraction(const LidarScan& before, const LidarScan& after) {
  double finite = 0, dropped = 0;
  for (std::size_t i = 0; i < before.range_m.size(); ++i) {
    finite += std::isfinite(before.range_m[i]);
    dropped += std::isfinite(before.range_m[i]) && std::isnan(after.range_m[i]);
  }
  return dropped / finite;
}

TEST(LonelyReturns, DimWallsStayAtAnyIncidenceAlsoInCornersAndWithNoise) {
  for (const auto& model : {unit(1024, 64, 0.39), unit(512, 32, 0.785), unit(900, 16, 0.26)}) {
    for (int turn = 0; turn < 6; ++turn) {
      LidarScan scan = room(model, 0.3 * turn);
      const LidarScan before = scan;
      drop_lonely_returns(scan, {});
      EXPECT_LT(dropped_fraction(before, scan), 0.003) << model->columns << " " << turn;
      Random random(3);
      scan = before;
      for (float& r : scan.range_m) r += 0.02f * static_cast<float>(random.normal());
      const LidarScan noisy = scan;
      drop_lonely_returns(scan, {});
      EXPECT_LT(dropped_fraction(noisy, scan), 0.01) << model->columns << " " << turn;
    }
  }
}

TEST(LonelyReturns, EchoesFromAnywhereInFrontOfTheWallsGoAndTheWallsStay) {
  for (const double fraction : {0.01, 0.1, 0.3, 0.45}) {
    LidarScan scan = room(unit(1024, 64, 0.39), 0.4);
    Random random(5);
    std::vector<bool> dust;
    for (float& r : scan.range_m) {
      dust.push_back(random.uniform() < fraction);
      if (dust.back()) r = static_cast<float>(random.uniform(0.3, 0.9 * static_cast<double>(r)));
    }
    const LidarScan before = scan;
    drop_lonely_returns(scan, {});
    double removed = 0, lost = 0, n = 0;
    for (std::size_t i = 0; i < dust.size(); ++i) {
      const bool gone = std::isnan(scan.range_m[i]);
      n += dust[i], removed += dust[i] && gone, lost += !dust[i] && gone;
    }
    EXPECT_GT(removed / n, 0.97) << fraction;
    EXPECT_LT(lost / (static_cast<double>(dust.size()) - n), fraction < 0.4 ? 0.03 : 0.2) << fraction;
  }
}

TEST(LonelyReturns, BrightOnesAndThoseFarAwayAreKept) {
  LidarScan scan = room(unit(512, 32, 0.5), 0);
  scan.range_m[5000] = 1, scan.intensity[5000] = 0.5f;
  scan.range_m[6000] = 1;
  scan.range_m[7000] = 20;
  drop_lonely_returns(scan, {});
  EXPECT_EQ(scan.range_m[5000], 1);
  EXPECT_TRUE(std::isnan(scan.range_m[6000]));
  EXPECT_EQ(scan.range_m[7000], 20);
}

/// Returns left of a spar so many beams wide that stands 1.2 m away before the wall.
double left_of_spar(std::size_t width, float intensity) {
  LidarScan scan = room(unit(1024, 64, 0.39), 0);
  for (std::size_t row = 0; row < 64; ++row)
    for (std::size_t j = 300; j < 300 + width; ++j)
      scan.range_m[row * 1024 + j] = 1.2f, scan.intensity[row * 1024 + j] = intensity;
  drop_lonely_returns(scan, {});
  double left = 0;
  for (std::size_t row = 0; row < 64; ++row)
    for (std::size_t j = 300; j < 300 + width; ++j) left += scan.range_m[row * 1024 + j] == 1.2f;
  return left / static_cast<double>(64 * width);
}

TEST(LonelyReturns, ASparStaysIfItIsBrightAndADimOneFromFiveBeamsWide) {
  EXPECT_EQ(left_of_spar(1, 0.4f), 1);
  EXPECT_GT(left_of_spar(5, 0.05f), 0.8) << "37 mm wide where it stands";
  EXPECT_EQ(left_of_spar(2, 0.05f), 0) << "the price: it cannot be told from dust";
}

TEST(LonelyReturns, NothingButDropsAndTheRingHasNoSeam) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Random random(seed);
    const auto model = unit(64, 8, 0.3);
    LidarScan scan = room(model, random.uniform(0, 3), 0.1f);
    for (float& r : scan.range_m) {
      const double kind = random.uniform();
      if (kind < 0.3) r = static_cast<float>(random.uniform(0.3, 5));
      if (kind < 0.1) r = std::numeric_limits<float>::infinity();
      if (kind < 0.05) r = std::numeric_limits<float>::quiet_NaN();
    }
    LidarScan turned = scan;
    const int shift = 1 + static_cast<int>(random.uniform(0, 63));
    for (int c = 0; c < 8; ++c)
      std::rotate(turned.range_m.begin() + 64 * c, turned.range_m.begin() + 64 * c + shift,
                  turned.range_m.begin() + 64 * (c + 1));
    const LidarScan before = scan;
    drop_lonely_returns(scan, {});
    drop_lonely_returns(turned, {});
    for (std::size_t i = 0; i < scan.range_m.size(); ++i) {
      if (!std::isnan(scan.range_m[i])) RC_ASSERT(scan.range_m[i] == before.range_m[i]);
      if (!std::isfinite(before.range_m[i]))
        RC_ASSERT(std::isnan(scan.range_m[i]) == std::isnan(before.range_m[i]));
      const std::size_t there = i / 64 * 64 + (i % 64 + 64 - static_cast<std::size_t>(shift)) % 64;
      RC_ASSERT(std::isnan(turned.range_m[there]) == std::isnan(scan.range_m[i]));
    }
  }));
}

TEST(LonelyReturns, ScansItCannotJudgeAreLeftAlone) {
  LidarScan no_model{0, nullptr, {1, 1}, {0, 0}};
  drop_lonely_returns(no_model, {});
  EXPECT_EQ(no_model.range_m, (std::vector<float>{1, 1}));
  LidarScan short_scan{0, unit(64, 8, 0.3), {1, 2, 3}, {0, 0, 0}};
  drop_lonely_returns(short_scan, {});
  EXPECT_EQ(short_scan.range_m, (std::vector<float>{1, 2, 3}));
  LidarScan no_intensity = room(unit(64, 8, 0.3), 0);
  no_intensity.intensity.clear();
  const auto ranges = no_intensity.range_m;
  drop_lonely_returns(no_intensity, {});
  EXPECT_EQ(no_intensity.range_m, ranges);
  LidarScan nothing = room(unit(64, 8, 0.3), 0);
  std::fill(nothing.range_m.begin(), nothing.range_m.end(), std::numeric_limits<float>::infinity());
  drop_lonely_returns(nothing, {});
  EXPECT_EQ(nothing.range_m, std::vector<float>(512, std::numeric_limits<float>::infinity()));
  LidarScan one_row{0, unit(64, 2, 0.1), std::vector<float>(128, 2.0f), std::vector<float>(128, 0.1f)};
  drop_lonely_returns(one_row, {});
  EXPECT_EQ(one_row.range_m, std::vector<float>(128, 2.0f));
}

// Channels of uneven azimuths are compared with the beams that lie beside them, not with those of their
// column.
TEST(LonelyReturns, ChannelsWithAzimuthsOfTheirOwnLoseNoWalls) {
  auto uneven = std::make_shared<LidarModel>(*unit(1024, 64, 0.39));
  for (int c = 0; c < 64; ++c) uneven->azimuth_offset_rad.push_back(0.07f * static_cast<float>(c % 4) - 0.1f);
  LidarScan scan = room(uneven, 0.4);
  const LidarScan before = scan;
  drop_lonely_returns(scan, {});
  EXPECT_LT(dropped_fraction(before, scan), 0.003);
}

/// The room, seen by beams scattered over a belt of the sphere; a share of them returns from dust before it.
LidarScan scattered_room(double dust, std::vector<char>& is_dust) {
  auto model = std::make_shared<LidarModel>();
  model->elevation_rad = {0.9f, -0.12f};
  LidarScan scan{0, model, {}, {}};
  Random random(4);
  for (int i = 0; i < 20000; ++i) {
    const double azimuth = 2.399963 * i, z = -0.12 + 0.9 * std::fmod(0.754877 * i, 1.0);
    const Vec3f d =
        Vec3(std::sqrt(1 - z * z) * std::cos(azimuth), std::sqrt(1 - z * z) * std::sin(azimuth), z)
            .cast<float>();
    const float wall = (Vec3f(5, 2.5f, 2).array() / d.array().abs()).minCoeff();
    is_dust.push_back(random.uniform() < dust);
    scan.range_m.push_back(is_dust.back() ? static_cast<float>(random.uniform(0.3, 1.5))
                                          : wall + 0.02f * static_cast<float>(random.normal()));
    scan.intensity.push_back(0.05f);
    scan.direction.push_back(d);
    scan.time_s.push_back(0);
  }
  return scan;
}

TEST(LonelyPoints, DimWallsStayAndDustGoes) {
  for (const double dust : {0.0, 0.02, 0.1}) {
    std::vector<char> is_dust;
    LidarScan scan = scattered_room(dust, is_dust);
    drop_lonely_returns(scan, {});
    double walls = 0, walls_lost = 0, dusts = 0, dusts_left = 0;
    for (std::size_t i = 0; i < is_dust.size(); ++i) {
      const bool left = std::isfinite(scan.range_m[i]);
      (is_dust[i] ? dusts : walls) += 1;
      if (is_dust[i] && left) ++dusts_left;
      if (!is_dust[i] && !left) ++walls_lost;
    }
    EXPECT_LT(walls_lost / walls, 0.02) << dust;
    EXPECT_LE(dusts_left, 0.12 * dusts) << dust;
  }
}

TEST(LonelyPoints, BrightAndFarPointsStayAndAScanThatDoesNotFitIsLeft) {
  std::vector<char> is_dust;
  LidarScan scan = scattered_room(0.1, is_dust);
  LidarScan bright = scan, broken = scan;
  std::fill(bright.intensity.begin(), bright.intensity.end(), 0.4f);
  drop_lonely_returns(bright, {});
  EXPECT_EQ(bright.range_m, scan.range_m);
  broken.direction.pop_back();
  drop_lonely_returns(broken, {});
  EXPECT_EQ(broken.range_m, scan.range_m);
}

}  // namespace
}  // namespace karst::core
