#include "sdk/evaluation/metrics/replay_figures.h"

#include <algorithm>

#include "core_stack/loops/loop_closing.h"

namespace karst::evaluation {
namespace {

/// Of poses with the same stamps; both in the order of time.
std::optional<double> greatest_distance_m(const std::vector<StampedPose>& before,
                                          const std::vector<StampedPose>& after) {
  std::optional<double> greatest;
  auto b = before.begin();
  for (const StampedPose& a : after) {
    b = std::find_if(b, before.end(), [&](const StampedPose& p) { return p.t_s >= a.t_s; });
    if (b == before.end()) break;
    if (b->t_s == a.t_s)
      greatest = std::max(greatest.value_or(0), (a.T_world_body.position - b->T_world_body.position).norm());
  }
  return greatest;
}

}  // namespace

std::optional<ReplayFigures> replay_figures(const RunRecord& run) {
  std::filesystem::path recording = run.setting("replay.scans");
  if (recording.empty()) return std::nullopt;
  if (!recording.has_filename()) recording = recording.parent_path();  // a folder's, with a slash at its end
  ReplayFigures figures;
  figures.recording = recording.filename().string();
  figures.scans = run.telemetry.rows;
  figures.lost = figures.scans - std::min(figures.scans, run.estimate.size());
  if (const auto state = run.loops.text.find("state"); state != run.loops.text.end())
    figures.closures = static_cast<std::size_t>(
        std::count(state->second.begin(), state->second.end(), core::name_of(core::ClosureState::closed)));
  figures.correction_m = greatest_distance_m(run.odometry, run.estimate);
  return figures;
}

}  // namespace karst::evaluation
