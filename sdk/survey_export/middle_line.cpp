#include "sdk/survey_export/middle_line.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core_stack/planning/free_space/free_way.h"
#include "core_stack/planning/passages/slice_graph.h"

namespace karst::survey_export {
namespace {

using core::CrossSection;
using core::kNoGroup;
using core::SliceChain;
using core::SliceGroup;
using core::Vec3;

constexpr double kStep_m = 0.3;        // between the places of the trajectory that are looked up
constexpr double kWallMargin_m = 0.5;  // of the last station of a dead end to the rock ahead of it
constexpr double kMostExtension_m = 3.0;
constexpr double kMostStep_m = 5.0;               // between two points of a line
constexpr std::size_t kMostSearched = 1'000'000;  // cells, between two points
constexpr std::uint32_t kNoNode = ~std::uint32_t{0};

/// Moves `p` to the middle between what bounds the free space on both sides of a line through it.
Vec3 centred(const core::VoxelMap& map, const Vec3& p, const Vec3& direction, double most_m) {
  const double ahead_m = free_reach_m(map, p, direction), behind_m = free_reach_m(map, p, -direction);
  const Vec3 moved = p + std::clamp(0.5 * (ahead_m - behind_m), -most_m, most_m) * direction;
  return sees(map, p, moved) ? moved : p;
}

/// Two directions across a tangent, the first of them level.
std::array<Vec3, 2> across(const Vec3& tangent) {
  Vec3 side = tangent.cross(Vec3::UnitZ());
  side = side.norm() > 0.1 ? side.normalized() : Vec3::UnitX();
  return {side, side.cross(tangent).normalized()};
}

class Lines {
 public:
  Lines(const core::VoxelMap& map, const core::FreeParts& space, std::span<const Vec3> flown)
      : map_(map), space_(space), slices_(sliced(space)), band_m_(core::kBandCubes * space.grid.cube_m()) {
    std::vector<CrossSection> sections;
    for (const core::Slice& s : slices_.slices)
      sections.push_back(cross_section(map, space.parts[s.middle].middle, 0.5 * band_m_));
    groups_ = core::simplified(slices_.slices, sections, band_m_);
    mark_flown(flown);
    for (const SliceGroup& g : groups_) points_.push_back(point_of(g, sections[g.core]));
    node_of_.assign(groups_.size(), kNoNode);
  }

  MiddleLines found() {
    start_group_ = group_of(slices_.slice_of[space_.start]);
    node(start_group_, LineNode::Kind::start);
    for (const SliceChain& c : core::chains_of(groups_)) add_chain(c);
    order();
    return std::move(out_);
  }

 private:
  void mark_flown(std::span<const Vec3> flown) {
    flown_.assign(slices_.slices.size(), 0);
    const Vec3* last = nullptr;
    for (const Vec3& p : flown) {
      if (last != nullptr && (p - *last).norm() < kStep_m) continue;
      last = &p;
      if (const std::uint32_t part = space_.nearest(p); part != core::kNoPart)
        flown_[slices_.slice_of[part]] = 1;
    }
  }

  LinePoint point_of(const SliceGroup& g, const CrossSection& section) const {
    LinePoint p;
    const Vec3& middle = space_.parts[slices_.slices[g.core].middle].middle;
    p.position = map_.at(section.center) == core::Cell::free ? section.center
                                                             : free_near(map_, middle).value_or(middle);
    p.width_m = section.width_m;
    p.height_m = section.height_m;
    p.flown = std::any_of(g.slices.begin(), g.slices.end(), [&](auto s) { return flown_[s] != 0; });
    return p;
  }

  std::uint32_t group_of(std::uint32_t slice) const {
    for (std::uint32_t g = 0; g < groups_.size(); ++g)
      if (std::binary_search(groups_[g].slices.begin(), groups_[g].slices.end(), slice)) return g;
    return 0;
  }

  std::uint32_t add_node(LineNode::Kind kind, const LinePoint& point) {
    out_.nodes.push_back({kind, point});
    return static_cast<std::uint32_t>(out_.nodes.size() - 1);
  }
  std::uint32_t node(std::uint32_t group, LineNode::Kind kind) {
    if (node_of_[group] == kNoNode) node_of_[group] = add_node(kind, points_[group]);
    return node_of_[group];
  }

  /// Towards the rock at the end of a passage; the last slice ends up to a band before it.
  std::optional<LinePoint> extended(const std::vector<LinePoint>& line) const {
    if (line.size() < 2) return std::nullopt;
    const Vec3 step = line.back().position - line[line.size() - 2].position;
    if (step.norm() < 1e-3) return std::nullopt;
    const Vec3 ahead = step.normalized();
    const double reach_m = free_reach_m(map_, line.back().position, ahead);
    const double further_m = std::min(reach_m - kWallMargin_m, kMostExtension_m);
    if (further_m < kWallMargin_m) return std::nullopt;
    LinePoint p = line.back();
    p.position += further_m * ahead;
    if (!sees(map_, line.back().position, p.position)) return std::nullopt;
    return p;
  }

