// The passages of a drawn map, as the host finds them: free cells equally far from the start are sliced, and
// slices merged until no branch is shorter than it is wide. A cell of the drawing counts as a cube of the
// host's, so a passage may be one cell wide.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <queue>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include <karst/testing/drawn_map.h>

namespace karst::testing {

struct DrawnPassages {
  std::vector<karst_passage_t> passages;
  std::vector<karst_passage_end_t> ends;
  std::map<Index, karst_passage_place_t> places;  // each cell in the passages
};

namespace passages {

constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
constexpr Index faces[] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};

struct Slice {
  std::vector<Index> cells;
  std::set<std::size_t> next;  // slices that share a face with it
  Vec3 center;                 // of the cell nearest to the mean of all
  double from_start_m = 0, width_m = 0, height_m = 0;
  double frontier_cells = 0;
};
struct Group {
  std::set<std::size_t> slices, next;  // `next`: groups
  std::size_t core = 0;                // the slice that shows its position and width
};
using Groups = std::map<std::size_t, Group>;
/// Groups in a row that are no junctions, and the junctions at its ends; `none`: it ends there.
struct Chain {
  std::vector<std::size_t> groups;
  std::size_t from = none, to = none;
  bool is_ring = false;
};

inline Index plus(const Index& a, const Index& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }

/// Distances, in cells, of the free cells connected to the one nearest to `start`, which is within 5 m.
inline std::map<Index, double> distances(const DrawnMap& map, const Vec3& start) {
  std::vector<Index> reached;
  double least_m = 5;
  for (const auto& [i, cell] : map.known())
    if (cell == Cell::free && distance(map.center_of(i), start) < least_m) {
      least_m = distance(map.center_of(i), start);
      reached = {i};
    }
  if (reached.empty()) return {};
  std::map<Index, double> out{{reached[0], 0.0}};
  for (std::size_t at = 0; at < reached.size(); ++at)
    for (const Index& face : faces)
      if (const Index n = plus(reached[at], face); map.at(n) == Cell::free)
        if (out.insert({n, std::numeric_limits<double>::infinity()}).second) reached.push_back(n);
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  open.push({0.0, reached[0]});
  while (!open.empty()) {
    const auto [d, i] = open.top();
    open.pop();
    if (d > out.at(i)) continue;
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          const auto there = out.find(plus(i, {x, y, z}));
          const double longer = d + std::sqrt(static_cast<double>(x * x + y * y + z * z));
          if (there == out.end() || there->second <= longer) continue;
          there->second = longer;
          open.push({longer, there->first});
        }
  }
  return out;
}

/// Metres from a free place along `d` to the first cell that is not free, at most 50.
inline double free_run_m(const DrawnMap& map, const Vec3& from, const Vec3& d) {
  const double step = 0.05 * map.resolution_m();
  double free_m = 0, beyond_m = step;
  for (; map.at(from + beyond_m * d) == Cell::free; beyond_m += step) {
    free_m = beyond_m;
    if (free_m >= 50) return 50;
  }
  for (int i = 0; i < 40; ++i) {
    const double middle_m = 0.5 * (free_m + beyond_m);
    (map.at(from + middle_m * d) == Cell::free ? free_m : beyond_m) = middle_m;
  }
  return free_m;
}

/// The shortest of ten horizontal lines, and the vertical one.
inline void measure(const DrawnMap& map, Slice& slice) {
  const auto line_m = [&](const Vec3& d) {
    return free_run_m(map, slice.center, d) + free_run_m(map, slice.center, -1.0 * d);
  };
  slice.height_m = line_m({0, 0, 1});
  slice.width_m = line_m({1, 0, 0});
  for (int i = 1; i < 10; ++i) {
    const double a = i * 3.14159265358979323846 / 10;
    slice.width_m = std::min(slice.width_m, line_m({std::cos(a), std::sin(a), 0}));
  }
}

