#include "sdk/cave_drawing/unrolled.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "core_stack/planning/passages/cross_section.h"
#include "sdk/cave_drawing/cell_mask.h"
#include "sdk/cave_drawing/free_runs.h"
#include "sdk/cave_drawing/map_plan.h"
#include "sdk/cave_drawing/passage_strips.h"
#include "sdk/cave_drawing/strip_places.h"
#include "sdk/cave_drawing/way_between.h"

namespace karst::cave_drawing {
namespace {

using core::Vec3;

constexpr double kApart_m = 1.0;   // between passages that are drawn beside each other
constexpr double kShift_m = 4.0;   // by which a side passage is tried farther and farther aside
constexpr double kFurthest_m = 4;  // that a wall is from the last place of a passage

struct StripPoint {
  Vec3 p;
  double s_m = 0;  // horizontally, from the first place
  double width_m = 0;
  Vec3 ahead = Vec3::UnitX();  // horizontal
  bool is_steep = false;
};

Vec3 level(const Vec3& v) { return {v.x(), v.y(), 0}; }

/// Horizontal, from a place of the strip on; where it is a shaft that of the next place that has one.
Vec3 heading_from(const std::vector<Vec3>& line, std::size_t i) {
  for (std::size_t j = i; j + 1 < line.size(); ++j)
    if (const Vec3 d = level(line[j + 1] - line[j]); d.norm() > 0.3) return d.normalized();
  for (std::size_t j = std::min(i, line.size() - 1); j > 0; --j)
    if (const Vec3 d = level(line[j] - line[j - 1]); d.norm() > 0.3) return d.normalized();
  return Vec3::UnitX();
}

/// Without the zigzag of places that lie now on this side of a shaft and now on that: along it a profile
/// would grow wider and wider. Its ends stay.
std::vector<Vec3> without_zigzag(std::vector<Vec3> line) {
  for (int round = 0; round < 3; ++round) {
    const std::vector<Vec3> before = line;
    for (std::size_t i = 1; i + 1 < line.size(); ++i)
      line[i] = 0.25 * before[i - 1] + 0.5 * before[i] + 0.25 * before[i + 1];
  }
  return line;
}

struct StripLine {
  std::vector<StripPoint> points;
  std::vector<double> place_s_m;  // of the strip's places
};

/// Points half a cell apart along the strip, to the wall where it ends (and begins).
StripLine sampled(const core::VoxelMap& map, const PassageLines& lines, const PassageStrip& strip,
                  bool is_first) {
  std::vector<Vec3> line;
  std::vector<double> width_m;
  for (const std::uint32_t i : strip.points) {
    line.push_back(lines.points[i].middle);
    width_m.push_back(lines.points[i].width_m);
  }
  const auto to_wall = [&](const Vec3& from, const Vec3& d) {
    return from + std::min(kFurthest_m, core::free_reach_m(map, from, d)) * d;
  };
  const std::size_t places = line.size();
  const bool to_end = !strip.closes_loop && lines.points[strip.points.back()].next.size() < 2;
  const bool from_wall = is_first && lines.points[strip.points.front()].next.size() < 2;
  const Vec3 first_heading = heading_from(line, 0), last_heading = heading_from(line, places - 1);
  if (to_end) {
    line.push_back(to_wall(line.back(), last_heading));
    width_m.push_back(width_m.back());
  }
  if (from_wall) {
    line.insert(line.begin(), to_wall(line.front(), -first_heading));
    width_m.insert(width_m.begin(), width_m.front());
  }
  const std::vector<Vec3> smooth = without_zigzag(line);
  StripLine out;
  double s = from_wall ? -level(smooth[1] - smooth[0]).norm() : 0;
  const double step = 0.5 * map.resolution_m();
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (i >= (from_wall ? 1u : 0u) && out.place_s_m.size() < places) out.place_s_m.push_back(s);
    if (i + 1 == line.size()) break;
    const Vec3 d = smooth[i + 1] - smooth[i];
    const double across = level(d).norm();
    const std::vector<Vec3> way = way_between(map, line[i], line[i + 1], step);
    for (std::size_t k = 0; k < way.size(); ++k) {
      const double t = static_cast<double>(k) / static_cast<double>(way.size() - 1);
      out.points.push_back({way[k], s + t * across, (1 - t) * width_m[i] + t * width_m[i + 1],
                            heading_from(smooth, i), std::abs(d.z()) > across});
    }
    s += across;
  }
  if (out.points.empty()) out.points.push_back({line.front(), 0, width_m.front(), first_heading, true});
  return out;
}

int cell_of(double v, double cell_m) { return static_cast<int>(std::floor(v / cell_m + 1e-9)); }

/// From below, and one where several touch: a shaft gives a column a run for each of its points.
std::vector<Run> merged(std::vector<Run> runs) {
  std::sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.low < b.low; });
  std::vector<Run> out;
  for (const Run& run : runs)
    if (!out.empty() && run.low <= out.back().high + 1)
      out.back().high = std::max(out.back().high, run.high);
    else
      out.push_back(run);
  return out;
}

