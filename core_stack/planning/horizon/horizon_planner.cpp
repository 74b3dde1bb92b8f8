#include "core_stack/planning/horizon/horizon_planner.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core_stack/common/random.h"

namespace karst::core {
namespace {

constexpr double kHorizon_s = kLegs * seconds(kLeg);
constexpr int kHorizonSamples = static_cast<int>(kLegs * kLeg / kRolloutPeriod);
constexpr int kViews = 4;  // along the horizon
constexpr int kFirst = 24, kElites = 6, kChildren = 8, kRounds = 3;
constexpr int kMoreForHeadings = 2;  // times as many candidates where headings vary, too
constexpr double kSpread = 0.6, kHeadingSpread_rad = 0.8;  // of the first round; of the maximal speed
constexpr double kNarrower = 0.5;                          // a round
constexpr double kBetter_s = 0.1;                          // than what is under way, to be worth a change
constexpr double kFlies_mps = 0.2;                         // or else it has no direction
constexpr double kNear_m = 1.0;                            // of the goal it turns to its heading at last
constexpr double kRounding = 1e-6;                         // of a cell
constexpr double kLevel_m = 1.0;                           // may be climbed whatever the sensors see

struct Candidate {
  Legs legs;
  Rollout motion;
  double value_s = 0, time_left_s = 0;
};

class Search {
 public:
  Search(const VoxelMap& map, const Roadmap& roadmap, const DistanceTree& to_goal,
         const std::vector<ViewRay>& rays, const HorizonQuery& q)
      : map_(map), roadmap_(roadmap), to_goal_(to_goal), q_(q), random_(q.seed) {
    if (q.worth_s_per_m3 > 0)
      local_.emplace(map, q.start.position, kHorizon_s * q.limits.max_speed_mps, rays);
  }

  std::optional<HorizonPlan> run() {
    std::vector<Candidate> best;
    const int many = q_.turns ? kMoreForHeadings : 1;
    const std::vector<Legs> seeds = first_guesses();
    for (const Legs& legs : seeds) consider(legs, best);
    for (int i = 0; i < many * kFirst; ++i)
      consider(varied(seeds[static_cast<std::size_t>(i) % seeds.size()], 1), best);
    double spread = 1;
    for (int round = 0; round < kRounds; ++round) {
      keep_best(best);
      spread *= kNarrower;
      std::vector<Legs> parents;
      for (const Candidate& c : best) parents.push_back(c.legs);
      for (const Legs& legs : parents)
        for (int i = 0; i < many * kChildren; ++i) consider(varied(legs, spread), best);
    }
    keep_best(best);
    if (best.empty() || !(best.front().value_s > value_under_way() + kBetter_s)) return std::nullopt;
    Candidate& c = best.front();
    return HorizonPlan{q_.start, std::move(c.motion.samples), c.legs, kHorizon_s + c.time_left_s};
  }

 private:
  /// The last plan, the shortest path to the goal fast and slowly, and to stay and face as the goal asks.
  std::vector<Legs> first_guesses() {
    std::vector<Legs> out;
    if (q_.last) out.push_back(*q_.last);
    const Path path = to_goal_.find(map_, roadmap_, q_.start.position);
    if (path.found() && path.points.size() > 1) {
      const std::vector<Vec3> way = without_zigzags(path.points);
      for (const double share : {1.0, 0.8, 0.5}) out.push_back(along(way, share * q_.limits.max_speed_mps));
    }
    Legs stay;
    const bool faces = q_.turns && std::isfinite(q_.goal.heading_rad);
    for (Leg& leg : stay) leg.heading_rad = faces ? q_.goal.heading_rad : q_.start.heading_rad;
    out.push_back(stay);
    return out;
  }

  static Vec3 point_at(const std::vector<Vec3>& points, double length_m) {
    for (std::size_t i = 1; i < points.size(); ++i) {
      const double step_m = (points[i] - points[i - 1]).norm();
      if (step_m > 0 && length_m <= step_m)
        return points[i - 1] + length_m / step_m * (points[i] - points[i - 1]);
      length_m -= step_m;
    }
    return points.back();
  }