/// A drawing of a single layer is a floor plan: cells above and below it do not count.
inline bool on_frontier(const DrawnMap& map, const Index& i) {
  return std::any_of(std::begin(faces), std::end(faces), [&](const Index& face) {
    return !(map.layers() == 1 && face.z != 0) && map.at(plus(i, face)) == Cell::unknown;
  });
}

inline std::vector<Slice> slices_of(const DrawnMap& map, const std::map<Index, double>& from_start) {
  const auto band = [&](const Index& i) { return static_cast<int>(from_start.at(i) / 2); };
  std::vector<Slice> out;
  std::map<Index, std::size_t> slice_of;
  for (const auto& [first, d] : from_start) {
    if (slice_of.count(first) > 0) continue;
    Slice s;
    s.cells = {first};
    slice_of[first] = out.size();
    for (std::size_t at = 0; at < s.cells.size(); ++at)
      for (const Index& face : faces)
        if (const Index n = plus(s.cells[at], face); from_start.count(n) > 0 && band(n) == band(first))
          if (slice_of.insert({n, out.size()}).second) s.cells.push_back(n);
    out.push_back(s);
  }
  for (const auto& [i, s] : slice_of)
    for (const Index& face : faces)
      if (const auto n = slice_of.find(plus(i, face)); n != slice_of.end() && n->second != s)
        out[s].next.insert(n->second);
  for (Slice& s : out) {
    Vec3 mean;
    for (const Index& i : s.cells)
      mean = mean + (1.0 / static_cast<double>(s.cells.size())) * map.center_of(i);
    Index nearest = s.cells[0];
    for (const Index& i : s.cells) {
      if (distance(map.center_of(i), mean) < distance(map.center_of(nearest), mean) - 1e-9) nearest = i;
      if (on_frontier(map, i)) ++s.frontier_cells;
    }
    s.center = map.center_of(nearest);
    s.from_start_m = from_start.at(nearest) * map.resolution_m();
    measure(map, s);
  }
  return out;
}

inline Groups groups_of(const std::vector<Slice>& slices) {
  Groups out;
  for (std::size_t s = 0; s < slices.size(); ++s) out[s] = {{s}, slices[s].next, s};
  return out;
}

inline bool is_junction(const Group& g) { return g.next.size() >= 3; }

inline std::vector<Chain> chains_of(const Groups& groups) {
  std::vector<Chain> out;
  std::set<std::size_t> seen;
  const auto walk = [&](std::size_t before, std::size_t at) {
    Chain c;
    c.from = before;
    while (at != none && !is_junction(groups.at(at)) && !c.is_ring) {
      if (!seen.insert(at).second) {
        c.is_ring = true;
        break;
      }
      c.groups.push_back(at);
      std::size_t onward = none;
      for (const std::size_t n : groups.at(at).next)
        if (n != before) onward = n;
      before = at;
      at = onward;
    }
    if (!c.is_ring) c.to = at;
    out.push_back(c);
  };
  for (const auto& [g, group] : groups)
    if (is_junction(group))
      for (const std::size_t n : group.next)
        if (is_junction(groups.at(n)) ? g < n : seen.count(n) == 0) walk(g, n);
  for (const std::size_t ways : {0, 1, 2})
    for (const auto& [g, group] : groups)
      if (group.next.size() == ways && seen.count(g) == 0) walk(none, g);
  return out;
}

/// Makes these groups one with the core `core`, under the name of the first.
inline void merge(Groups& groups, const std::vector<std::size_t>& which, std::size_t core) {
  Group all;
  for (const std::size_t g : which) {
    all.slices.insert(groups.at(g).slices.begin(), groups.at(g).slices.end());
    all.next.insert(groups.at(g).next.begin(), groups.at(g).next.end());
  }
  for (const std::size_t g : which) all.next.erase(g), groups.erase(g);
  for (const std::size_t n : all.next) {
    for (const std::size_t g : which) groups.at(n).next.erase(g);
    groups.at(n).next.insert(which.front());
  }
  all.core = core;
  groups[which.front()] = all;
}

