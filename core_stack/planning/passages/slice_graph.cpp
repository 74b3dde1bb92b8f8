#include "core_stack/planning/passages/slice_graph.h"

#include <algorithm>
#include <numeric>

namespace karst::core {
namespace {

bool is_junction(const SliceGroup& g) { return g.next.size() >= 3; }

/// Walks from `first` away from `before` until a junction or an end.
SliceChain walked(const std::vector<SliceGroup>& groups, std::uint32_t before, std::uint32_t first,
                  std::vector<char>& seen) {
  SliceChain chain;
  chain.junctions[0] = before;
  for (std::uint32_t at = first; at != kNoGroup;) {
    if (is_junction(groups[at])) {
      chain.junctions[1] = at;
      break;
    }
    if (seen[at]) {  // all around
      chain.is_ring = true;
      break;
    }
    seen[at] = 1;
    chain.groups.push_back(at);
    std::uint32_t onward = kNoGroup;
    for (const std::uint32_t n : groups[at].next)
      if (n != before) onward = n;
    before = at;
    at = onward;
  }
  return chain;
}

/// Slices being merged into groups.
class Merging {
 public:
  Merging(const std::vector<Slice>& slices, const std::vector<CrossSection>& sections, double band_m)
      : slices_(slices), sections_(sections), band_m_(band_m), parent_(slices.size()), core_(slices.size()) {
    std::iota(parent_.begin(), parent_.end(), 0u);
    std::iota(core_.begin(), core_.end(), 0u);
  }

  std::vector<SliceGroup> groups() {
    std::vector<std::uint32_t> number(slices_.size(), kNoGroup);
    std::vector<SliceGroup> out;
    for (std::uint32_t s = 0; s < slices_.size(); ++s)
      if (root(s) == s) {
        number[s] = static_cast<std::uint32_t>(out.size());
        out.emplace_back().core = core_[s];
      }
    for (std::uint32_t s = 0; s < slices_.size(); ++s) {
      const std::uint32_t own = number[root(s)];
      out[own].slices.push_back(s);
      for (const std::uint32_t n : slices_[s].next)
        if (const std::uint32_t other = number[root(n)]; other != own) out[own].next.push_back(other);
    }
    for (SliceGroup& g : out) {
      std::sort(g.next.begin(), g.next.end());
      g.next.erase(std::unique(g.next.begin(), g.next.end()), g.next.end());
    }
    return out;
  }

  /// Merges what is to be merged among `groups`, the shortest first. Returns whether anything was.
  bool merge_short(const std::vector<SliceGroup>& groups) {
    struct Short {
      double length_m;
      const SliceChain* chain;
    };
    const std::vector<SliceChain> chains = chains_of(groups);
    std::vector<Short> all;
    for (const SliceChain& c : chains)
      if (is_short(groups, c)) all.push_back({length_m(groups, c), &c});
    std::stable_sort(all.begin(), all.end(),
                     [](const Short& a, const Short& b) { return a.length_m < b.length_m; });
    // How many ways lead from the group of each root, as merging goes on. With two it is no junction any
    // more: what ended at it is part of a longer chain, which the next round measures.
    std::vector<std::size_t> ways(slices_.size());
    for (const SliceGroup& g : groups) ways[root(g.core)] = g.next.size();
    for (const Short& s : all) {
      const SliceChain& c = *s.chain;
      if (c.is_ring) {
        unite(groups, c, c.groups.front());
        continue;
      }
      const std::uint32_t a = root(groups[end_of(c)].core), b = root(groups[other_end_of(c)].core);
      if (ways[a] < 3 || ways[b] < 3) continue;
      const bool is_dead_end = c.junctions[0] == kNoGroup || c.junctions[1] == kNoGroup;
      const std::size_t left = is_dead_end ? ways[a] - 1 : a == b ? ways[a] - 2 : ways[a] + ways[b] - 2;
      unite(groups, c, end_of(c));
      ways[root(a)] = left;
    }
    return !all.empty();
  }

  /// Chooses the cores of the junctions among `groups`, and extends them. A group is left to each chain.
  void widen_junctions(const std::vector<SliceGroup>& groups) {
    for (const SliceGroup& g : groups)
      if (is_junction(g))
        core_[root(g.core)] = *std::max_element(g.slices.begin(), g.slices.end(), [&](auto a, auto b) {
          return sections_[a].width_m < sections_[b].width_m;
        });
    for (const SliceChain& c : chains_of(groups)) {
      std::size_t first = 0, last = c.groups.size();
      const auto extend = [&](std::uint32_t junction, std::uint32_t group) {
        const std::uint32_t core = core_[root(groups[junction].core)];
        const CrossSection& hall = sections_[core];
        if ((sections_[groups[group].core].center - hall.center).norm() >= 0.5 * hall.width_m) return false;
        unite(groups[junction].core, groups[group].core, core);
        return true;
      };
      if (c.junctions[0] != kNoGroup)
        while (first + 1 < last && extend(c.junctions[0], c.groups[first])) ++first;
      if (c.junctions[1] != kNoGroup)
        while (first + 1 < last && extend(c.junctions[1], c.groups[last - 1])) --last;
    }
  }

 private:
  static std::uint32_t end_of(const SliceChain& c) {
    return c.junctions[0] != kNoGroup ? c.junctions[0] : c.junctions[1];
  }
  static std::uint32_t other_end_of(const SliceChain& c) {
    return c.junctions[1] != kNoGroup ? c.junctions[1] : c.junctions[0];
  }
  double width_m(const SliceGroup& g) const { return sections_[g.core].width_m; }
  const Vec3& center(const SliceGroup& g) const { return sections_[g.core].center; }

