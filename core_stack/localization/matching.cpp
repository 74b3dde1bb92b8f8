#include "core_stack/localization/matching.h"

#include <utility>

#include "core_stack/localization/parallel.h"

namespace karst::core {
namespace {

constexpr std::size_t kFeaturesPerChunk = 128;
// A plane: enough points, spread in two directions (not along one ring only), thin.
constexpr double kPlanePoints = 12, kPlaneSpread = 0.3 /* voxels */,
                 kPlaneThickness = 0.35 /* of the spread */;
// A line: enough points, spread in one direction only.
constexpr double kLinePoints = 8, kLineSpread = 0.5 /* voxels */, kLineThickness = 0.3 /* of the spread */;
// Standard deviation of a distance beside the noise of the means: a fraction of the rock's roughness in the
// window, and a constant for unmodelled effects.
constexpr double kRoughFraction = 0.2, kMinDeviation = 0.003;

/// A plane match and the sweep voxel in which it was made.
struct PlaneMatch {
  Match match;
  std::size_t level = 0, voxel = 0;
};

bool match_plane(const VoxelGrid& map, const VoxelGrid& sweep, const Vec3f& place, PlaneMatch& out) {
  const VoxelGrid::Key key = map.key_of(place);
  const VoxelGrid::Voxel* voxel = sweep.find(key);
  if (!voxel) return false;
  const VoxelGrid::Window of_map = map.window_around(key);
  const Surface s = surface_of(map, key, of_map, kPlanePoints);
  const double thick = s.deviation_m[0], spread = s.deviation_m[1];
  if (s.points < kPlanePoints || spread < kPlaneSpread * map.voxel_m() || thick > kPlaneThickness * spread)
    return false;
  const MeanPair means = means_of(map, key, of_map, sweep.window_around(key));
  if (means.points < 3) return false;
  out.match.normals = 1;
  out.match.p = means.b;
  out.match.q = means.a;
  out.match.n1 = s.axes.col(0);
  out.match.variance_m2 =
      thick * thick * (2 / means.points + kRoughFraction * kRoughFraction) + kMinDeviation * kMinDeviation;
  out.voxel = static_cast<std::size_t>(voxel - sweep.voxels().data());
  return true;
}

bool match_line(const VoxelGrid& map, const Vec3f& place, Match& m) {
  const VoxelGrid::Key key = map.key_of(place);
  const Surface s = surface_of(map, key, map.window_around(key), kLinePoints);
  const double thick = s.deviation_m[1], spread = s.deviation_m[2];
  if (s.points < kLinePoints || spread < kLineSpread * map.voxel_m() || thick > kLineThickness * spread)
    return false;
  m.normals = 2;
  m.p = place.cast<double>();
  m.q = s.mean;
  m.n1 = s.axes.col(0);
  m.n2 = s.axes.col(1);
  m.variance_m2 = thick * thick + kMinDeviation * kMinDeviation;
  return true;
}

/// Keeps only the first feature in each voxel of the sweep.
std::vector<Vec3f> one_a_voxel(const std::vector<Vec3f>& places, const VoxelGrid& sweep) {
  std::vector<char> taken(sweep.voxels().size());
  std::vector<Vec3f> out;
  for (const Vec3f& p : places)
    if (const auto* v = sweep.find(sweep.key_of(p)); v && !std::exchange(taken[v - sweep.voxels().data()], 1))
      out.push_back(p);
  return out;
}

}  // namespace

Matches find_matches(const Cloud& cloud_body, const LocalMap& map, const Pose& T_world_body,
                     std::size_t first_level, Workspace& workspace) {
  const Cloud world = transformed(T_world_body, cloud_body);
  const std::vector<VoxelGrid>& levels = map.surfaces();
  Grids& grids = workspace.grids;
  fill_grids(world.surface, levels, first_level, grids);

  const std::vector<Vec3f> places = one_a_voxel(world.planes, grids[first_level]);
  std::vector<Match> lines(world.edges.size());
  for_each_chunk(lines.size(), kFeaturesPerChunk, workspace.threads,
                 [&](std::size_t, std::size_t first, std::size_t end) {
                   for (std::size_t i = first; i < end; ++i)
                     match_line(map.edges(), world.edges[i], lines[i]);
                 });
  std::vector<PlaneMatch> planes(places.size());
  for_each_chunk(places.size(), kFeaturesPerChunk, workspace.threads,
                 [&](std::size_t, std::size_t first, std::size_t end) {
                   for (std::size_t i = first; i < end; ++i)
                     for (std::size_t l = first_level; l < levels.size() && planes[i].match.normals == 0; ++l)
                       if (match_plane(levels[l], grids[l], places[i], planes[i])) planes[i].level = l;
                 });

  Matches out;
  out.places = static_cast<int>(lines.size() + planes.size());
  const Pose T_body_world = T_world_body.inverse();
  const auto add = [&](Match m) {
    m.p = T_body_world * m.p;
    out.all.push_back(m);
  };
  for (const Match& m : lines)
    if (m.normals) {
      ++out.edges;
      add(m);
    }
  std::vector<std::vector<char>> taken;  // several fine voxels may request the same coarse voxel
  for (const VoxelGrid& g : grids) taken.emplace_back(g.voxels().size());
  for (const PlaneMatch& m : planes) {
    if (!m.match.normals) continue;
    ++out.planes;
    if (!std::exchange(taken[m.level][m.voxel], 1)) add(m.match);
  }
  return out;
}

}  // namespace karst::core
