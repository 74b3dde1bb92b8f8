#include "sdk/cave_drawing/map_drawings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core_stack/common/error.h"
#include "core_stack/planning/passages/cross_section.h"
#include "sdk/cave_drawing/free_runs.h"
#include "sdk/cave_drawing/height_text.h"
#include "sdk/cave_drawing/map_plan.h"
#include "sdk/cave_drawing/passage_lines.h"
#include "sdk/cave_drawing/projection.h"
#include "sdk/cave_drawing/unrolled.h"

namespace karst::cave_drawing {
namespace {

using core::Vec3;

constexpr double kNear_m = 15;  // a find this near to a passage is drawn on its extended profile
constexpr double kFarthestEnd_m = 15;
constexpr std::size_t kHeights = 6;  // places of a passage from one that has its height to the next

void expect_finite(const FlightRecord& record, std::optional<double> bearing_rad, const std::string& file) {
  if (record.entrance && !record.entrance->allFinite())
    throw core::InputError(file, "", "the entrance's position is not a number");
  if (bearing_rad && !std::isfinite(*bearing_rad))
    throw core::InputError(file, "", "the bearing is not a number");
  for (const Vec3& p : record.path)
    if (!p.allFinite()) throw core::InputError(file, "", "a position of the path is not a number");
  for (const Find& f : record.finds)
    if (!f.position.allFinite())
      throw core::InputError(file, "", "the position of an object is not a number: " + f.what);
}

/// A place with much room around it, of a sample of the free cells.
Vec3 roomiest_place(const core::VoxelMap& map, const FreeRuns& free) {
  constexpr std::size_t kSamples = 2000;
  const std::size_t step = std::max<std::size_t>(1, free.columns.size() / kSamples);
  Vec3 best = Vec3::Zero();
  double most = -1;
  for (std::size_t i = 0; i < free.columns.size(); i += step) {
    const Column& c = free.columns[i];
    const Run& run = c.runs.front();
    const Vec3 p = map.center_of({c.x, c.y, run.low + (run.high - run.low) / 2});
    if (map.at(p) != core::Cell::free) continue;
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& d : std::array<Vec3, 3>{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()})
      least = std::min({least, core::free_reach_m(map, p, d), core::free_reach_m(map, p, -d)});
    if (least > most) most = least, best = p;
  }
  return best;
}

/// Heights of the floor: where passages meet and end, and now and then between.
std::vector<std::size_t> places_with_heights(const PassageLines& lines) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < lines.points.size(); ++i)
    if (lines.points[i].next.size() != 2) places.push_back(i);
  for (std::size_t i = 0; i < lines.points.size(); ++i)
    if (lines.points[i].next.size() == 2 && i % kHeights == 0) places.push_back(i);
  return places;
}

/// Where a passage is lost sight of, beyond its last place.
Vec3 end_of(const core::VoxelMap& map, const PassageLines& lines, const PassagePoint& last) {
  if (last.next.empty()) return last.middle;
  Vec3 ahead = last.middle - lines.points[last.next.front()].middle;
  ahead.z() = 0;
  if (ahead.norm() < 0.1) return last.middle;
  ahead.normalize();
  return last.middle + std::min(kFarthestEnd_m, core::free_reach_m(map, last.middle, ahead)) * ahead;
}

/// The outline from above, and from the side the outermost of its corners between its heights. A height that
/// the mission left open ends with the map.
void draw_border(const core::Prism& prism, const FreeRuns& free, const Vec3& entrance, double bearing,
                 std::vector<Line> Drawing::*lines, CaveDrawings& out) {
  const double low_m = std::max(prism.low_m, free.low_z * free.cell_m),
               high_m = std::min(prism.high_m, (free.high_z + 1) * free.cell_m);
  Line from_above(prism.outline.begin(), prism.outline.end());
  from_above.push_back(from_above.front());
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (const Point& corner : prism.outline) {
    const double along = projected({corner.x(), corner.y(), 0}, entrance, bearing).x();
    first = std::min(first, along);
    last = std::max(last, along);
  }
  const double low = low_m - entrance.z(), high = high_m - entrance.z();
  (out.plan.*lines).push_back(std::move(from_above));
  if (low < high)
    (out.projected.*lines).push_back({{first, low}, {last, low}, {last, high}, {first, high}, {first, low}});
}

