#include "core_stack/loops/closure.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "core_stack/common/format_text.h"
#include "core_stack/common/so3.h"

namespace karst::core {
namespace {

constexpr double kNearVoxels = 1.5;           // rock nearer than this is the same
constexpr std::size_t kOverlapPoints = 3000;  // looked at in each direction
// Standard deviations beside those of the fit, whose residuals are not independent.
constexpr double kPosition_m = 0.03, kRotation_rad = 0.003, kFitFactor = 10;

// The first, rough fit: how far points look for rock, and how often; points are an even sample.
constexpr std::array<double, 4> kReach_m{2.0, 1.2, 0.7, 0.4};
constexpr int kRoughSteps = 5;
constexpr std::size_t kRoughPoints = 800;
constexpr double kRoughDeviation_m = 0.05;
// Of all six unknowns (registration.h): a passage holds the turn about its own axis less than the position.
constexpr double kDegenerate = 0.002;

LocalMapOptions grids(double voxel_m) {
  LocalMapOptions o;
  o.voxel_m = 1.5 * voxel_m;
  o.edge_voxel_m = 3 * voxel_m;
  o.levels = 2;
  return o;
}

/// Share of the points within `radius_m` of `about` (frame of `to`) that have a point of `to` beside them.
double overlap_of(const std::vector<Vec3f>& points, const Pose& T_to_from, const PointTree& to,
                  const Vec3& about, double radius_m, double near_m) {
  std::size_t near = 0, all = 0;
  const std::size_t stride = points.size() / kOverlapPoints + 1;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    const Vec3 p = T_to_from * points[i].cast<double>();
    if ((p - about).norm() > radius_m) continue;
    ++all;
    near += to.nearest(p)->distance_m <= near_m;
  }
  return all == 0 ? 0 : static_cast<double>(near) / static_cast<double>(all);
}

/// Iterative closest point, point to plane, of points to the nearest rock: rough, but it finds its way from
/// farther than the matches of means in equal voxels, which follow.
Pose roughly_fitted(const SubmapRock& older, const std::vector<Vec3f>& from, Pose T, int threads) {
  const VoxelGrid& grid = older.map().surfaces().front();
  const std::size_t stride = from.size() / kRoughPoints + 1;
  std::vector<Match> matches;
  for (const double reach_m : kReach_m)
    for (int step = 0; step < kRoughSteps; ++step) {
      matches.clear();
      for (std::size_t i = 0; i < from.size(); i += stride) {
        Match m;
        m.p = from[i].cast<double>();
        const auto nearest = older.tree().nearest(T * m.p);
        if (nearest->distance_m > reach_m) continue;
        const Vec3f& rock = older.tree().points()[nearest->index];
        const VoxelGrid::Key key = grid.key_of(rock);
        const Surface surface = surface_of(grid, key, grid.window_around(key), 6);
        if (surface.points < 6) continue;
        m.q = rock.cast<double>();
        m.n1 = surface.axes.col(0);
        m.normals = 1;
        m.variance_m2 = kRoughDeviation_m * kRoughDeviation_m;
        matches.push_back(m);
      }
      if (matches.size() < 60) return T;
      const Vector6 change = solve(linearize(matches, T, reach_m, threads), kDegenerate, kDegenerate).change;
      T.position += change.head<3>();
      T.orientation = (T.orientation * exp_so3(change.tail<3>())).normalized();
      if (change.norm() < 1e-3) break;
    }
  return T;
}

/// Least mean squared cosine between a direction and the normals of the rock that coincides.
double hold_of(const Cloud& cloud, const LocalMap& map, const Pose& T, Workspace& workspace) {
  const Matches matches = find_matches(cloud, map, T, 0, workspace);
  if (matches.all.empty()) return 0;
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Match& m : matches.all) squares += m.n1 * m.n1.transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(squares).eigenvalues()[0] /
         static_cast<double>(matches.all.size());
}

double clearance_of(const std::vector<Vec3f>& flown, const Pose& T_to_from, const PointTree& rock) {
  double least = 1e9;
  for (const Vec3f& p : flown)
    least = std::min(least, rock.nearest(T_to_from * p.cast<double>())->distance_m);
  return least;
}

