#include "sdk/survey_export/accuracy.h"

#include <gtest/gtest.h>

#include <cmath>

namespace karst::survey_export {
namespace {

/// 10 Hz at 1 m/s along x for `moving` scans, then standing still.
struct Flight {
  evaluation::Table scans;
  std::vector<evaluation::StampedPose> poses;
  Flight(int moving, int standing, double sigma_m) {
    for (int i = 0; i <= moving + standing; ++i) {
      evaluation::StampedPose p;
      p.t_s = 0.1 * i;
      p.T_world_body.position.x() = 0.1 * std::min(i, moving);
      poses.push_back(p);
      scans.numbers["stamp_s"].push_back(p.t_s);
      scans.numbers["position_sigma_m"].push_back(sigma_m);
      ++scans.rows;
    }
  }
};

TEST(Accuracy, VariancesOfScansAddUpOverTheDistanceFlown) {
  const Flight flight(100, 0, 0.02);
  const Accuracy a = accuracy_of(flight.scans, flight.poses, 0.2);
  EXPECT_EQ(a.scans, 100u);
  EXPECT_NEAR(a.flown_m, 10, 1e-6);
  EXPECT_NEAR(a.growth_m2_per_m, 0.02 * 0.02 * 10, 1e-9);  // ten scans a metre
  EXPECT_NEAR(a.leg_sd_m(10), std::sqrt(2 * 0.2 * 0.2 / 12 + 0.04), 1e-6);
}

TEST(Accuracy, AVehicleThatHoversDoesNotDrift) {
  const Flight flight(100, 0, 0.02), hovering(100, 500, 0.02);
  EXPECT_NEAR(accuracy_of(flight.scans, flight.poses, 0.2).growth_m2_per_m,
              accuracy_of(hovering.scans, hovering.poses, 0.2).growth_m2_per_m, 1e-9);
}

TEST(Accuracy, WithoutARecordOnlyTheCellsCount) {
  const Flight flight(10, 0, 0.02);
  for (const Accuracy& a : {accuracy_of({}, flight.poses, 0.2), accuracy_of(flight.scans, {}, 0.2)}) {
    EXPECT_EQ(a.scans, 0u);
    EXPECT_NEAR(a.leg_sd_m(100), 0.2 / std::sqrt(6.0), 1e-9);
  }
  const Flight unknown(10, 0, std::nan(""));
  EXPECT_EQ(accuracy_of(unknown.scans, unknown.poses, 0.2).scans, 0u);
}

}  // namespace
}  // namespace karst::survey_export
