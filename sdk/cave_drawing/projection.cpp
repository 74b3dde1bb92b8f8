#include "sdk/cave_drawing/projection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sdk/cave_drawing/cell_mask.h"
#include "sdk/cave_drawing/map_plan.h"

namespace karst::cave_drawing {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

void shift(std::vector<Line>& lines, const Point& by) {
  for (Line& line : lines)
    for (Point& p : line) p += by;
}

}  // namespace

Point direction_of(double bearing_rad) { return {std::sin(bearing_rad), std::cos(bearing_rad)}; }

double longest_bearing(const std::vector<Point>& points) {
  int best = 0;
  double longest = -1;
  for (int degree = 0; degree < 180; ++degree) {
    const Point along = direction_of(degree * kDegree);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Point& p : points) {
      low = std::min(low, p.dot(along));
      high = std::max(high, p.dot(along));
    }
    if (high - low > longest + 1e-9) longest = high - low, best = degree;
  }
  return best * kDegree;
}

double longest_bearing(const FreeRuns& free) {
  // The outermost columns of each row hold the outermost in any direction.
  std::vector<Point> ends;
  for (std::size_t i = 0; i < free.columns.size(); ++i) {
    const Column& c = free.columns[i];
    const bool first = i == 0 || free.columns[i - 1].y != c.y;
    const bool last = i + 1 == free.columns.size() || free.columns[i + 1].y != c.y;
    if (first || last) ends.emplace_back(c.x, c.y);
  }
  return longest_bearing(ends);
}

Point projected(const core::Vec3& p, const core::Vec3& entrance, double bearing_rad) {
  const core::Vec3 from = p - entrance;
  return {direction_of(bearing_rad).dot(from.head<2>()), from.z()};
}

Drawing projected_profile(const FreeRuns& free, const core::Vec3& entrance, double bearing_rad,
                          const std::string& file, const core::VoxelMap* map) {
  const Point along = direction_of(bearing_rad);
  const double half = 0.5 * (std::abs(along.x()) + std::abs(along.y()));  // of a cell's width from the side
  const auto at = [&](int x, int y) { return along.dot(Point(x + 0.5, y + 0.5)); };
  const auto middle = [&](const Column& c) { return at(c.x, c.y); };
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Column& c : free.columns) {
    low = std::min(low, middle(c));
    high = std::max(high, middle(c));
  }
  CellMask mask(file, static_cast<std::int64_t>(std::floor(low - half)) - 1, free.low_z,
                static_cast<std::int64_t>(std::ceil(high + half)) + 1, free.high_z);
  // Cells whose middle a column covers.
  const auto cover = [&](CellMask& covered, double column, std::int32_t low_z, std::int32_t high_z) {
    constexpr double kRounding = 1e-6;
    const auto first = static_cast<int>(std::ceil(column - half - 0.5 + kRounding));
    const auto last = static_cast<int>(std::floor(column + half - 0.5 - kRounding));
    for (int x = first; x <= std::max(first, last); ++x)
      for (std::int32_t z = low_z; z <= high_z; ++z) covered.set(x, z);
  };
  for (const Column& c : free.columns)
    for (const Run& run : c.runs) cover(mask, middle(c), run.low, run.high);
  constexpr int kBeside = 3;
  CellMask rock(file, mask.low_x() - kBeside, mask.low_y() - kBeside, mask.high_x() + kBeside,
                mask.high_y() + kBeside);
  if (map != nullptr)
    map->for_each_known([&](const core::CellKey& k, core::Cell c, float) {
      if (c == core::Cell::occupied) cover(rock, at(k.x, k.y), k.z, k.z);
    });
  Drawing profile;
  profile.view = View::projected_profile;
  profile.bearing_rad = bearing_rad;
  draw_mask(mask, free.cell_m, profile, map == nullptr ? IsWallKnown{} : known_by(rock));
  const Point origin(-along.dot(entrance.head<2>()), -entrance.z());
  for (auto& rings : profile.spaces) shift(rings, origin);
  shift(profile.walls, origin);
  shift(profile.uncertain_walls, origin);
  return profile;
}

}  // namespace karst::cave_drawing