  /// Along the centres, from junction to junction if there is one at either end.
  double length_m(const std::vector<SliceGroup>& groups, const SliceChain& c) const {
    std::vector<Vec3> line;
    const bool joins = c.junctions[0] != kNoGroup && c.junctions[1] != kNoGroup;
    if (joins) line.push_back(center(groups[c.junctions[0]]));
    for (const std::uint32_t g : c.groups) line.push_back(center(groups[g]));
    if (joins) line.push_back(center(groups[c.junctions[1]]));
    double length_m = 0;
    for (std::size_t i = 1; i < line.size(); ++i) length_m += (line[i] - line[i - 1]).norm();
    return length_m;
  }

  bool is_short(const std::vector<SliceGroup>& groups, const SliceChain& c) const {
    const auto ends = std::count(c.junctions.begin(), c.junctions.end(), kNoGroup);
    if (ends == 2 && !c.is_ring) return false;  // a passage of its own
    if (c.groups.empty()) return true;
    if (ends == 1) return is_short_dead_end(groups, c);
    double width = 0;
    for (const std::uint32_t g : c.groups) width += width_m(groups[g]) / static_cast<double>(c.groups.size());
    for (const std::uint32_t j : c.junctions)
      if (j != kNoGroup) width = std::max(width, width_m(groups[j]));
    if (c.is_ring || c.junctions[0] == c.junctions[1]) width *= 2;  // there and back
    return length_m(groups, c) < std::max(width, 2 * band_m_);
  }
  /// Looks at ever longer pieces of it, beginning half a band behind its last centre. A hall's corner is as
  /// wide as it is deep; a passage that leads out of a hall is not.
  bool is_short_dead_end(const std::vector<SliceGroup>& groups, const SliceChain& c) const {
    std::vector<std::uint32_t> from_end = c.groups;
    if (c.junctions[1] == kNoGroup) std::reverse(from_end.begin(), from_end.end());
    double length = 0.5 * band_m_, widest = 2 * band_m_;
    for (std::size_t i = 0; i < from_end.size(); ++i) {
      if (i > 0) length += (center(groups[from_end[i]]) - center(groups[from_end[i - 1]])).norm();
      widest = std::max(widest, width_m(groups[from_end[i]]));
      if (length >= widest) return false;
    }
    return true;
  }

  std::uint32_t root(std::uint32_t s) {
    while (parent_[s] != s) s = parent_[s] = parent_[parent_[s]];
    return s;
  }
  void unite(std::uint32_t a, std::uint32_t b, std::uint32_t core) {
    a = root(a), b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
    core_[std::min(a, b)] = core;
  }
  /// A chain with the groups at its ends. The widest end's core is that of the whole; of a ring, that of
  /// `first`.
  void unite(const std::vector<SliceGroup>& groups, const SliceChain& c, std::uint32_t first) {
    std::uint32_t core = core_[root(groups[first].core)];
    for (const std::uint32_t j : c.junctions)
      if (j != kNoGroup)
        if (const std::uint32_t other = core_[root(groups[j].core)];
            sections_[other].width_m > sections_[core].width_m)
          core = other;
    for (const std::uint32_t g : c.groups) unite(groups[first].core, groups[g].core, core);
    for (const std::uint32_t j : c.junctions)
      if (j != kNoGroup) unite(groups[first].core, groups[j].core, core);
  }

  const std::vector<Slice>& slices_;
  const std::vector<CrossSection>& sections_;
  double band_m_;
  std::vector<std::uint32_t> parent_, core_;  // `core_`: of each root
};

}  // namespace

std::vector<SliceChain> chains_of(const std::vector<SliceGroup>& groups) {
  std::vector<SliceChain> out;
  std::vector<char> seen(groups.size());
  for (std::uint32_t g = 0; g < groups.size(); ++g) {
    if (!is_junction(groups[g])) continue;
    for (const std::uint32_t n : groups[g].next)
      if (is_junction(groups[n]) ? g < n : !seen[n]) out.push_back(walked(groups, g, n, seen));
  }
  for (const std::size_t ways : {0u, 1u, 2u})  // without a junction: between two ends, or all around
    for (std::uint32_t g = 0; g < groups.size(); ++g)
      if (!seen[g] && groups[g].next.size() == ways) out.push_back(walked(groups, kNoGroup, g, seen));
  return out;
}

std::vector<SliceGroup> simplified(const std::vector<Slice>& slices,
                                   const std::vector<CrossSection>& sections, double band_m) {
  Merging merging(slices, sections, band_m);
  std::vector<SliceGroup> groups = merging.groups();
  while (merging.merge_short(groups)) groups = merging.groups();
  merging.widen_junctions(groups);
  return merging.groups();
}

bool is_open_end(std::span<const std::uint32_t> last, const std::vector<SliceGroup>& groups,
                 const std::vector<Slice>& slices, const PassageGrid& grid) {
  const double band_m = kBandCubes * grid.cube_m();
  std::uint64_t frontier_cells = 0, most_cells = 0;
  for (const std::uint32_t g : last)
    for (const std::uint32_t s : groups[g].slices) {
      frontier_cells += slices[s].frontier_cells;
      most_cells = std::max(most_cells, slices[s].free_cells);
    }
  const double frontier_m2 = static_cast<double>(frontier_cells) * grid.cell_m * grid.cell_m;
  const double area_m2 = static_cast<double>(most_cells) * grid.cell_m * grid.cell_m * grid.cell_m / band_m;
  return 4 * frontier_m2 >= area_m2;
}

}  // namespace karst::core