  void add_chain(const SliceChain& chain) {
    std::vector<std::uint32_t> groups = chain.groups;
    if (chain.is_ring) {
      const auto begin = std::find(groups.begin(), groups.end(), start_group_);
      std::rotate(groups.begin(), begin == groups.end() ? groups.begin() : begin, groups.end());
      groups.push_back(groups.front());
      center(groups, {false, false});
      return add_line(groups, {false, false});
    }
    const std::array<bool, 2> free_end{chain.junctions[0] == kNoGroup, chain.junctions[1] == kNoGroup};
    if (!free_end[0]) groups.insert(groups.begin(), chain.junctions[0]);
    if (!free_end[1]) groups.push_back(chain.junctions[1]);
    center(groups, free_end);
    const auto at = std::find(groups.begin(), groups.end(), start_group_);
    if (at == groups.end() || at == groups.begin() || at + 1 == groups.end())
      return add_line(groups, free_end);
    const std::vector<std::uint32_t> before(groups.begin(), at + 1), after(at, groups.end());
    if (!free_end[0] || !is_niche(before, false)) add_line(before, {free_end[0], false});
    if (!free_end[1] || !is_niche(after, true)) add_line(after, {false, free_end[1]});
  }

  /// From the start to rock, no longer than the passage is wide: no way that a surveyor would follow.
  bool is_niche(const std::vector<std::uint32_t>& groups, bool last) const {
    double length_m = 0;
    for (std::size_t i = 1; i < groups.size(); ++i)
      length_m += (points_[groups[i]].position - points_[groups[i - 1]].position).norm();
    return kind_of_end(groups, last) == LineNode::Kind::dead_end &&
           length_m < std::max(points_[start_group_].width_m, band_m_);
  }

  LineNode::Kind kind_of_end(const std::vector<std::uint32_t>& groups, bool last) const {
    const std::size_t n = std::min<std::size_t>(2, groups.size());
    const std::span<const std::uint32_t> all(groups);
    const bool open =
        core::is_open_end(last ? all.last(n) : all.first(n), groups_, slices_.slices, space_.grid);
    return open ? LineNode::Kind::open_end : LineNode::Kind::dead_end;
  }

  /// The outermost groups are nodes.
  void add_line(const std::vector<std::uint32_t>& groups, std::array<bool, 2> free_end) {
    MiddleLine line;
    for (const std::uint32_t g : groups) line.points.push_back(points_[g]);
    fill_flown(line.points);
    std::array<LineNode::Kind, 2> kinds{LineNode::Kind::junction, LineNode::Kind::junction};
    for (const std::size_t side : {0u, 1u})
      if (free_end[side]) kinds[side] = kind_of_end(groups, side == 1);
    for (const std::size_t side : {1u, 0u}) {
      const std::uint32_t group = side == 0 ? groups.front() : groups.back();
      const bool is_own = free_end[side] && group != start_group_;
      if (side == 0) std::reverse(line.points.begin(), line.points.end());
      if (is_own && kinds[side] == LineNode::Kind::dead_end)
        if (const std::optional<LinePoint> more = extended(line.points)) line.points.push_back(*more);
      line.nodes[side] = is_own ? add_node(kinds[side], line.points.back()) : node(group, kinds[side]);
      if (side == 0) std::reverse(line.points.begin(), line.points.end());
    }
    if (line.points.size() < 2) return;
    join(line);
    out_.lines.push_back(std::move(line));
  }

  /// Moves the points of a chain between the walls, and between floor and ceiling, across the chain, and
  /// measures them there. Its junctions stay: other chains share them. (The narrowest line of a cross-section
  /// may cut a corner.)
  void center(const std::vector<std::uint32_t>& groups, std::array<bool, 2> free_end) {
    constexpr int kRounds = 3;  // a better line has better directions
    const std::size_t n = groups.size(), first = free_end[0] ? 0 : 1, end = n - (free_end[1] ? 0 : 1);
    if (n < 2) return;
    const auto at = [&](std::size_t i) -> const Vec3& { return points_[groups[i]].position; };
    for (int round = 0; round < kRounds; ++round) {
      std::vector<LinePoint> moved;
      for (std::size_t i = first; i < end; ++i) {
        const std::size_t from = i < 2 ? std::min<std::size_t>(i == 0 && n > 3 ? 1 : 0, n - 2) : i - 2;
        const std::size_t to = i + 2 < n ? i + 2 : i + 1 == n && n > 3 ? n - 2 : n - 1;
        moved.push_back(points_[groups[i]]);
        const Vec3 along = at(to) - at(from);
        if (along.norm() < 1e-3) continue;
        LinePoint& p = moved.back();
        const std::array<Vec3, 2> sides = across(along.normalized());
        for (const Vec3& side : sides) p.position = centred(map_, p.position, side, 0.5 * band_m_);
        p.width_m = free_reach_m(map_, p.position, sides[0]) + free_reach_m(map_, p.position, -sides[0]);
        p.height_m = free_reach_m(map_, p.position, sides[1]) + free_reach_m(map_, p.position, -sides[1]);
      }
      for (std::size_t i = first; i < end; ++i) points_[groups[i]] = moved[i - first];
    }
    for (const std::uint32_t g : groups)
      if (node_of_[g] != kNoNode) out_.nodes[node_of_[g]].point = points_[g];
  }

