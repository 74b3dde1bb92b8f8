// Finds places again along a recorded path, and corrects the path so that they coincide.
//
//   sweeps with their poses --submaps--> similar places within what the odometry may have drifted
//     --registration--> credible closures --agreement with others--> pose graph --> corrected path
//
// A closure counts only if another one nearby, of another submap, implies the same pose: a single accidental
// fit changes nothing. docs/loops.md
#pragma once
#include <vector>

#include "core_stack/common/enum_names.h"
#include "core_stack/loops/closure.h"
#include "core_stack/loops/pose_graph.h"
#include "core_stack/loops/track_correction.h"

namespace karst::core {

struct LoopOptions {
  SubmapOptions submaps;
  ClosureLimits limits;
  double min_path_m = 30;       // between the submaps of a closure
  double drift = 0.03;          // of the odometry at most, in parts of the path: where a place is looked for
  double search_m = 3;          // in addition to the drift
  double min_likeness = 0.6;    // of two places' descriptors
  std::int64_t candidates = 3;  // of similar places that are registered, for each submap
};
void describe(OptionTable& t, LoopOptions& o);

enum class ClosureState {
  alone,     // no other closure confirms it: not used
  closed,    // used
  outvoted,  // confirmed, but the graph gives it little weight
};
constexpr auto names_of(ClosureState) {
  using enum ClosureState;
  return std::to_array<Named<ClosureState>>({{alone, "alone"}, {closed, "closed"}, {outvoted, "outvoted"}});
}

struct FoundClosure {
  Closure closure;
  ClosureState state = ClosureState::alone;
  Pose correction;  // of the newer submap in its own frame, against the graph at that time
};

class LoopClosing {
 public:
  /// `gravity_known`: the z axes of the poses are up. `threads` share the work; results do not depend on it.
  LoopClosing(const LoopOptions& options, bool gravity_known, int threads);

  /// A sweep, in the order of time. Closures are looked for when a submap is complete.
  void add(const SubmapBuilder::Seen& seen);
  /// Completes the last submap and solves the graph.
  void finish();

  const std::vector<Submap>& submaps() const { return submaps_; }
  const std::vector<FoundClosure>& closures() const { return closures_; }
  /// Number of those used.
  std::size_t closed() const;
  std::size_t bytes() const;
  double path_m() const { return submaps_.empty() ? 0 : submaps_.back().path_end_m; }
  /// The corrected poses of the submaps, in the world frame.
  const std::vector<Pose>& poses() const { return poses_; }
  TrackCorrection correction() const;

 private:
  struct Guess {
    std::size_t older;
    Pose T_older_newer;
  };
  void take(Submap submap);
  void look_for_closures(std::size_t newer);
  std::vector<double> uncertainty_from(std::size_t submap) const;
  std::vector<Guess> guesses(std::size_t newer, const std::vector<double>& uncertainty_m) const;
  bool agree(const Closure& a, const Closure& b) const;
  void confirm(std::size_t closure);
  void solve();

  LoopOptions options_;
  bool gravity_known_;
  SubmapBuilder builder_;
  Workspace workspace_;
  std::vector<Submap> submaps_;
  std::vector<Pose> poses_;
  std::vector<FoundClosure> closures_;
};

}  // namespace karst::core