double floor_m(const PassagePoint& p) { return p.middle.z() - 0.5 * p.height_m; }

}  // namespace

CaveDrawings map_drawings(const core::VoxelMap& map, const FlightRecord& record,
                          std::optional<double> bearing_rad, const std::string& file) {
  expect_finite(record, bearing_rad, file);
  const FreeRuns free = free_runs(map, file);
  const Vec3 entrance = record.entrance.value_or(Vec3::Zero());
  const PassageLines lines =
      passage_lines(map, record.entrance ? *record.entrance : roomiest_place(map, free), file, record.path);
  const double bearing = bearing_rad.value_or(longest_bearing(free));

  CaveDrawings out;
  out.plan = plan_of(free, file, &map);
  out.projected = projected_profile(free, entrance, bearing, file, &map);
  UnrolledProfile unrolled = unrolled_profile(map, lines, entrance.z(), file);
  out.extended = std::move(unrolled.drawing);
  const auto add = [&](Mark::Kind kind, const Vec3& p, const std::string& text) {
    out.plan.marks.push_back({kind, p.head<2>(), text});
    out.projected.marks.push_back({kind, projected(p, entrance, bearing), text});
  };

  if (record.entrance) {
    add(Mark::Kind::entrance, entrance, "entrance");
    if (!lines.points.empty())
      out.extended.marks.push_back({Mark::Kind::entrance, {unrolled.at[lines.first].x(), 0}, "entrance"});
  }
  for (const Find& f : record.finds) {
    add(Mark::Kind::find, f.position, f.what);
    double nearest = kNear_m;
    std::optional<Point> at;
    for (std::size_t i = 0; i < lines.points.size(); ++i)
      if (const double d = (lines.points[i].middle - f.position).norm(); d < nearest)
        nearest = d, at = Point(unrolled.at[i].x(), f.position.z() - entrance.z());
    if (at) out.extended.marks.push_back({Mark::Kind::find, *at, f.what});
  }
  for (const PassagePoint& p : lines.points)
    if (p.leads_on) add(Mark::Kind::unknown_end, end_of(map, lines, p), "?");
  for (const std::size_t i : places_with_heights(lines)) {
    const PassagePoint& p = lines.points[i];
    const double height = floor_m(p) - entrance.z();
    out.plan.marks.push_back({Mark::Kind::height, p.middle.head<2>(), height_text(height)});
    out.extended.marks.push_back({Mark::Kind::height, {unrolled.at[i].x(), height}, height_text(height)});
  }
  if (record.path.size() > 1) {
    Line from_above, from_aside;
    for (const Vec3& p : record.path) {
      from_above.emplace_back(p.head<2>());
      from_aside.push_back(projected(p, entrance, bearing));
    }
    out.plan.paths.push_back(std::move(from_above));
    out.projected.paths.push_back(std::move(from_aside));
  }
  if (record.region) {
    const core::FlightRegion::Limits& limits = record.region->limits();
    if (limits.keep_in) draw_border(*limits.keep_in, free, entrance, bearing, &Drawing::keep_in, out);
    for (const core::Prism& prism : limits.keep_out)
      draw_border(prism, free, entrance, bearing, &Drawing::keep_out, out);
  }
  out.facts = {record.name,  record.date,  record.from,         std::nullopt,
               std::nullopt, std::nullopt, map.free_volume_m3()};
  out.facts.floor_to_roof_m = (free.high_z - free.low_z + 1) * free.cell_m;
  if (!lines.points.empty()) out.facts.length_m = lines.length_m();
  return out;
}

}  // namespace karst::cave_drawing
