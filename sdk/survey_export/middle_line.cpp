#include "sdk/survey_export/middle_line.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core_stack/planning/free_space/free_way.h"
#include "core_stack/planning/passages/slice_graph.h"
#include "sdk/survey_export/axes.h"
#include "sdk/survey_export/median.h"
#include "sdk/survey_export/refined_line.h"

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
    for (std::uint32_t n = 0; n < out_.nodes.size(); ++n)
      if (n == 0 || out_.nodes[n].kind == LineNode::Kind::junction) settle(n);
    for (MiddleLine& line : out_.lines) join(line);
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
    constexpr std::size_t kAxisPoints = 8;
    if (line.size() < 2) return std::nullopt;
    const Vec3 ahead = axis_of(std::span(line).last(std::min(kAxisPoints, line.size()))).direction;
    if (!(ahead.dot(line.back().position - line[line.size() - 2].position) > 0)) return std::nullopt;
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
      return add_line(groups, {false, false});
    }
    const std::array<bool, 2> free_end{chain.junctions[0] == kNoGroup, chain.junctions[1] == kNoGroup};
    if (!free_end[0]) groups.insert(groups.begin(), chain.junctions[0]);
    if (!free_end[1]) groups.push_back(chain.junctions[1]);
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
    line.points = refined_line(map_, line.points, free_end);
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
    out_.lines.push_back(std::move(line));
  }

  /// The end of a line at a junction.
  struct Branch {
    std::size_t line = 0;
    bool is_last = false;  // it ends there
  };

  /// A branch, from the junction on, without its points in the openings of the others: those as near to the
  /// junction as the branch is wide, and after them those that are wider than usual.
  static std::vector<LinePoint> outside(std::vector<LinePoint> branch) {
    constexpr double kUsual = 1.3, kFarthest = 2;
    std::vector<double> widths;
    for (const LinePoint& p : branch) widths.push_back(p.width_m);
    const double usual_m = median(std::move(widths));
    std::size_t first = 1;
    while (first + 2 < branch.size()) {
      const double away_m = (branch[first].position - branch.front().position).norm();
      if (away_m > usual_m && (branch[first].width_m < kUsual * usual_m || away_m > kFarthest * usual_m))
        break;
      ++first;
    }
    branch.erase(branch.begin() + 1, branch.begin() + static_cast<std::ptrdiff_t>(first));
    return branch;
  }

  /// Puts a junction, or the start, where the axes of its branches meet.
  void settle(std::uint32_t node) {
    constexpr std::size_t kAxisPoints = 8;
    const LinePoint before = out_.nodes[node].point;
    std::vector<Axis> axes;
    std::vector<Branch> branches;
    for (std::size_t l = 0; l < out_.lines.size(); ++l)
      for (const bool is_last : {false, true}) {
        MiddleLine& line = out_.lines[l];
        if (line.nodes[is_last ? 1 : 0] != node) continue;
        if (is_last) std::reverse(line.points.begin(), line.points.end());
        line.points = outside(std::move(line.points));
        const auto branch = std::span<const LinePoint>(line.points).subspan(1);
        if (branch.size() > 1) axes.push_back(axis_of(branch.first(std::min(kAxisPoints, branch.size()))));
        if (is_last) std::reverse(line.points.begin(), line.points.end());
        branches.push_back({l, is_last});
      }
    Vec3 meeting = meeting_of(axes, before.position);
    if ((meeting - before.position).norm() > before.width_m || !sees(map_, before.position, meeting))
      meeting = before.position;
    out_.nodes[node].point.position = meeting;
    for (const Branch& branch : branches) {
      std::vector<LinePoint>& points = out_.lines[branch.line].points;
      (branch.is_last ? points.back() : points.front()).position = meeting;
    }
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
  const std::optional<core::FreeParts> space = free_parts_around(map, start, unlimited, flown);
  if (!space || space->parts.empty()) return {};
  return Lines(map, *space, flown).found();
}

}  // namespace karst::survey_export
