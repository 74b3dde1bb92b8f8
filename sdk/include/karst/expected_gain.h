// Expected information gain of the viewpoint of a frontier: of the unknown cells that the host's gain service
// counts there, within a shortened range and cached, what is expected to be cave and not rock.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

#include <karst/flown_path.h>
#include <karst/policy.h>
#include <karst/straight_path.h>

namespace karst {

/// The cost of a ray grows with its range, the number of rays with the square of it, and unknown cells far
/// behind a frontier are mostly rock. So the range of each sensor is cut to `range_m`. A result is cached
/// until the core's own figures of the cluster change: its cells, the counts around it, its viewpoint.
class ExpectedGain {
 public:
  double range_m = 5.0;
  double depth_m = 3.0;
  double beside_m = 1.4, ahead_m = 3.0;
  double share = 1.5e-3;
  int looks = 24;

  void parameters(Parameters& p) {
    p.add("gain_range", range_m, "m", 1, 20, "how far unknown space behind a frontier is counted");
    p.add("gain_depth", depth_m, "m", 0.1, 100,
          "for how far the cave behind an opening is expected to be as wide as the opening");
    p.add("gain_beside", beside_m, "m", 0, 100,
          "an opening this near to the way flown is a gap between what was seen in passing and the rock");
    p.add("gain_ahead", ahead_m, "m", 0, 100,
          "openings this far from the way flown count in full; those between by their distance");
    p.add("gain_share", share, "", 0, 1,
          "with a sensor that sees all around: share of the unknown volume in view of an opening of 1 m^2 "
          "beside the way flown that is expected to be cave; 0: openings count as for a camera");
    p.add("looks", looks, 0, 4096, "looks computed in one decision at most");
  }

  /// Volume in m^3 expected to be seen from the viewpoint of each frontier. Most of the unknown cells in view
  /// are rock. For sensors that see all around, the share of them that is expected to be cave counts
  /// (share_of_cave); for others, no more than lies `depth_m` deep behind the openings in view: else a narrow
  /// opening would count as much as a wide one. A frontier not evaluated within the limit `looks` counts by
  /// its last result, or else like the mean of those evaluated (all around) or by its openings.
  std::vector<double> volumes_m3(const Request& request, const std::vector<const Frontier*>& frontiers) {
    begin_decision(request);
    std::vector<const Frontier*> fresh;
    for (const Frontier* f : frontiers)
      if (const auto found = known_.find(f->id); found == known_.end() || !same(found->second.frontier, *f))
        fresh.push_back(f);
    std::stable_sort(fresh.begin(), fresh.end(), [](const Frontier* a, const Frontier* b) {
      return a->path_length_m < b->path_length_m;
    });
    if (fresh.size() > looks_left_) fresh.resize(looks_left_);
    looks_left_ -= fresh.size();
    look(request, fresh);
    const bool shares = by_share(request);
    const double edge_m = request.map.resolution_m(), mean_m3 = mean_in_view_m3();
    std::vector<double> out;
    for (const Frontier* f : frontiers) {
      const auto found = known_.find(f->id);
      const bool looked = found != known_.end();
      if (shares) {
        out.push_back((looked ? found->second.volume_m3 : mean_m3) * share_of_cave(*f, edge_m));
      } else {
        const double max_m3 = behind_openings_m3(request, *f);
        out.push_back(looked ? std::min(found->second.volume_m3, max_m3) : max_m3);
      }
    }
    return out;
  }

  /// Upper bound in m^3 of what volumes_m3 says of a frontier, at the cost of no look.
  double most_m3(const Request& request, const Frontier& f) {
    begin_decision(request);
    if (!by_share(request)) return behind_openings_m3(request, f);
    const double edge_m = request.map.resolution_m();
    double in_view_m3 = 0;
    for (const Sensor& s : request.sensors)
      in_view_m3 += s.horizontal_fov_rad * (std::sin(s.high_elevation_rad) - std::sin(s.low_elevation_rad)) *
                    std::pow(std::min(s.max_range_m, range_m) + edge_m, 3) / 3;  // whole cells are counted
    return in_view_m3 * share_of_cave(f, edge_m);
  }

  /// Volume in m^3 expected behind the opening itself, independent of the viewpoint.
  double behind_m3(const Request& request, const Frontier& f) const {
    const double edge_m = request.map.resolution_m();
    return f.cells * edge_m * edge_m * depth_m * fraction_of_depth(f);
  }

