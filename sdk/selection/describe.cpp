#include "sdk/selection/describe.h"

#include <algorithm>
#include <boost/property_tree/ptree.hpp>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <numeric>

#include "core_stack/common/error.h"
#include "core_stack/mapping/octomap/octomap_io.h"
#include "plugins/simulator/cave/cave.h"
#include "sdk/selection/geodesic.h"
#include "sdk/selection/passage_graph.h"

namespace karst::selection {
namespace {

using core::Vec3;

/// A measured slice of passage: its middle is the centre of the widest ball.
struct Slice {
  Vec3 middle = Vec3::Zero(), centroid = Vec3::Zero();
  std::int32_t cell = 0;  // of the middle
  double width_m = 0;
};

std::size_t farthest(const std::vector<float>& distance) {
  return static_cast<std::size_t>(std::max_element(distance.begin(), distance.end()) - distance.begin());
}

Vec3 centre(const CellIndex& cells, std::int32_t i, double edge) {
  const core::CellKey& k = cells.key(static_cast<std::size_t>(i));
  return edge * Vec3(k.x + 0.5, k.y + 0.5, k.z + 0.5);
}

/// Ascends the distance to rock in steps to 26 neighbours (with steps along the axes alone, a ridge between
/// two walls would stop it); halves the step when none ascends; at most `reach` from the start. A step
/// shorter than the distance to rock cannot pass through rock.
Vec3 climbed(const FreeSpace& space, const Vec3& from, double reach) {
  Vec3 best = from;
  double height = space.distance_to_rock(best);
  for (double step = space.resolution_m / 2; step > space.resolution_m / 20; step /= 2)
    for (bool up = true; up;) {
      up = false;
      for (int side = 0; side < 27; ++side) {
        const int x = side % 3 - 1, y = side / 3 % 3 - 1, z = side / 9 - 1;
        const Vec3 p = best + step * Vec3(x, y, z);
        if ((p - from).norm() > reach || (p - best).norm() >= height) continue;
        const double h = space.distance_to_rock(p);
        if (h > height + 1e-9) {
          best = p;
          height = h;
          up = true;
        }
      }
    }
  return best;
}

Slice measured(const FreeSpace& space, const CellIndex& cells, const std::vector<float>& depth,
               const PassageNode& node) {
  Slice s;
  s.cell = *std::max_element(node.cells.begin(), node.cells.end(), [&](std::int32_t a, std::int32_t b) {
    return depth[static_cast<std::size_t>(a)] < depth[static_cast<std::size_t>(b)];
  });
  for (const std::int32_t c : node.cells) s.centroid += centre(cells, c, space.resolution_m);
  s.centroid /= static_cast<double>(node.cells.size());
  s.middle = climbed(space, centre(cells, s.cell, space.resolution_m), 1.0);
  s.width_m = 2 * space.distance_to_rock(s.middle);
  return s;
}

std::vector<Slice> measured(const FreeSpace& space, const CellIndex& cells, const std::vector<float>& depth,
                            const std::vector<PassageNode>& nodes) {
  std::vector<Slice> slices;
  slices.reserve(nodes.size());
  for (const PassageNode& n : nodes) slices.push_back(measured(space, cells, depth, n));
  return slices;
}

/// The least value with at least `fraction` of the total weight at or below it.
double quantile(std::vector<std::pair<double, double>> value_weight, double fraction) {
  if (value_weight.empty()) return kUnknown;
  std::sort(value_weight.begin(), value_weight.end());
  double total = 0, sum = 0;
  for (const auto& [value, weight] : value_weight) total += weight;
  for (const auto& [value, weight] : value_weight)
    if ((sum += weight) >= fraction * total) return value;
  return value_weight.back().first;
}

/// Initial estimate of the width, before slivers behind bumps of the rock are removed: a slice has the weight
/// of a passage length equal to its width.
double rough_width(const std::vector<Slice>& slices, const std::vector<PassageNode>& nodes) {
  std::vector<std::pair<double, double>> values;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    values.emplace_back(slices[i].width_m,
                        static_cast<double>(nodes[i].cells.size()) / (slices[i].width_m * slices[i].width_m));
  return quantile(std::move(values), 0.5);
}

/// Of path segments as long as passages are wide: shorter ones show the rock's roughness, not the slope.
double verticality(const std::vector<PassageNode>& nodes, const std::vector<Slice>& slices, int steps) {
  double up = 0, all = 0;
  const int bands = nodes.empty() ? 0 : nodes.back().band;
  steps = std::clamp(steps, 1, std::max(1, bands));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    std::size_t at = i;
    int done = 0;
    for (; done < steps && !nodes[at].below.empty(); ++done)
      at = static_cast<std::size_t>(nodes[at].below.front());
    if (done < steps) continue;
    const Vec3 along = slices[i].centroid - slices[at].centroid;
    up += std::abs(along.z());
    all += along.norm();
  }
  return all > 0 ? up / all : kUnknown;
}

/// The longest line of sight from a place, in directions spread evenly over the sphere (the golden spiral).
double longest_sight(const FreeSpace& space, const Vec3& from) {
  constexpr int kDirections = 64;
  double longest = 0;
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1 - (2 * i + 1.0) / kDirections, r = std::sqrt(1 - z * z),
                 a = i * std::numbers::pi * (3 - std::sqrt(5.0));
    longest = std::max(longest, space.range_to_rock(from, {r * std::cos(a), r * std::sin(a), z}));
  }
  return longest;
}

}  // namespace