  /// The first metres of a path on the roadmap, by the farthest of its points that a clear line leads to.
  std::vector<Vec3> without_zigzags(const std::vector<Vec3>& points) const {
    std::vector<Vec3> out{points.front()};
    double left_m = kHorizon_s * q_.limits.max_speed_mps;
    for (std::size_t at = 0; at + 1 < points.size() && left_m > 0;) {
      std::size_t next = at + 1;
      while (next + 1 < points.size() && (points[next + 1] - points[at]).norm() < left_m &&
             roadmap_.segment_clear(points[at], points[next + 1], q_.clearance_m))
        ++next;
      left_m -= (points[next] - points[at]).norm();
      out.push_back(points[next]);
      at = next;
    }
    return out;
  }

  /// Legs whose roll-out is at the path's point at the end of each.
  Legs along(const std::vector<Vec3>& points, double speed_mps) const {
    Legs legs;
    MotionState s = q_.start;
    double flown_m = 0;
    for (int i = 0; i < kLegs; ++i) {
      const Vec3 from = s.position, to = point_at(points, flown_m + speed_mps * seconds(kLeg));
      Leg& leg = legs[static_cast<std::size_t>(i)];
      leg.velocity_mps = at_most(velocity_to(to, s), speed_mps);
      const Vec3& v = leg.velocity_mps;
      leg.heading_rad =
          q_.turns && v.head<2>().norm() > kFlies_mps ? std::atan2(v.y(), v.x()) : s.heading_rad;
      s = end_of_leg(s, leg, q_.limits);
      flown_m += (s.position - from).norm();
    }
    return legs;
  }

  Legs varied(Legs legs, double spread) {
    const double v_max = q_.limits.max_speed_mps, sigma = kSpread * spread * v_max;
    for (Leg& leg : legs) {
      for (int axis = 0; axis < 3; ++axis)
        leg.velocity_mps[axis] += (axis == 2 ? 0.4 : 1.0) * sigma * random_.normal();
      if (const double v = leg.velocity_mps.norm(); v > v_max) leg.velocity_mps *= v_max / v;
      if (q_.turns)
        leg.heading_rad = wrap_angle(leg.heading_rad + kHeadingSpread_rad * spread * random_.normal());
    }
    return legs;
  }

  void consider(Legs legs, std::vector<Candidate>& out) {
    if (!q_.turns && std::isfinite(q_.goal.heading_rad))
      for (Leg& leg : legs) leg.heading_rad = q_.goal.heading_rad;
    Candidate c{legs, roll_out(q_.start, legs, q_.limits, q_.braking_mps2)};
    if (!level(c.motion.samples) || !clear(c.motion.samples)) return;
    const std::optional<double> left_s = time_left_s(c.motion.end);
    if (!left_s) return;
    c.time_left_s = *left_s;
    c.value_s = q_.worth_s_per_m3 * gain_m3(c.motion.samples) - c.time_left_s;
    out.push_back(std::move(c));
  }

  static void keep_best(std::vector<Candidate>& out) {
    std::stable_sort(out.begin(), out.end(),
                     [](const Candidate& a, const Candidate& b) { return a.value_s > b.value_s; });
    if (out.size() > kElites) out.resize(kElites);
  }

  /// Whether it climbs and sinks no steeper than the sensors see.
  bool level(const std::vector<TrajectorySample>& samples) const {
    return std::all_of(samples.begin(), samples.end(), [&](const TrajectorySample& s) {
      const Vec3 d = s.position - q_.start.position;
      return std::abs(d.z()) <= kLevel_m + std::tan(q_.steepest_rad) * d.head<2>().norm();
    });
  }

  /// What lies nearer to a sample than the room around it needs no look of its own.
  bool clear(const std::vector<TrajectorySample>& samples) {
    for (std::size_t i = 0; i + 1 < samples.size();) {
      double room_m = this->room_m(samples[i].position);
      std::size_t next = i;
      while (next + 1 < samples.size()) {
        room_m -= (samples[next + 1].position - samples[next].position).norm();
        if (room_m < 0) break;
        ++next;
      }
      if (next == i) {
        next = std::min(i + 2, samples.size() - 1);
        if (!roadmap_.segment_clear(samples[i].position, samples[next].position, q_.clearance_m))
          return false;
      }
      i = next;
    }
    return true;
  }

