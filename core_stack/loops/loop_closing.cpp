#include "core_stack/loops/loop_closing.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "core_stack/common/so3.h"

namespace karst::core {
namespace {

constexpr double kNear_m = 6;       // a submap nearer than this by the graph is tried whatever it looks like
constexpr double kClosure_m = 0.1;  // uncertainty across a closure
constexpr double kTied_m = 0.2;     // a submap less uncertain than this against an old one is not tried
constexpr double kSamePose_m = 1, kSamePose_rad = 0.1;    // fits nearer than this to each other are one
constexpr double kTurn_rad = 0.15, kTurnPerMetre = 0.02;  // greatest correction of the rotation
// Closures agree if they are near each other along both paths and imply the same pose.
constexpr double kAgreePath_m = 25, kAgree_m = 0.3, kAgreePerMetre = 0.01, kAgree_rad = 0.035;
constexpr double kUrgent_m = 0.1;  // a closure that moves a submap by more is solved at once
// Standard deviations of the odometry from one submap to the next.
constexpr double kStep_m = 0.02, kStepPerMetre = 0.005, kStep_rad = 0.002;
constexpr double kUnobservedFactor = 10;  // where a direction was not observed
constexpr double kUp_rad = 0.01;          // of a submap's z axis, if gravity is known
constexpr double kMaxTiltUnknown_rad = 0.35;
constexpr double kLowWeight = 0.3;  // of the robust kernel: the graph contradicts the closure

double turn_of(const Pose& T) { return log_so3(T.orientation).norm(); }

GraphEdge odometry_edge(const Submap& from, const Submap& to, double further_m, std::size_t index) {
  const double factor = from.observed ? 1 : kUnobservedFactor;
  const double length_m = to.path_begin_m - from.path_begin_m;
  // What was not seen at all (further_m) may have been flown in any way.
  const double position_m = factor * (kStep_m + kStepPerMetre * length_m) + further_m;
  const double rotation_rad = factor * kStep_rad + 0.1 * further_m;
  GraphEdge e{index, index + 1, from.T_world_submap.inverse() * to.T_world_submap, Matrix6::Zero(), false};
  e.information.diagonal().head<3>().setConstant(1 / (position_m * position_m));
  e.information.diagonal().tail<3>().setConstant(1 / (rotation_rad * rotation_rad));
  return e;
}

GraphEdge closure_edge(const Closure& c) {
  // The error of an edge is in the newer frame, the covariance of the translation in the older one.
  Matrix6 to_newer = Matrix6::Identity();
  to_newer.topLeftCorner<3, 3>() = c.T_older_newer.orientation.conjugate().toRotationMatrix();
  const Matrix6 covariance = to_newer * c.covariance * to_newer.transpose();
  return {c.older, c.newer, c.T_older_newer, covariance.inverse(), true};
}

}  // namespace

void describe(OptionTable& t, LoopOptions& o) {
  t.section("submaps", o.submaps);
  t.section("limits", o.limits);
  t.add("min_path", o.min_path_m, "m", 5, 10'000, "path between the two visits of a place");
  t.add("drift", o.drift, "", 0, 1, "of the odometry at most, in parts of the path");
  t.add("search", o.search_m, "m", 0, 1000, "how much farther away than the drift a place is looked for");
  t.add("min_likeness", o.min_likeness, "", 0, 1, "of two places that are registered");
  t.add("candidates", o.candidates, 0, 100, "similar places that are registered, for each submap");
}

LoopClosing::LoopClosing(const LoopOptions& options, bool gravity_known, int threads)
    : options_(options), gravity_known_(gravity_known), builder_(options.submaps), workspace_{threads, {}} {
  if (!gravity_known_)
    options_.limits.max_tilt_rad = std::max(options_.limits.max_tilt_rad, kMaxTiltUnknown_rad);
}

void LoopClosing::add(const SubmapBuilder::Seen& seen) {
  if (std::optional<Submap> complete = builder_.add(seen)) take(std::move(*complete));
}

void LoopClosing::finish() {
  if (std::optional<Submap> last = builder_.finish()) take(std::move(*last));
  solve();
}

void LoopClosing::take(Submap submap) {
  const std::size_t n = submaps_.size();
  poses_.push_back(n == 0 ? submap.T_world_submap
                          : poses_.back() * submaps_.back().T_world_submap.inverse() * submap.T_world_submap);
  submaps_.push_back(std::move(submap));
  look_for_closures(n);
}

/// How far each submap may be from where the graph says, seen from `submap`: the least uncertain way along
/// the path and across closures (Dijkstra).
std::vector<double> LoopClosing::uncertainty_from(std::size_t submap) const {
  std::vector<std::vector<std::size_t>> across(submaps_.size());
  for (const FoundClosure& f : closures_) {
    if (f.state != ClosureState::closed) continue;
    across[f.closure.older].push_back(f.closure.newer);
    across[f.closure.newer].push_back(f.closure.older);
  }
  std::vector<double> least(submaps_.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const auto reach = [&](std::size_t i, double m) {
    if (m < least[i]) open.emplace(least[i] = m, i);
  };
  reach(submap, 0);
  while (!open.empty()) {
    const auto [m, i] = open.top();
    open.pop();
    if (m > least[i]) continue;
    const auto along = [&, m = m, i = i](std::size_t k) {  // clang 14 captures no structured bindings
      reach(k, m + std::abs(submaps_[k].uncertainty_m - submaps_[i].uncertainty_m) +
                   options_.drift * std::abs(submaps_[k].path_begin_m - submaps_[i].path_begin_m));
    };
    if (i > 0) along(i - 1);
    if (i + 1 < submaps_.size()) along(i + 1);
    for (const std::size_t k : across[i]) reach(k, m + kClosure_m);
  }
  return least;
}

std::vector<LoopClosing::Guess> LoopClosing::guesses(std::size_t newer,
                                                     const std::vector<double>& uncertainty_m) const {
  const Submap& s = submaps_[newer];
  struct Alike {
    float likeness;
    std::size_t older, place, of_newer;
  };
  std::vector<Alike> alike;
  std::optional<std::size_t> nearest;
  double nearest_m = kNear_m;
  for (std::size_t i = 0; i < newer && s.path_begin_m - submaps_[i].path_end_m >= options_.min_path_m; ++i) {
    const double distance_m = (poses_[i].position - poses_[newer].position).norm();
    if (distance_m < nearest_m) nearest = i, nearest_m = distance_m;
    if (distance_m > options_.search_m + kNear_m + uncertainty_m[i]) continue;
    Alike best{0, i, 0, 0};
    for (std::size_t a = 0; a < submaps_[i].places.size(); ++a)
      for (std::size_t b = 0; b < s.places.size(); ++b) {
        const float likeness =
            submaps_[i].places[a].descriptor.invariants().dot(s.places[b].descriptor.invariants());
        if (likeness > best.likeness) best = {likeness, i, a, b};
      }
    if (static_cast<double>(best.likeness) >= options_.min_likeness) alike.push_back(best);
  }
  std::stable_sort(alike.begin(), alike.end(),
                   [](const Alike& a, const Alike& b) { return a.likeness > b.likeness; });
  alike.resize(std::min(alike.size(), static_cast<std::size_t>(options_.candidates)));

  std::vector<Guess> out;
  if (nearest) out.push_back({*nearest, poses_[*nearest].inverse() * poses_[newer]});
  for (const Alike& a : alike) {
    const Place &to = submaps_[a.older].places[a.place], &from = s.places[a.of_newer];
    const Quat R = from_heading(to.descriptor.turn_of(from.descriptor).angle_rad);
    out.push_back({a.older, {to.position - R * from.position, R}});
  }
  return out;
}

void LoopClosing::look_for_closures(std::size_t newer) {
  const std::vector<double> uncertainty_m = uncertainty_from(newer);
  for (std::size_t i = 0; i < newer; ++i)
    if (submaps_[newer].path_begin_m - submaps_[i].path_end_m >= options_.min_path_m &&
        uncertainty_m[i] < kTied_m)
      return;
  const std::vector<Guess> starts = guesses(newer, uncertainty_m);
  if (starts.empty()) return;

  const double voxel_m = options_.submaps.voxel_m;
  const SubmapRock rock(submaps_[newer], voxel_m);
  std::vector<Closure> fits;
  for (const Guess& g : starts) {
    const SubmapRock older(submaps_[g.older], voxel_m);
    Closure c = registered(older, rock, g.T_older_newer, options_.limits, workspace_);
    c.older = g.older, c.newer = newer;
    fits.push_back(c);
  }
  const auto correction = [&](const Closure& c) {
    return (poses_[c.older].inverse() * poses_[newer]).inverse() * c.T_older_newer;
  };
  const auto within_drift = [&](const Closure& c) {
    const Pose d = correction(c);
    return d.position.norm() <= options_.search_m + uncertainty_m[c.older] &&
           turn_of(d) <= kTurn_rad + kTurnPerMetre * uncertainty_m[c.older];
  };
  const Closure* best = nullptr;
  for (const Closure& c : fits)
    if (c.problem.empty() && within_drift(c) && (!best || c.overlap > best->overlap)) best = &c;
  if (!best) return;
  const Pose where = poses_[best->older] * best->T_older_newer;
  for (const Closure& c : fits) {
    const Pose between = where.inverse() * (poses_[c.older] * c.T_older_newer);
    const double apart_m = std::abs(uncertainty_m[c.older] - uncertainty_m[best->older]);
    const bool other = between.position.norm() > kSamePose_m + apart_m || turn_of(between) > kSamePose_rad;
    if (other && within_drift(c) && c.overlap >= options_.limits.max_rival * best->overlap) return;
  }
  closures_.push_back({*best, ClosureState::alone, correction(*best)});
  confirm(closures_.size() - 1);
}

bool LoopClosing::agree(const Closure& a, const Closure& b) const {
  if (a.newer == b.newer) return false;
  const auto path_m = [&](std::size_t i, std::size_t k) {
    return std::abs(submaps_[i].path_begin_m - submaps_[k].path_begin_m);
  };
  const double newer_m = path_m(a.newer, b.newer), older_m = path_m(a.older, b.older);
  if (newer_m > kAgreePath_m || older_m > kAgreePath_m) return false;
  const auto odometry = [&](std::size_t i, std::size_t k) {
    return submaps_[i].T_world_submap.inverse() * submaps_[k].T_world_submap;
  };
  const Pose by_b = odometry(a.older, b.older) * b.T_older_newer * odometry(b.newer, a.newer);
  const Pose between = a.T_older_newer.inverse() * by_b;
  return between.position.norm() <= kAgree_m + kAgreePerMetre * (newer_m + older_m) &&
         turn_of(between) <= kAgree_rad;
}

void LoopClosing::confirm(std::size_t closure) {
  FoundClosure& found = closures_[closure];
  bool urgent = false;
  for (std::size_t i = 0; i < closure; ++i) {
    FoundClosure& other = closures_[i];
    if (other.state == ClosureState::outvoted || !agree(found.closure, other.closure)) continue;
    for (FoundClosure* f : {&found, &other}) {
      urgent = urgent || (f->state == ClosureState::alone && f->correction.position.norm() > kUrgent_m);
      f->state = ClosureState::closed;
    }
  }
  if (urgent) solve();
}

void LoopClosing::solve() {
  std::vector<GraphEdge> edges;
  for (std::size_t i = 0; i + 1 < submaps_.size(); ++i)
    edges.push_back(odometry_edge(submaps_[i], submaps_[i + 1],
                                  submaps_[i + 1].uncertainty_m - submaps_[i].uncertainty_m, i));
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < closures_.size(); ++i) {
    if (closures_[i].state == ClosureState::alone) continue;
    used.push_back(i);
    edges.push_back(closure_edge(closures_[i].closure));
  }
  if (used.empty()) return;  // the odometry stays as it is, to the last bit
  PoseGraphOptions graph;
  if (gravity_known_) graph.up_sigma_rad = kUp_rad;
  PoseGraphResult solved = optimize(poses_, edges, graph);
  for (std::size_t i = 0; i < used.size(); ++i)
    closures_[used[i]].state = solved.weights[edges.size() - used.size() + i] < kLowWeight
                                   ? ClosureState::outvoted
                                   : ClosureState::closed;
  poses_ = std::move(solved.poses);
}

std::size_t LoopClosing::closed() const {
  return static_cast<std::size_t>(std::count_if(
      closures_.begin(), closures_.end(), [](const auto& f) { return f.state == ClosureState::closed; }));
}

std::size_t LoopClosing::bytes() const {
  std::size_t sum = 0;
  for (const Submap& s : submaps_) sum += s.bytes();
  return sum;
}

TrackCorrection LoopClosing::correction() const {
  if (closed() == 0) return {};
  std::vector<TrackCorrection::Anchor> anchors;
  for (std::size_t i = 0; i < submaps_.size(); ++i)
    anchors.push_back({submaps_[i].first, submaps_[i].T_world_submap, poses_[i]});
  return TrackCorrection(std::move(anchors));
}

}  // namespace karst::core
