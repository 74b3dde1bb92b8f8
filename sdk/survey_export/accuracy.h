// How far a leg may be off, from what the flight itself recorded (localization.csv, trajectory.tum).
#pragma once
#include <cstddef>
#include <vector>

#include "core_stack/common/geometry.h"
#include "sdk/evaluation/record/poses.h"
#include "sdk/evaluation/record/table.h"

namespace karst::survey_export {

/// The localization has no absolute position inside a cave: each scan is matched to what earlier scans built,
/// and its error passes on to what is built of it. If errors of scans are independent, their variances add
/// up: drift is a random walk over the distance flown. So the variance of a leg of length L in each axis is
///   sd^2 = 2 cell_m^2 / 12 + growth_m2_per_m * L,
/// where the first term is that of two ends which lie anywhere in their cells.
struct Accuracy {
  double cell_m = 0;
  double growth_m2_per_m = 0;  // sum of the variances of the scans in motion over the distance flown
  std::size_t scans = 0;       // of which it was found; 0: the run has no record, only the cells count
  double flown_m = 0;

  double leg_sd_m(double length_m) const;
};

/// `localization`: the table of localization.csv with columns stamp_s and position_sigma_m. Scans between
/// which the vehicle moved less than a centimetre match the same surroundings, and count once.
Accuracy accuracy_of(const evaluation::Table& localization,
                     const std::vector<evaluation::StampedPose>& estimate, double cell_m);

}  // namespace karst::survey_export