  /// Within this distance from p all is clear: by the nearest obstacle to the middle of its cell, which
  /// candidates share.
  double room_m(const Vec3& p) {
    const double cell_m = map_.resolution_m();
    const CellKey k = map_.key_of(p);
    const Vec3 middle = map_.center_of(k);
    const auto [at, is_new] = room_around_m_.try_emplace(k);
    if (is_new) at->second = roadmap_.clearance_m(middle) - q_.clearance_m;
    return at->second - (p - middle).norm() - kRounding * cell_m;
  }

  std::optional<double> length_to_goal_m(const Vec3& from) const {
    const std::optional<double> estimate_m = to_goal_.estimated_length_m(roadmap_, from);
    return estimate_m ? estimate_m : to_goal_.length_m(map_, roadmap_, from);
  }

  /// The time from there to the goal. What is flown away from the goal while braking counts twice.
  std::optional<double> time_left_s(const MotionState& s) const {
    const double v = s.velocity_mps.norm(), a = q_.limits.max_acceleration_mps2,
                 v_max = q_.limits.max_speed_mps;
    const double stop_m = v * v / (2 * q_.braking_mps2);
    std::optional<double> left_m;
    if (stop_m > 0.05) {
      left_m = length_to_goal_m(s.position + stop_m / v * s.velocity_mps);
      if (left_m) *left_m += stop_m;
    }
    if (!left_m) left_m = length_to_goal_m(s.position);
    if (!left_m) return std::nullopt;
    // It never reaches v_max on a short way; at the goal nothing is left.
    double left_s = *left_m / v_max + std::min(std::max(0.0, v_max - v) / a, std::sqrt(*left_m / a));
    if (!q_.turns || !std::isfinite(q_.goal.heading_rad)) return left_s;
    const double turn_s =
        std::abs(wrap_angle(q_.goal.heading_rad - s.heading_rad)) / q_.limits.max_heading_rate_radps;
    return *left_m < kNear_m ? left_s + turn_s : std::max(left_s, turn_s);
  }

  double gain_m3(const std::vector<TrajectorySample>& samples) {
    if (!local_) return 0;
    std::array<ViewPose, kViews> poses;
    for (int i = 0; i < kViews; ++i) {
      const auto at = std::min<std::size_t>(static_cast<std::size_t>((i + 1) * kHorizonSamples / kViews),
                                            samples.size() - 1);
      poses[static_cast<std::size_t>(i)] = {samples[at].position, samples[at].heading_rad};
    }
    return local_->gain_m3(poses);
  }

  double value_under_way() {
    constexpr double kNone = -std::numeric_limits<double>::infinity();
    if (q_.under_way.empty()) return kNone;
    const auto at = [this](int i) {
      return q_.under_way[std::min(static_cast<std::size_t>(i), q_.under_way.size() - 1)];
    };
    MotionState end;
    end.position = at(kHorizonSamples).position;
    end.heading_rad = at(kHorizonSamples).heading_rad;
    end.velocity_mps = (at(kHorizonSamples + 1).position - end.position) / seconds(kRolloutPeriod);
    const std::optional<double> left_s = time_left_s(end);
    return left_s ? q_.worth_s_per_m3 * gain_m3(q_.under_way) - *left_s : kNone;
  }

  const VoxelMap& map_;
  const Roadmap& roadmap_;
  const DistanceTree& to_goal_;
  const HorizonQuery& q_;
  std::optional<ViewMap> local_;  // if what is seen is worth anything
  std::unordered_map<CellKey, double, CellKeyHash> room_around_m_;
  Random random_;
};

}  // namespace

std::optional<HorizonPlan> plan_horizon(const VoxelMap& map, const Roadmap& roadmap,
                                        const DistanceTree& to_goal, const std::vector<ViewRay>& rays,
                                        const HorizonQuery& query) {
  return Search(map, roadmap, to_goal, rays, query).run();
}

}  // namespace karst::core
