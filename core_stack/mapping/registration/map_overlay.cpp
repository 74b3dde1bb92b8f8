#include "core_stack/mapping/registration/map_overlay.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core_stack/mapping/occupancy/voxel_reader.h"

namespace karst::core {
namespace {

// Rock in known free space has a larger weight than rock that fits: the walls of any two passages can fit,
// while two maps of one place hardly ever contradict each other.
constexpr double kContradiction = 3, kRoughContradiction = 2;

bool free_beside(const VoxelMap& cells, const CellKey& k) {
  constexpr CellKey kBeside[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  return std::all_of(std::begin(kBeside), std::end(kBeside),
                     [&](const CellKey& step) { return cells.at(k + step) == Cell::free; });
}

bool in_free(const VoxelMap& cells, const Vec3& p, const OverlayOptions& options) {
  const CellKey k = cells.key_of(p);
  return cells.at(k) == Cell::free && (!options.free_beside || free_beside(cells, k));
}

OverlayCounts count(const MapPiece& into, const MapPiece& from, const Pose& T_into_from,
                    const OverlayOptions& options) {
  const double cell_m = std::max(into.resolution_m, from.resolution_m);
  const double near_m = options.near_cells * cell_m, free_m = options.free_cells * cell_m;
  const std::size_t stride = from.surface.size() / options.max_points + 1;
  OverlayCounts counts;
  for (std::size_t i = 0; i < from.surface.size(); i += stride) {
    ++counts.points;
    const Vec3 p = T_into_from * from.surface[i].cast<double>();
    const double d = into.tree->nearest(p)->distance_m;
    if (d <= near_m) {
      ++counts.near;
      counts.squares_m2 += d * d;
    } else if (d > free_m && into.cells && in_free(*into.cells, p, options)) {
      ++counts.in_free;
    }
  }
  return counts;
}

double fraction(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

VoxelMap rough_cells(const MapPiece& target, double cell_m) {
  MapOptions options;
  options.resolution_m = cell_m;
  VoxelMap rough(options);
  if (target.cells)
    target.cells->for_each_known([&](const CellKey& k, Cell c, float) {
      if (c == Cell::free) rough.assign(rough.key_of(target.cells->center_of(k)), 1, -1.0f);
    });
  for (const Vec3f& p : target.surface) {
    const CellKey k = rough.key_of(p.cast<double>());
    rough.assign({k.x - 1, k.y - 1, k.z - 1}, 3, 1.0f);
  }
  return rough;
}

}  // namespace

double Overlay::source_overlap() const { return fraction(source_in_target.near, source_in_target.points); }
double Overlay::target_overlap() const { return fraction(target_in_source.near, target_in_source.points); }

double Overlay::agreement() const {
  return fraction(near(), near() + source_in_target.in_free + target_in_source.in_free);
}

double Overlay::residual_m() const {
  return near() == 0 ? 0
                     : std::sqrt((source_in_target.squares_m2 + target_in_source.squares_m2) /
                                 static_cast<double>(near()));
}

double Overlay::score() const {
  const auto of = [](const OverlayCounts& c) {
    return fraction(c.near, c.points) - kContradiction * fraction(c.in_free, c.points);
  };
  return of(source_in_target) + of(target_in_source);
}

Overlay overlay(const MapPiece& target, const MapPiece& source, const Pose& T_target_source,
                const OverlayOptions& options) {
  return {count(target, source, T_target_source, options),
          count(source, target, T_target_source.inverse(), options)};
}

RoughTarget::RoughTarget(const MapPiece& target, double cell_m) : cells_(rough_cells(target, cell_m)) {}

double RoughTarget::score(const std::vector<Vec3>& source_points, const Pose& T_target_source) const {
  const Eigen::Matrix3d R = T_target_source.orientation.toRotationMatrix();
  VoxelReader reader(cells_);
  double score = 0;
  for (const Vec3& p : source_points) {
    const Cell c = reader.at(cells_.key_of(R * p + T_target_source.position));
    score += c == Cell::occupied ? 1 : c == Cell::free ? -kRoughContradiction : 0;
  }
  return source_points.empty() ? 0 : score / static_cast<double>(source_points.size());
}

}  // namespace karst::core