class Simplifier {
 public:
  Simplifier(const std::vector<Slice>& slices, double cell_m) : slices_(slices), band_m_(2 * cell_m) {}

  Groups run() {
    Groups groups = groups_of(slices_);
    while (merge_shortest(groups)) continue;
    widen_junctions(groups);
    return groups;
  }

 private:
  const Slice& core(const Groups& groups, std::size_t g) const { return slices_[groups.at(g).core]; }

  double length_m(const Groups& groups, const Chain& c) const {
    std::vector<std::size_t> line = c.groups;
    if (c.from != none && c.to != none) {
      line.insert(line.begin(), c.from);
      line.push_back(c.to);
    }
    double sum = 0;
    for (std::size_t i = 1; i < line.size(); ++i)
      sum += distance(core(groups, line[i]).center, core(groups, line[i - 1]).center);
    return sum;
  }
  bool is_short(const Groups& groups, const Chain& c) const {
    const bool ends = c.from == none || c.to == none;
    if (c.from == none && c.to == none && !c.is_ring) return false;
    if (c.groups.empty()) return true;
    if (ends && !c.is_ring) {  // whether no piece of it at its end is longer than wide
      std::vector<std::size_t> from_end = c.groups;
      if (c.to == none) std::reverse(from_end.begin(), from_end.end());
      double length = 0.5 * band_m_, widest = 2 * band_m_;
      for (std::size_t i = 0; i < from_end.size(); ++i) {
        const Slice& s = core(groups, from_end[i]);
        if (i > 0) length += distance(s.center, core(groups, from_end[i - 1]).center);
        widest = std::max(widest, s.width_m);
        if (length >= widest) return false;
      }
      return true;
    }
    double width = 0;
    for (const std::size_t g : c.groups)
      width += core(groups, g).width_m / static_cast<double>(c.groups.size());
    for (const std::size_t j : {c.from, c.to})
      if (j != none) width = std::max(width, core(groups, j).width_m);
    if (c.is_ring || c.from == c.to) width *= 2;
    return length_m(groups, c) < std::max(width, 2 * band_m_);
  }
  bool merge_shortest(Groups& groups) const {
    const std::vector<Chain> all = chains_of(groups);
    const Chain* shortest = nullptr;
    for (const Chain& c : all)
      if (is_short(groups, c) &&
          (shortest == nullptr || length_m(groups, c) < length_m(groups, *shortest) - 1e-9))
        shortest = &c;
    if (shortest == nullptr) return false;
    std::vector<std::size_t> which;
    for (const std::size_t j : {shortest->from, shortest->to})
      if (j != none && (which.empty() || which.front() != j)) which.push_back(j);
    std::size_t widest = which.empty() ? groups.at(shortest->groups.front()).core : groups.at(which[0]).core;
    for (const std::size_t j : which)
      if (core(groups, j).width_m > slices_[widest].width_m) widest = groups.at(j).core;
    which.insert(which.end(), shortest->groups.begin(), shortest->groups.end());
    merge(groups, which, widest);
    return true;
  }
  /// What is within half of a junction's width of it is part of it; a group is left to each chain.
  void widen_junctions(Groups& groups) const {
    for (auto& [g, group] : groups)
      if (is_junction(group))
        for (const std::size_t s : group.slices)
          if (slices_[s].width_m > slices_[group.core].width_m) group.core = s;
    for (const Chain& c : chains_of(groups)) {
      std::vector<std::size_t> left = c.groups;
      for (const std::size_t j : {c.from, c.to}) {
        if (j == none) continue;
        const Slice& hall = core(groups, j);
        while (left.size() > 1) {
          const std::size_t g = j == c.from ? left.front() : left.back();
          if (distance(core(groups, g).center, hall.center) >= 0.5 * hall.width_m) break;
          merge(groups, {j, g}, groups.at(j).core);
          left.erase(j == c.from ? left.begin() : left.end() - 1);
        }
        if (c.from == c.to) break;
      }
    }
  }

  const std::vector<Slice>& slices_;
  double band_m_;
};