 private:
  /// Sum over the clusters in range that lie in the same direction as `f` from its viewpoint.
  double behind_openings_m3(const Request& request, const Frontier& f) const {
    constexpr double same_direction = 0.5;  // cosine
    const Vec3 there = f.centroid - f.viewpoint;
    double sum_m3 = 0;
    for (const Frontier& other : request.frontiers) {
      const Vec3 d = other.centroid - f.viewpoint;
      if (other.id == f.id || (norm(d) < range_m && dot(d, there) > same_direction * norm(d) * norm(there)))
        sum_m3 += behind_m3(request, other);
    }
    return sum_m3;
  }

  /// How much of a predicted depth of 3 m proved true in flight depended only on the distance from the flown
  /// path: all of it beyond 3 m, a tenth within 1.5 m. A passage that continues is first seen from afar.
  double fraction_of_depth(const Frontier& f) const {
    constexpr double least = 0.05;
    const double away_m = path_.distance_m(f.centroid);
    if (away_m >= ahead_m) return 1.0;
    return std::max(least, (away_m - beside_m) / (ahead_m - beside_m));
  }

  /// Without a look no volume is in view: openings count.
  bool by_share(const Request& request) const { return share > 0 && looks > 0 && sees_all_around(request); }

  /// Of the unknown volume in view of all sensors of a vehicle with a LiDAR, the share that is cave grows
  /// with the area A of the opening and its distance d from the flown path: as sqrt(A) (1 + d)^1.5, A in m^2,
  /// d in m, fitted to 4,442 frontiers of seven flights, d up to 50 m (docs/results/expected_gain.md). A
  /// small or near opening is mostly a gap between beams, or between the rock and what was seen in passing.
  double share_of_cave(const Frontier& f, double edge_m) const {
    const double away_m = std::min(path_.distance_m(f.centroid), 50.0);
    return std::min(1.0, share * std::sqrt(f.cells) * edge_m * std::pow(1 + away_m, 1.5));
  }

  double mean_in_view_m3() const {
    double sum_m3 = 0;
    for (const auto& [id, k] : known_) sum_m3 += k.volume_m3;
    return known_.empty() ? 0 : sum_m3 / static_cast<double>(known_.size());
  }

  struct Known {
    Frontier frontier;
    double volume_m3;
  };

  static bool same(const Frontier& a, const Frontier& b) {
    return a.cells == b.cells && a.unknown_cells == b.unknown_cells && a.free_cells == b.free_cells &&
           distance(a.centroid, b.centroid) == 0 && distance(a.viewpoint, b.viewpoint) == 0 &&
           a.viewpoint_heading_rad == b.viewpoint_heading_rad;
  }

  /// Ids are never reused: a frontier that is no longer offered is gone, or will be evaluated again.
  void begin_decision(const Request& request) {
    if (request.sequence == sequence_) return;
    sequence_ = request.sequence;
    looks_left_ = static_cast<std::size_t>(looks);
    path_.note(request.position());
    std::map<std::uint32_t, Known> kept;
    for (const Frontier& f : request.frontiers)
      if (const auto found = known_.find(f.id); found != known_.end()) kept.insert(*found);
    known_ = std::move(kept);
  }

  void look(const Request& request, const std::vector<const Frontier*>& frontiers) {
    if (frontiers.empty()) return;
    std::vector<Viewpoint> from;
    for (const Frontier* f : frontiers) {
      from.push_back({f->viewpoint, f->viewpoint_heading_rad});
      known_[f->id] = {*f, 0.0};
    }
    const double edge_m = request.map.resolution_m();
    for (Sensor sensor : request.sensors) {
      sensor.max_range_m = std::min(sensor.max_range_m, range_m);
      if (sensor.min_range_m >= sensor.max_range_m) continue;
      const std::vector<std::uint64_t> cells = request.newly_seen(sensor, from);
      for (std::size_t i = 0; i < frontiers.size(); ++i)
        known_[frontiers[i]->id].volume_m3 += static_cast<double>(cells[i]) * edge_m * edge_m * edge_m;
    }
  }

  std::uint32_t sequence_ = 0;
  std::size_t looks_left_ = 0;
  FlownPath path_;
  std::map<std::uint32_t, Known> known_;
};

}  // namespace karst