  /// A slice or two that the trajectory did not touch, between flown ones, were passed.
  static void fill_flown(std::vector<LinePoint>& points) {
    constexpr std::size_t kGap = 2;
    for (std::size_t i = 0, last = points.size(); i < points.size(); ++i) {
      if (!points[i].flown) continue;
      if (last < i && i - last <= kGap + 1)
        for (std::size_t k = last + 1; k < i; ++k) points[k].flown = true;
      last = i;
    }
  }

  /// Puts points in where two do not see each other, or are far apart.
  void join(MiddleLine& line) const {
    std::vector<LinePoint> out{line.points.front()};
    for (std::size_t i = 1; i < line.points.size(); ++i) {
      const LinePoint from = line.points[i - 1], &to = line.points[i];
      if (!sees(map_, from.position, to.position)) {
        const auto way = free_way(map_, from.position, to.position, 2 * band_m_, kMostSearched);
        if (!way) ++line.blocked;
        for (const Vec3& p : way.value_or(std::vector<Vec3>{})) {
          LinePoint between = to;
          between.position = p;
          between.flown = from.flown && to.flown;
          between.detour = true;
          out.push_back(between);
        }
      } else {
        const int steps = static_cast<int>(std::ceil((to.position - from.position).norm() / kMostStep_m));
        for (int k = 1; k < steps; ++k) {
          const double f = static_cast<double>(k) / steps;
          LinePoint between = from;
          between.position += f * (to.position - from.position);
          between.flown = from.flown && to.flown;
          between.detour = true;
          out.push_back(between);
        }
      }
      out.push_back(to);
    }
    line.points = std::move(out);
  }

  /// Turns and sorts the lines as they are reached from the start, along the lines.
  void order() {
    std::vector<double> away(out_.nodes.size(), std::numeric_limits<double>::infinity());
    std::vector<double> length;
    for (const MiddleLine& l : out_.lines) {
      length.push_back(0);
      for (std::size_t i = 1; i < l.points.size(); ++i)
        length.back() += (l.points[i].position - l.points[i - 1].position).norm();
    }
    away[0] = 0;
    for (bool changed = true; changed;) {  // Bellman and Ford: there are few lines
      changed = false;
      for (std::size_t i = 0; i < out_.lines.size(); ++i) {
        const auto [a, b] = out_.lines[i].nodes;
        for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)})
          if (away[from] + length[i] < away[to] - 1e-9) {
            away[to] = away[from] + length[i];
            changed = true;
          }
      }
    }
    for (MiddleLine& l : out_.lines)
      if (away[l.nodes[1]] < away[l.nodes[0]]) {
        std::swap(l.nodes[0], l.nodes[1]);
        std::reverse(l.points.begin(), l.points.end());
      }
    std::stable_sort(out_.lines.begin(), out_.lines.end(), [&](const MiddleLine& a, const MiddleLine& b) {
      return away[a.nodes[0]] < away[b.nodes[0]];
    });
  }

  const core::VoxelMap& map_;
  const core::FreeParts& space_;
  core::Slices slices_;
  double band_m_;
  std::vector<SliceGroup> groups_;
  std::vector<char> flown_;        // each slice
  std::vector<LinePoint> points_;  // each group
  std::vector<std::uint32_t> node_of_;
  std::uint32_t start_group_ = 0;
  MiddleLines out_;
};

}  // namespace

MiddleLines middle_lines(const core::VoxelMap& map, const Vec3& start, std::span<const Vec3> flown) {
  core::WorkBudget unlimited(std::numeric_limits<std::uint64_t>::max());
  const std::optional<core::FreeParts> space = free_parts_around(map, start, unlimited);
  if (!space || space->parts.empty()) return {};
  return Lines(map, *space, flown).found();
}

}  // namespace karst::survey_export