inline double cells_in(const std::vector<Slice>& slices, const Groups& groups,
                       const std::vector<std::size_t>& which, bool frontier) {
  double sum = 0;
  for (const std::size_t g : which)
    for (const std::size_t s : groups.at(g).slices)
      sum += frontier ? slices[s].frontier_cells : static_cast<double>(slices[s].cells.size());
  return sum;
}

inline karst_passage_end_t end_at(const std::vector<Slice>& slices, const Groups& groups, double cell_m,
                                  const std::vector<std::size_t>& which, karst_passage_end_kind_t kind) {
  const Slice& s = slices[groups.at(which.front()).core];
  karst_passage_end_t end{};
  end.position = s.center;
  end.from_start_m = s.from_start_m;
  end.width_m = s.width_m;
  end.height_m = s.height_m;
  end.volume_m3 = cells_in(slices, groups, which, false) * cell_m * cell_m * cell_m;
  end.frontier_m2 = cells_in(slices, groups, which, true) * cell_m * cell_m;
  end.kind = kind;
  return end;
}
/// Rock or unknown space, by the last two groups.
inline karst_passage_end_t last_end(const std::vector<Slice>& slices, const Groups& groups, double cell_m,
                                    const Chain& c, bool at_front) {
  std::vector<std::size_t> last = c.groups;
  if (!at_front) std::reverse(last.begin(), last.end());
  last.resize(std::min<std::size_t>(2, last.size()));
  std::size_t most = 0;
  for (const std::size_t g : last)
    for (const std::size_t s : groups.at(g).slices) most = std::max(most, slices[s].cells.size());
  const bool open = 4 * cells_in(slices, groups, last, true) >= static_cast<double>(most) / 2;
  return end_at(slices, groups, cell_m, last, open ? KARST_PASSAGE_OPEN_END : KARST_PASSAGE_DEAD_END);
}

inline karst_passage_t passage_of(const std::vector<Slice>& slices, const Groups& groups, double cell_m,
                                  const Chain& c) {
  std::vector<std::size_t> line = c.groups, measured = c.groups;
  if (c.from != none) line.insert(line.begin(), c.from);
  if (c.to != none) line.push_back(c.to);
  if (c.is_ring) line.push_back(line.front());
  karst_passage_t p{};
  std::vector<double> to{0.0};
  const auto core = [&](std::size_t g) -> const Slice& { return slices[groups.at(g).core]; };
  for (std::size_t i = 1; i < line.size(); ++i)
    to.push_back(to.back() + distance(core(line[i]).center, core(line[i - 1]).center));
  p.length_m = to.back();
  std::size_t half = 0;
  while (to[half] < 0.5 * to.back()) ++half;
  p.middle = core(line[half]).center;
  if (measured.size() >= 3 && c.to == none && !c.is_ring) measured.pop_back();
  if (measured.size() >= 3 && c.from == none && !c.is_ring) measured.erase(measured.begin());
  p.least_width_m = p.least_height_m = std::numeric_limits<double>::infinity();
  for (const std::size_t g : measured) {
    p.mean_width_m += core(g).width_m / static_cast<double>(measured.size());
    p.mean_height_m += core(g).height_m / static_cast<double>(measured.size());
    p.least_width_m = std::min(p.least_width_m, core(g).width_m);
    p.least_height_m = std::min(p.least_height_m, core(g).height_m);
  }
  p.volume_m3 = cells_in(slices, groups, c.groups, false) * cell_m * cell_m * cell_m;
  p.frontier_m2 = cells_in(slices, groups, c.groups, true) * cell_m * cell_m;
  return p;
}

/// The order of `items` by `less`: the new place of each.
template <class Item, class Less>
std::vector<std::uint32_t> sort_items(std::vector<Item>& items, Less&& less) {
  std::vector<std::size_t> order(items.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return less(items[a], items[b]); });
  std::vector<std::uint32_t> place(items.size());
  std::vector<Item> sorted;
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[order[i]] = static_cast<std::uint32_t>(i);
    sorted.push_back(items[order[i]]);
  }
  items = std::move(sorted);
  return place;
}

}  // namespace passages