Vec3 middle_of(const std::vector<Vec3f>& flown) { return flown[flown.size() / 2].cast<double>(); }

std::string objection(const Closure& c, const Fit& fit, double clearance_m, const ClosureLimits& limits) {
  const double tilt = std::acos(std::clamp((c.T_older_newer.orientation * Vec3::UnitZ()).z(), -1.0, 1.0));
  if (!fit.good) return "the rock does not match";
  if (fit.free_directions > 0 || c.hold < limits.min_hold)
    return "the rock leaves a direction free, as a smooth tube does";
  if (c.overlap < limits.min_overlap)
    return format_text("only %.0f %% of the rock coincides", 100 * c.overlap);
  if (c.residual_m > limits.max_residual_m) return format_text("the residual is %.2f m", c.residual_m);
  if (tilt > limits.max_tilt_rad) return format_text("tilted by %.1f deg", tilt * 180 / std::numbers::pi);
  if (clearance_m < limits.min_clearance_m) return "one was flown through the other's rock";
  return "";
}

}  // namespace

void describe(OptionTable& t, ClosureLimits& o) {
  t.add("overlap_radius", o.overlap_radius_m, "m", 2, 100,
        "rock nearer than this to the place must coincide");
  t.add("min_overlap", o.min_overlap, "", 0, 1, "share of this rock, in both directions");
  t.add("max_residual", o.max_residual_m, "m", 0.01, 2, "root mean square distance of coinciding rock");
  t.add("min_hold", o.min_hold, "", 0, 0.3,
        "least mean squared cosine between a direction and the coinciding rock's normals");
  t.add("max_tilt", o.max_tilt_rad, "rad", 0, 3.2, "between the vertical axes");
  t.add("min_clearance", o.min_clearance_m, "m", 0, 10, "of one's flown path from the other's rock");
  t.add("max_rival", o.max_rival, "", 0, 1, "overlap of another pose, in parts of the best one's");
}

SubmapRock::SubmapRock(const Submap& submap, double voxel_m)
    : submap_(submap), tree_(submap.points()), map_(grids(voxel_m)) {
  Cloud cloud;
  cloud.surface = tree_.points();
  map_.insert(cloud, Vec3::Zero());
}

Closure registered(const SubmapRock& older, const SubmapRock& newer, const Pose& T_older_newer,
                   const ClosureLimits& limits, Workspace& workspace) {
  Closure c;
  c.T_older_newer = T_older_newer;
  const std::vector<Vec3f>&to = older.tree().points(), &from = newer.tree().points();
  if (to.empty() || from.empty()) {
    c.problem = "there is no rock";
    return c;
  }
  RegistrationOptions registration;
  registration.max_passes = 5;
  registration.degenerate_fraction = registration.degenerate_fraction_vertical = kDegenerate;
  const Cloud cloud{{}, from, from};
  const Pose rough = roughly_fitted(older, from, T_older_newer, workspace.threads);
  const Fit fit = fit_to_map(cloud, older.map(), rough, 1, registration, workspace);
  c.T_older_newer = fit.T_world_body;
  c.residual_m = fit.rms_residual_m;
  c.hold = hold_of(cloud, older.map(), c.T_older_newer, workspace);
  c.covariance = kFitFactor * fit.covariance;
  c.covariance.diagonal().head<3>().array() += kPosition_m * kPosition_m;
  c.covariance.diagonal().tail<3>().array() += kRotation_rad * kRotation_rad;

  const double near_m = kNearVoxels * older.map().surfaces().front().voxel_m() / 1.5;
  const Pose T_newer_older = c.T_older_newer.inverse();
  const Vec3 about_newer = middle_of(newer.submap().flown), about_older = c.T_older_newer * about_newer;
  c.overlap =
      std::min(overlap_of(from, c.T_older_newer, older.tree(), about_older, limits.overlap_radius_m, near_m),
               overlap_of(to, T_newer_older, newer.tree(), about_newer, limits.overlap_radius_m, near_m));
  const double clearance_m = std::min(clearance_of(newer.submap().flown, c.T_older_newer, older.tree()),
                                      clearance_of(older.submap().flown, T_newer_older, newer.tree()));
  c.problem = objection(c, fit, clearance_m, limits);
  return c;
}

}  // namespace karst::core
