#include "tests/benchmark/offline_bound/view_graph.h"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <queue>
#include <unordered_map>

#include "core_stack/common/error.h"

namespace karst::bound {
namespace {

using core::CellKey;
using core::Vec3;
using evaluation::center_of;

struct Steps {
  std::vector<Vec3> places;
  std::vector<std::vector<std::pair<Place, float>>> to;
};

std::int32_t cube(std::int32_t cell, int edge) {
  return static_cast<std::int32_t>(std::floor(static_cast<double>(cell) / edge));
}

bool is_open(const evaluation::Reachable& r, const Vec3& a, const Vec3& b) {
  bool open = true;
  core::traverse(a, b, r.options.resolution_m,
                 [&](const CellKey& k) { return open = r.flyable.contains(k); });
  return open;
}

/// By cube, in the order of their keys; the cube of the start has the flyable cell nearest to the start.
std::map<CellKey, Vec3> viewpoints(const evaluation::Reachable& r, const Vec3& start, int edge,
                                   CellKey& first) {
  const double cell_m = r.options.resolution_m;
  std::map<CellKey, std::pair<double, CellKey>> best;
  double nearest = std::numeric_limits<double>::infinity();
  CellKey start_cell;
  r.flyable.for_each([&](const CellKey& k) {
    const CellKey c{cube(k.x, edge), cube(k.y, edge), cube(k.z, edge)};
    const Vec3 middle = Vec3(c.x + 0.5, c.y + 0.5, c.z + 0.5) * edge * cell_m;
    const double off = (center_of(k, cell_m) - middle).squaredNorm();
    const auto [it, made] = best.try_emplace(c, off, k);
    if (!made && off < it->second.first) it->second = {off, k};
    const double d = (center_of(k, cell_m) - start).squaredNorm();
    if (d < nearest) nearest = d, start_cell = k, first = c;
  });
  std::map<CellKey, Vec3> out;
  for (const auto& [c, b] : best) out[c] = center_of(b.second, cell_m);
  out[first] = center_of(start_cell, cell_m);
  return out;
}

/// Steps with a common divisor pass another cube's place instead.
bool is_step(int x, int y, int z) { return std::gcd(std::gcd(std::abs(x), std::abs(y)), std::abs(z)) == 1; }

void join(Steps& s, Place a, Place b) {
  const auto length_m = static_cast<float>((s.places[a] - s.places[b]).norm());
  s.to[a].emplace_back(b, length_m);
  s.to[b].emplace_back(a, length_m);
}

Place add(Steps& s, const Vec3& place) {
  if (s.places.size() >= 65535) throw core::InputError("--spacing", "", "more than 65535 viewpoints");
  s.places.push_back(place);
  s.to.emplace_back();
  return static_cast<Place>(s.places.size() - 1);
}

Steps straight_steps(const evaluation::Reachable& r, const std::map<CellKey, Vec3>& at,
                     const CellKey& first) {
  Steps s;
  std::map<CellKey, Place> number{{first, add(s, at.at(first))}};
  for (const auto& [c, place] : at)
    if (c != first) number[c] = add(s, place);
  for (const auto& [c, a] : number)
    for (int i = 0; i < 125; ++i) {
      const int x = i % 5 - 2, y = i / 5 % 5 - 2, z = i / 25 - 2;
      const CellKey other = c + CellKey{x, y, z};
      if (other < c || !is_step(x, y, z)) continue;
      const auto b = number.find(other);
      if (b != number.end() && is_open(r, s.places[a], s.places[b->second])) join(s, a, b->second);
    }
  return s;
}

/// For each place the number of the group that steps join it with, and how large the groups are. That of the
/// start is 0.
struct Groups {
  std::vector<std::size_t> of, size;
};
Groups groups_of(const Steps& s) {
  constexpr auto kNone = std::numeric_limits<std::size_t>::max();
  Groups g{std::vector<std::size_t>(s.places.size(), kNone), {}};
  for (std::size_t i = 0; i < s.places.size(); ++i) {
    if (g.of[i] != kNone) continue;
    std::vector<std::size_t> open{i};
    g.of[i] = g.size.size();
    for (std::size_t k = 0; k < open.size(); ++k)
      for (const auto& step : s.to[open[k]])
        if (g.of[step.first] == kNone) g.of[step.first] = g.of[i], open.push_back(step.first);
    g.size.push_back(open.size());
  }
  return g;
}

CellKey cell_at(const Vec3& p, double cell_m) {
  const Vec3 k = (p / cell_m).array().floor();
  return {static_cast<int>(k.x()), static_cast<int>(k.y()), static_cast<int>(k.z())};
}

/// Joins the start's group with the nearest other of at least `min_places`, along cells where no straight
/// step leads through a narrow place. Whether there was one.
bool bridge(const evaluation::Reachable& r, Steps& s, std::size_t min_places, double spacing_m) {
  const double cell_m = r.options.resolution_m;
  const Groups groups = groups_of(s);
  std::unordered_map<CellKey, Place, core::CellKeyHash> wanted, own;
  std::unordered_map<CellKey, CellKey, core::CellKeyHash> before;
  std::vector<CellKey> open;
  for (std::size_t i = 0; i < s.places.size(); ++i) {
    const CellKey k = cell_at(s.places[i], cell_m);
    if (groups.of[i] == 0) {
      own[k] = static_cast<Place>(i), before[k] = k;
      open.push_back(k);
    } else if (groups.size[groups.of[i]] >= min_places) {
      wanted[k] = static_cast<Place>(i);
    }
  }
  if (wanted.empty()) return false;
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (const auto met = wanted.find(open[i]); met != wanted.end()) {
      Place last = met->second;
      CellKey k = open[i], seen = k;  // the last cell that a straight line from `last` reaches
      while (!own.contains(k)) {
        k = before[k];
        const Vec3 there = center_of(k, cell_m);
        if (!is_open(r, s.places[last], there) || (there - s.places[last]).norm() > spacing_m) {
          const Place made = add(s, center_of(seen, cell_m));
          join(s, last, made);
          last = made;
        }
        seen = k;
      }
      join(s, last, own[k]);
      return true;
    }
    for (const CellKey& face : {CellKey{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
      const CellKey next = open[i] + face;
      if (r.flyable.contains(next) && before.try_emplace(next, open[i]).second) open.push_back(next);
    }
  }
  return false;
}

/// Only what hangs together with the start.
Steps kept(const Steps& s) {
  const Groups groups = groups_of(s);
  std::vector<Place> number(s.places.size());
  Steps out;
  for (std::size_t i = 0; i < s.places.size(); ++i)
    if (groups.of[i] == 0) number[i] = add(out, s.places[i]);
  for (std::size_t i = 0; i < s.places.size(); ++i)
    if (groups.of[i] == 0)
      for (const auto& [to, length_m] : s.to[i]) out.to[number[i]].emplace_back(number[to], length_m);
  return out;
}

/// Dijkstra: distances from `from`, and from each place the next one on the way to it.
void paths_of(const Steps& s, Place from, float* distance_m, Place* toward) {
  using Entry = std::pair<float, Place>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  std::fill(distance_m, distance_m + s.places.size(), std::numeric_limits<float>::infinity());
  distance_m[from] = 0, toward[from] = from;
  open.emplace(0.0f, from);
  while (!open.empty()) {
    const auto [d, at] = open.top();
    open.pop();
    if (d > distance_m[at]) continue;
    for (const auto& [next, length_m] : s.to[at])
      if (d + length_m < distance_m[next]) {
        distance_m[next] = d + length_m, toward[next] = at;
        open.emplace(d + length_m, next);
      }
  }
}

double flyable_near(const evaluation::Reachable& r, const std::vector<Vec3>& places, double within_m) {
  std::map<CellKey, std::vector<Vec3>> bins;
  const auto bin = [&](const Vec3& p) { return cell_at(p, within_m); };
  for (const Vec3& p : places) bins[bin(p)].push_back(p);
  std::size_t near = 0;
  r.flyable.for_each([&](const CellKey& k) {
    const Vec3 c = center_of(k, r.options.resolution_m);
    bool found = false;
    for (int i = 0; i < 27 && !found; ++i) {
      const auto b = bins.find(bin(c) + CellKey{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1});
      if (b == bins.end()) continue;
      for (const Vec3& p : b->second) found = found || (p - c).squaredNorm() <= within_m * within_m;
    }
    near += found;
  });
  return static_cast<double>(near) / static_cast<double>(r.flyable_cells);
}

}  // namespace

ViewGraph view_graph(const evaluation::Reachable& r, const Vec3& start, double spacing_m) {
  const int edge = std::max(1, static_cast<int>(std::lround(spacing_m / r.options.resolution_m)));
  CellKey first;
  const std::map<CellKey, Vec3> at = viewpoints(r, start, edge, first);
  constexpr std::size_t kMinGroup = 8;  // smaller ones are corners
  Steps all = straight_steps(r, at, first);
  while (bridge(r, all, kMinGroup, spacing_m)) {
  }
  const Steps s = kept(all);
  ViewGraph g;
  g.places = s.places;
  g.left_out = all.places.size() - s.places.size();
  g.flyable_near = flyable_near(r, s.places, 1.5 * spacing_m);
  for (const auto& steps : s.to) {
    g.near.emplace_back();
    for (const auto& step : steps) g.near.back().push_back(step.first);
  }
  const std::size_t n = s.places.size();
  g.distance_m.resize(n * n), g.toward.resize(n * n);
  for (std::size_t i = 0; i < n; ++i)
    paths_of(s, static_cast<Place>(i), &g.distance_m[i * n], &g.toward[i * n]);
  return g;
}

std::vector<Vec3> pulled_taut(const evaluation::Reachable& r, const ViewGraph& g,
                              const std::vector<Place>& way, const std::vector<Place>& targets) {
  std::vector<Vec3> out{g.places[way.front()]};
  std::size_t target = 0;
  for (std::size_t at = 0; at + 1 < way.size();) {
    std::size_t end = at + 1, next = at + 1;  // the next target, and how far a straight line reaches
    while (end + 1 < way.size() && (target == targets.size() || way[end] != targets[target])) ++end;
    while (next < end && is_open(r, g.places[way[at]], g.places[way[next + 1]])) ++next;
    if (next == end) ++target;
    out.push_back(g.places[way[next]]);
    at = next;
  }
  return out;
}

}  // namespace karst::bound