/// `start`: of the mission (world, m). There are none if no free cell is within 5 m of it.
inline DrawnPassages find_passages(const DrawnMap& map, const Vec3& start) {
  using namespace passages;
  const double cell_m = map.resolution_m();
  const std::vector<Slice> slices = slices_of(map, distances(map, start));
  const Groups groups = Simplifier(slices, cell_m).run();
  DrawnPassages out;
  std::map<std::size_t, std::uint32_t> end_of, passage_in;  // of groups
  const auto add = [&](const karst_passage_end_t& end) {
    out.ends.push_back(end);
    return static_cast<std::uint32_t>(out.ends.size() - 1);
  };
  for (const auto& [g, group] : groups)
    if (is_junction(group)) end_of[g] = add(end_at(slices, groups, cell_m, {g}, KARST_PASSAGE_JUNCTION));
  for (const Chain& c : chains_of(groups)) {
    karst_passage_t p = passage_of(slices, groups, cell_m, c);
    if (c.is_ring) {
      p.ends[0] = p.ends[1] = add(end_at(slices, groups, cell_m, {c.groups.front()}, KARST_PASSAGE_RING));
    } else {
      p.ends[0] = c.from != none ? end_of.at(c.from) : add(last_end(slices, groups, cell_m, c, true));
      p.ends[1] = c.to != none ? end_of.at(c.to) : add(last_end(slices, groups, cell_m, c, false));
    }
    for (const std::uint32_t e : p.ends) ++out.ends[e].ways;
    for (const std::size_t g : c.groups) passage_in[g] = static_cast<std::uint32_t>(out.passages.size());
    out.passages.push_back(p);
  }
  const auto ends = sort_items(out.ends, [](const karst_passage_end_t& a, const karst_passage_end_t& b) {
    return std::tie(a.from_start_m, a.position.x, a.position.y, a.position.z) <
           std::tie(b.from_start_m, b.position.x, b.position.y, b.position.z);
  });
  for (karst_passage_t& p : out.passages) {
    for (std::uint32_t& e : p.ends) e = ends[e];
    if (p.ends[0] > p.ends[1]) std::swap(p.ends[0], p.ends[1]);
  }
  const auto order = sort_items(out.passages, [](const karst_passage_t& a, const karst_passage_t& b) {
    return std::tie(a.ends[0], a.ends[1], a.middle.x, a.middle.y, a.middle.z) <
           std::tie(b.ends[0], b.ends[1], b.middle.x, b.middle.y, b.middle.z);
  });
  for (const auto& [g, group] : groups) {
    const bool junction = end_of.count(g) > 0;
    for (const std::size_t s : group.slices)
      for (const Index& i : slices[s].cells)
        out.places[i] = {junction ? KARST_NO_PASSAGE : order[passage_in.at(g)],
                         junction ? ends[end_of.at(g)] : KARST_NO_PASSAGE, slices[s].from_start_m,
                         slices[s].width_m, slices[s].height_m};
  }
  return out;
}

/// Of the cell that holds `p`, or else of the nearest one at most two cells from it.
inline karst_passage_place_t passage_at(const DrawnMap& map, const DrawnPassages& found, const Vec3& p) {
  const Index own = map.index_of(p);
  if (const auto here = found.places.find(own); here != found.places.end()) return here->second;
  karst_passage_place_t nearest{KARST_NO_PASSAGE, KARST_NO_PASSAGE, 0, 0, 0};
  double least = std::numeric_limits<double>::infinity();
  for (int x = -2; x <= 2; ++x)
    for (int y = -2; y <= 2; ++y)
      for (int z = -2; z <= 2; ++z) {
        const Index i = passages::plus(own, {x, y, z});
        const auto there = found.places.find(i);
        if (there == found.places.end() || distance(map.center_of(i), p) >= least) continue;
        least = distance(map.center_of(i), p);
        nearest = there->second;
      }
  return nearest;
}

}  // namespace karst::testing