/// Rock that was seen where a strip ends.
void add_end_rock(const core::VoxelMap& map, const StripPoint& end, const Vec3& outwards,
                  const std::vector<Run>& runs, int column, ProfileCells& rock) {
  const double cell_m = map.resolution_m();
  for (const Run& run : runs)
    for (int z = run.low; z <= run.high; ++z)
      for (const double out : {0.75, 1.5, 2.25}) {
        Vec3 p = end.p + out * cell_m * outwards;
        p.z() = (z + 0.5) * cell_m;
        if (map.at(p) != core::Cell::occupied) continue;
        rock[column].push_back({z, z});
        break;
      }
}

/// The cells of a strip, with its first place in column 0; heights are those of the map. `rock` is where
/// walls beside them were seen.
ProfileCells cells_of(const core::VoxelMap& map, const std::vector<StripPoint>& points, ProfileCells& rock) {
  ProfileCells cells;
  const double cell_m = map.resolution_m();
  for (const StripPoint& at : points) {
    if (map.at(at.p) != core::Cell::free) continue;  // the line cuts a corner
    const double up = core::free_reach_m(map, at.p, Vec3::UnitZ());
    const double down = core::free_reach_m(map, at.p, -Vec3::UnitZ());
    constexpr double kRounding = 1e-6;
    const Run run{cell_of(at.p.z() - down + kRounding, cell_m), cell_of(at.p.z() + up - kRounding, cell_m)};
    const int column = cell_of(at.s_m, cell_m);
    cells[column].push_back(run);
    const auto is_rock = [&](int z) {
      return map.at(Vec3(at.p.x(), at.p.y(), (z + 0.5) * cell_m)) == core::Cell::occupied;
    };
    if (is_rock(run.high + 1) || is_rock(run.high + 2)) rock[column].push_back({run.high + 1, run.high + 1});
    if (is_rock(run.low - 1) || is_rock(run.low - 2)) rock[column].push_back({run.low - 1, run.low - 1});
    if (!at.is_steep) continue;
    const double most = std::max(cell_m, at.width_m);
    const double ahead = std::min(most, core::free_reach_m(map, at.p, at.ahead));
    const double behind = std::min(most, core::free_reach_m(map, at.p, -at.ahead));
    const int z = cell_of(at.p.z(), cell_m);
    for (int x = cell_of(at.s_m - behind + kRounding, cell_m);
         x <= cell_of(at.s_m + ahead - kRounding, cell_m); ++x)
      cells[x].push_back({z, z});
    const auto add_side = [&](double reach, const Vec3& d, int beside) {
      const auto cell_behind = [&](double cells_on) {
        return map.at(Vec3(at.p + (reach + cells_on * cell_m) * d));
      };
      const bool is_open =
          reach < most && cell_behind(0.5) == core::Cell::unknown && cell_behind(1.5) != core::Cell::occupied;
      if (!is_open) rock[beside].push_back({z, z});
    };
    add_side(ahead, at.ahead, cell_of(at.s_m + ahead - kRounding, cell_m) + 1);
    add_side(behind, -at.ahead, cell_of(at.s_m - behind + kRounding, cell_m) - 1);
  }
  for (auto& [x, runs] : cells) runs = merged(std::move(runs));
  // The line may jump over a corner of rock: what is on both sides of it is drawn through.
  std::optional<int> before;
  ProfileCells bridged = cells;
  for (const auto& [x, runs] : cells) {
    if (before)
      for (int gap = *before + 1; gap < x; ++gap) bridged[gap] = cells.at(*before);
    before = x;
  }
  return bridged;
}

CellMask mask_of(const ProfileCells& drawn, const std::string& file) {
  int low = 0, high = 0;
  bool any = false;
  for (const auto& [x, runs] : drawn)
    for (const Run& r : runs) {
      low = any ? std::min(low, r.low) : r.low;
      high = any ? std::max(high, r.high) : r.high;
      any = true;
    }
  CellMask mask(file, drawn.begin()->first, low, drawn.rbegin()->first, high);
  for (const auto& [x, runs] : drawn)
    for (const Run& r : runs)
      for (int z = r.low; z <= r.high; ++z) mask.set(x, z);
  return mask;
}

}  // namespace

