#include "sdk/flight/truth_of_flight.h"

#include <boost/property_tree/ptree.hpp>
#include <cmath>
#include <vector>

#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/options.h"
#include "sdk/evaluation/record/run_record.h"

namespace karst::flight {
namespace {

namespace fs = std::filesystem;
using core::format_text;

constexpr double kStart_m = 1;  // the estimate begins where the mission says that the vehicle stands
// The length of the estimate's path may differ from the true one by so much: it leaps where the pose was
// lost. Times may differ by more: the clock of a process that stood still is set back.
constexpr double kLength_m = 3, kLengthFraction = 0.2;

/// "" if it is not recorded, or cannot be read.
std::string seed_of(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::exists(folder / "mission.info", ignored)) return "";
  try {
    return core::read_info((folder / "mission.info").string()).get("seed", "");
  } catch (const core::InputError&) {
    return "";
  }
}

/// Steps count from 0.1 m on: the jitter of a vehicle that waits is no path.
double path_length_m(const std::vector<evaluation::StampedPose>& poses) {
  constexpr double kStep_m = 0.1;
  double length_m = 0;
  core::Vec3 last = poses.front().T_world_body.position;
  for (const evaluation::StampedPose& pose : poses) {
    const double step_m = (pose.T_world_body.position - last).norm();
    if (step_m < kStep_m) continue;
    length_m += step_m;
    last = pose.T_world_body.position;
  }
  return length_m;
}

bool has_landed(const evaluation::RunRecord& run) {
  const auto outcome = run.last<core::event::Outcome>();
  return outcome && outcome->outcome == core::MissionOutcome::landed;
}

}  // namespace

void check_same_flight(const fs::path& run_dir, const fs::path& truth) {
  const auto refuse = [&](const std::string& difference) {
    throw core::InputError(truth.string(), "",
                           "is the truth of another flight than " + run_dir.string() + ": " + difference);
  };
  if (const std::string of_run = seed_of(run_dir), of_truth = seed_of(truth);
      !of_run.empty() && !of_truth.empty() && of_run != of_truth)
    refuse("its seed is " + of_truth + ", and not " + of_run);
  const evaluation::RunRecord run = evaluation::read_run(run_dir);
  std::vector<std::string> problems;
  const auto poses = evaluation::read_tum(truth / "ground_truth.tum", problems);
  if (run.estimate.empty() || poses.empty()) return;
  const core::Vec3 start = run.estimate.front().T_world_body.position,
                   true_start = poses.front().T_world_body.position;
  if ((start - true_start).norm() > kStart_m)
    refuse(format_text("it begins at (%.1f, %.1f, %.1f), and not at (%.1f, %.1f, %.1f)", true_start.x(),
                       true_start.y(), true_start.z(), start.x(), start.y(), start.z()));
  // A vehicle whose core is gone flies on for a while, and a core whose vehicle is gone waits for it.
  const double length_m = path_length_m(run.estimate), true_m = path_length_m(poses);
  if (has_landed(run) && std::abs(length_m - true_m) > kLength_m + kLengthFraction * length_m)
    refuse(format_text("its path is %.1f m long, and not %.1f m", true_m, length_m));
}

}  // namespace karst::flight
