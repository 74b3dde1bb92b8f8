// Path lengths between viewpoints, queried from the path service once for each site and cached.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <karst/policy.h>

/// Viewpoints within `same_site_m` of each other share a site, since the core moves a viewpoint a little
/// whenever the map around it changes. A known length stays valid, and is shortened when it is queried again
/// after `refresh_s`.
class PathLengths {
 public:
  /// Lengths [from][to] in metres. Where the service knows no path, the path through the vehicle's position
  /// counts: `from_here_m[i]` is the length from there to viewpoint i.
  std::vector<std::vector<double>> between(const karst::Request& request,
                                           const std::vector<karst::Vec3>& viewpoints,
                                           const std::vector<double>& from_here_m) {
    std::vector<std::size_t> site_of(viewpoints.size());
    for (std::size_t i = 0; i < viewpoints.size(); ++i) site_of[i] = site_at(viewpoints[i], request.stamp_ns);
    std::vector<char> due(sites_.size(), 0);
    for (const std::size_t p : site_of)
      due[p] = request.stamp_ns - sites_[p].asked_ns > static_cast<std::int64_t>(refresh_s * 1e9);
    ask_nearest(request, due);
    std::vector<std::vector<double>> out(viewpoints.size(), std::vector<double>(viewpoints.size(), 0.0));
    for (std::size_t i = 0; i < viewpoints.size(); ++i)
      for (std::size_t j = 0; j < viewpoints.size(); ++j) {
        if (i == j) continue;
        const double straight_m = karst::distance(viewpoints[i], viewpoints[j]);
        double path_m = straight_m;
        if (site_of[i] != site_of[j]) {
          const double found_m = length_m(site_of[i], site_of[j]);
          path_m = std::isfinite(found_m) ? std::max(found_m, straight_m) : from_here_m[i] + from_here_m[j];
        }
        out[i][j] = path_m;
      }
    forget_old(request.stamp_ns);
    return out;
  }

  static constexpr double same_site_m = 1.0;
  static constexpr double refresh_s = 20.0, forget_s = 60.0;
  static constexpr std::size_t max_asked = 8;

 private:
  static constexpr std::int64_t never_ns = std::numeric_limits<std::int64_t>::min() / 2;

  struct Site {
    karst::Vec3 position;
    std::int64_t used_ns = 0, asked_ns = never_ns;
    std::vector<double> path_m;  // lengths to the sites before this one
  };

  std::size_t site_at(const karst::Vec3& p, std::int64_t now_ns) {
    for (std::size_t i = 0; i < sites_.size(); ++i)
      if (karst::distance(sites_[i].position, p) <= same_site_m) {
        sites_[i].used_ns = now_ns;
        return i;
      }
    const std::vector<double> unknown(sites_.size(), std::numeric_limits<double>::infinity());
    sites_.push_back({p, now_ns, never_ns, unknown});
    return sites_.size() - 1;
  }

  /// A decision queries a few sites only; those near the vehicle matter most.
  void ask_nearest(const karst::Request& request, const std::vector<char>& due) {
    std::vector<std::size_t> asked;
    for (std::size_t p = 0; p < due.size(); ++p)
      if (due[p] != 0) asked.push_back(p);
    const auto away_m = [&](std::size_t p) {
      return karst::distance(sites_[p].position, request.position());
    };
    std::stable_sort(asked.begin(), asked.end(),
                     [&](std::size_t a, std::size_t b) { return away_m(a) < away_m(b); });
    if (asked.size() > max_asked) asked.resize(max_asked);
    for (const std::size_t p : asked) ask(request, p);
  }

  double& length_m(std::size_t a, std::size_t b) { return sites_[std::max(a, b)].path_m[std::min(a, b)]; }

  /// One search from a site to all others; lengths are symmetric.
  void ask(const karst::Request& request, std::size_t from) {
    std::vector<karst::Vec3> others;
    std::vector<std::size_t> index;
    for (std::size_t i = 0; i < sites_.size(); ++i)
      if (i != from) {
        others.push_back(sites_[i].position);
        index.push_back(i);
      }
    const std::vector<double> found =
        request.path_lengths(sites_[from].position, others, request.map.resolution_m());
    for (std::size_t k = 0; k < index.size(); ++k)
      if (std::isfinite(found[k])) length_m(from, index[k]) = found[k];
    sites_[from].asked_ns = request.stamp_ns;
  }

  void forget_old(std::int64_t now_ns) {
    for (std::size_t i = sites_.size(); i-- > 0;) {
      if (now_ns - sites_[i].used_ns < static_cast<std::int64_t>(forget_s * 1e9)) continue;
      for (std::size_t j = i + 1; j < sites_.size(); ++j)
        sites_[j].path_m.erase(sites_[j].path_m.begin() + static_cast<std::ptrdiff_t>(i));
      sites_.erase(sites_.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }

  std::vector<Site> sites_;
};