UnrolledProfile unrolled_profile(const core::VoxelMap& map, const PassageLines& lines, double entrance_z_m,
                                 const std::string& file) {
  UnrolledProfile out;
  out.drawing.view = View::extended_profile;
  const double cell_m = map.resolution_m();
  const auto cells = [&](double m) { return std::max(1, static_cast<int>(std::lround(m / cell_m))); };
  std::vector<std::optional<double>> s_of(lines.points.size());
  const auto drawn_at = [&](double s, double z) { return Point(s, z - entrance_z_m); };
  ProfileCells drawn, rock;
  std::size_t moved = 0;
  for (const PassageStrip& strip : passage_strips(lines)) {
    const bool is_first = drawn.empty();
    const StripLine line = sampled(map, lines, strip, is_first);
    ProfileCells own_rock;
    const ProfileCells own = cells_of(map, line.points, own_rock);
    if (own.empty()) continue;
    const bool to_end = !strip.closes_loop && lines.points[strip.points.back()].next.size() < 2;
    const bool from_wall = is_first && lines.points[strip.points.front()].next.size() < 2;
    for (const bool at_first : {true, false}) {
      const int last = at_first ? own.begin()->first : own.rbegin()->first,
                beyond = at_first ? last - 1 : last + 1;
      const StripPoint& end = at_first ? line.points.front() : line.points.back();
      if (at_first ? from_wall : to_end)
        add_end_rock(map, end, at_first ? Vec3(-end.ahead) : end.ahead, own.at(last), beyond, own_rock);
      else
        for (const Run& run : own.at(last)) own_rock[beyond].push_back(run);  // cut there, and not open
    }
    const PassagePoint& branch = lines.points[strip.points.front()];
    const double from_s = s_of[strip.points.front()].value_or(0.0);
    const int column = cell_of(from_s, cell_m);
    StripPlace place;
    if (is_first) {
      out.length_m = line.points.back().s_m - line.points.front().s_m;
    } else {
      const int hall = cells(std::max(2.0, branch.width_m)) + cells(kApart_m);
      place = place_for(drawn, own, column, cells(kApart_m), hall, cells(kShift_m),
                        strip.points.front() == lines.first);
    }
    const auto s_drawn = [&](double s) {
      const double origin = is_first ? 0.0 : from_s + (place.column - column) * cell_m;
      return place.to_left ? origin - s : origin + s;
    };
    for (std::size_t i = 0; i < strip.points.size(); ++i)
      if (!s_of[strip.points[i]]) s_of[strip.points[i]] = s_drawn(line.place_s_m[i]);
    for (const auto& [x, runs] : own) {
      auto& there = drawn[place.of(x)];
      there.insert(there.end(), runs.begin(), runs.end());
    }
    for (const auto& [x, runs] : own_rock) {
      auto& there = rock[place.of(x)];
      there.insert(there.end(), runs.begin(), runs.end());
    }
    const double z = branch.middle.z();
    if (place.column != column) {
      const std::string name = letters(moved++);
      const Point from = drawn_at(from_s, z), to = drawn_at(s_drawn(0), z);
      out.drawing.links.push_back({from, to});
      out.drawing.marks.push_back({Mark::Kind::joint, from, name});
      out.drawing.marks.push_back({Mark::Kind::joint, to, name});
    }
    if (strip.closes_loop) {
      const std::uint32_t end = strip.points.back();
      const Point to = drawn_at(s_of[end].value_or(0.0), lines.points[end].middle.z());
      const Point here = drawn_at(s_drawn(line.place_s_m.back()), lines.points[end].middle.z());
      if ((to - here).norm() > 2 * kShift_m) {
        const std::string name = letters(moved++);
        out.drawing.marks.push_back({Mark::Kind::joint, here, name});
        out.drawing.marks.push_back({Mark::Kind::joint, to, name});
      }
    }
    if (const PassagePoint& end = lines.points[strip.points.back()]; end.leads_on)
      out.drawing.marks.push_back(
          {Mark::Kind::unknown_end, drawn_at(s_drawn(line.points.back().s_m), end.middle.z()), "?"});
  }
  for (std::size_t i = 0; i < lines.points.size(); ++i)
    out.at.push_back(drawn_at(s_of[i].value_or(0.0), lines.points[i].middle.z()));
  if (drawn.empty()) return out;
  rock[0];  // where nothing was seen, the mask is empty
  const CellMask seen = mask_of(rock, file);
  draw_mask(mask_of(drawn, file), cell_m, out.drawing, known_by(seen));
  const auto lower = [&](std::vector<Line>& all) {
    for (Line& l : all)
      for (Point& p : l) p.y() -= entrance_z_m;
  };
  for (auto& rings : out.drawing.spaces) lower(rings);
  lower(out.drawing.walls);
  lower(out.drawing.uncertain_walls);
  return out;
}

}  // namespace karst::cave_drawing