CaveFigures describe(const FreeSpace& space) {
  const CellIndex cells(space.flyable);
  const double edge = space.resolution_m;
  // Distances count from one end of the cave, independent of the start: the place farthest from it.
  const std::size_t end = farthest(distances_from(cells, 0));
  const std::vector<float> distance = distances_from(cells, end);
  const float band =
      static_cast<float>(std::max(2.0, 1.0 / edge));  // cells; a metre, or more than a cell's diagonal
  const double band_m = band * edge;
  const std::vector<float> depth = depths(cells);
  std::vector<PassageNode> nodes = passage_nodes(cells, distance, band);
  std::vector<Slice> slices = measured(space, cells, depth, nodes);
  const int least = std::max(2, static_cast<int>(std::ceil(rough_width(slices, nodes) / band_m)));
  nodes = without_short_ends(without_short_loops(nodes, least), least);
  slices = measured(space, cells, depth, nodes);

  CaveFigures f;
  f.volume_m3 = space.volume_m3;
  f.length_m = static_cast<double>(nodes.size()) * band_m + space.clearance_m;
  std::vector<std::pair<double, double>> widths, sights, ratios;
  double log_heights = 0;
  for (const Slice& s : slices) {
    widths.emplace_back(s.width_m, 1.0);
    sights.emplace_back(longest_sight(space, s.middle), 1.0);
    log_heights += std::log(space.range_to_rock(s.middle, Vec3::UnitZ()) +
                            space.range_to_rock(s.middle, -Vec3::UnitZ()));
  }
  f.width_m = quantile(widths, 0.5);
  f.hall_width_m = quantile(widths, 1.0);
  f.sight_m = quantile(sights, 0.5);
  f.width_spread = quantile(widths, 0.9) / quantile(widths, 0.1);
  f.height_m = std::exp(log_heights / static_cast<double>(slices.size()));
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double z = (cells.key(i).z + 0.5) * edge;
    lowest = std::min(lowest, z);
    highest = std::max(highest, z);
  }
  f.drop_m = highest - lowest + 2 * space.clearance_m;
  f.verticality = verticality(nodes, slices, least);
  f.branching = junctions(nodes) * 100.0 / f.length_m;
  f.loops = loops(nodes) * 100.0 / f.length_m;
  f.dead_ends = dead_ends(nodes) * 100.0 / f.length_m;

  // Paths from three places far from each other to all cells that are not near them.
  std::vector<float> nearest_source = distance;
  std::vector<float> from = distance;
  std::size_t source = end;
  for (int i = 0; i < 3; ++i) {
    if (i > 0) {
      source = farthest(nearest_source);
      from = distances_from(cells, source);
      for (std::size_t c = 0; c < from.size(); ++c) nearest_source[c] = std::min(nearest_source[c], from[c]);
    }
    for (const Slice& s : slices) {
      const double along = from[static_cast<std::size_t>(s.cell)] * edge;
      if (along < 3 * f.width_m) continue;
      const Vec3 line = centre(cells, s.cell, edge) - centre(cells, static_cast<std::int32_t>(source), edge);
      ratios.emplace_back(along / line.norm(), 1.0);
    }
  }
  f.tortuosity = ratios.empty() ? 1.0 : std::max(1.0, quantile(std::move(ratios), 0.5));
  return f;
}

Source source_of(const std::string& file) {
  namespace fs = std::filesystem;
  if (fs::is_directory(file)) throw core::InputError(file, "", "is a directory, not a file");
  if (!fs::is_regular_file(file)) throw core::InputError(file, "", "no such file");
  const std::string ending = fs::path(file).extension().string();
  if (ending == ".bt" || ending == ".ot") return Source::map;
  if (ending != ".info") return Source::mesh;
  return core::read_info(file).count("mesh") > 0 ? Source::mesh : Source::numbers;
}

Description describe_file(const std::string& file, const std::string& start,
                          const FreeSpaceOptions& options) {
  const Source source = source_of(file);
  if (source != Source::mesh && !start.empty())
    throw core::InputError(file, "start", "is of use with a mesh only");
  if (source == Source::numbers) return {read_figures(file), source};
  if (source == Source::map) {
    const core::VoxelMap map = core::read_octomap(file);
    return {describe(free_space_of(map, options, file)), source};
  }
  const cave::Cave cave = cave::load_cave(file, start);
  return {describe(free_space_of(cave.scene, cave.description.start.position, options, file)), source};
}

}  // namespace karst::selection
