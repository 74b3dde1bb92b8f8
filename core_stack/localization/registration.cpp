#include "core_stack/localization/registration.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "core_stack/common/so3.h"
#include "core_stack/localization/parallel.h"

namespace karst::core {
namespace {

constexpr std::size_t kMatchesPerChunk = 256;
constexpr double kFreeDeviation = 100;  // m, along directions that no match constrains
constexpr double kVertical = 0.75;      // squared cosine with the vertical: within 30 degrees
constexpr double kSmallStep = 1e-4;     // m: below this Gauss-Newton has converged
constexpr double kSettledMove = 0.2;    // voxels: after a smaller move the matches are reused

/// Distance by which a change of the pose moves a point at distance L.
double moved_m(const Vector6& change, double distance_m) {
  return std::sqrt(change.head<3>().squaredNorm() + distance_m * distance_m * change.tail<3>().squaredNorm());
}

NormalEquations sums_of(const Match* first, const Match* end, const Pose& T, double width_m) {
  NormalEquations sums;
  const Eigen::Matrix3d R = T.orientation.toRotationMatrix();
  for (const Match* m = first; m != end; ++m) {
    const Vec3 d = R * m->p + T.position - m->q;
    const double r1 = m->n1.dot(d), r2 = m->normals == 2 ? m->n2.dot(d) : 0;
    const double r_squared = r1 * r1 + r2 * r2;
    const double k_squared = std::max(width_m * width_m, 9 * m->variance_m2);
    const double shrink = k_squared / (k_squared + r_squared), robust = shrink * shrink;
    const double w = robust / m->variance_m2;
    const auto add = [&](const Vec3& n, double r) {
      Vector6 j;
      j << n, m->p.cross(R.transpose() * n);
      sums.information.selfadjointView<Eigen::Lower>().rankUpdate(j, w);
      sums.gradient += w * r * j;
    };
    add(m->n1, r1);
    if (m->normals == 2) add(m->n2, r2);
    sums.weight += w * m->normals;
    sums.squared_distance += w * m->normals * m->p.squaredNorm();
    sums.robust += robust;
    sums.absolute += robust * std::sqrt(r_squared);
    sums.squared += robust * r_squared;
  }
  return sums;
}

}  // namespace

void describe(OptionTable& t, RegistrationOptions& o) {
  t.add("max_passes", o.max_passes, 1, 20, "how often matches are looked for at most");
  t.add("max_steps", o.max_steps, 1, 100, "Gauss-Newton steps at most, each time");
  t.add("degenerate_fraction", o.degenerate_fraction, "", 0, 0.3,
        "a direction is free if the mean squared cosine between it and the surfaces' normals is less");
  t.add("degenerate_fraction_vertical", o.degenerate_fraction_vertical, "", 0, 0.3,
        "the same for the vertical, if it is more, and an IMU predicts the sweep's pose");
  t.add("min_matches", o.min_matches, 6, 100'000, "that a valid pose needs");
  t.add("min_matched_fraction", o.min_matched_fraction, "", 0, 1,
        "of a sweep's features that must match for a valid pose");
}

NormalEquations linearize(const std::vector<Match>& matches, const Pose& T_world_body, double width_m,
                          int threads) {
  std::vector<NormalEquations> parts(chunk_count(matches.size(), kMatchesPerChunk));
  for_each_chunk(
      matches.size(), kMatchesPerChunk, threads, [&](std::size_t chunk, std::size_t first, std::size_t end) {
        parts[chunk] = sums_of(matches.data() + first, matches.data() + end, T_world_body, width_m);
      });
  NormalEquations sums;
  for (const NormalEquations& p : parts) {
    sums.information += p.information;
    sums.gradient += p.gradient;
    sums.weight += p.weight;
    sums.squared_distance += p.squared_distance;
    sums.robust += p.robust;
    sums.absolute += p.absolute;
    sums.squared += p.squared;
  }
  sums.information.triangularView<Eigen::Upper>() = sums.information.transpose();
  return sums;
}

Step solve(const NormalEquations& equations, double degenerate_fraction, double vertical_fraction) {
  const double length = std::sqrt(equations.squared_distance / equations.weight);  // L
  Vector6 unit;
  unit << 1, 1, 1, 1 / length, 1 / length, 1 / length;
  const Matrix6 information = unit.asDiagonal() * equations.information * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(information);
  Step step;
  Vector6 inverse, variance;
  for (int i = 0; i < 6; ++i) {
    const double value = solver.eigenvalues()[i];
    const double up = solver.eigenvectors()(2, i);
    const double limit =
        up * up > kVertical ? std::max(vertical_fraction, degenerate_fraction) : degenerate_fraction;
    const bool free = value < limit * equations.weight;
    step.free_directions += free;
    inverse[i] = free ? 0 : 1 / value;
    variance[i] = free ? kFreeDeviation * kFreeDeviation : 1 / value;
  }
  const Matrix6 directions = unit.asDiagonal() * solver.eigenvectors();
  step.change = -(directions * inverse.asDiagonal() * directions.transpose() * equations.gradient);
  step.covariance = directions * variance.asDiagonal() * directions.transpose();
  return step;
}

Fit fit_to_map(const Cloud& cloud_body, const LocalMap& map, const Pose& guess, std::size_t first_level,
               const RegistrationOptions& options, Workspace& workspace) {
  Fit fit;
  fit.T_world_body = guess;
  for (std::int64_t pass = 0; pass < options.max_passes; ++pass) {
    const std::size_t level = first_level - std::min(first_level, static_cast<std::size_t>(pass));
    const double voxel_m = map.surfaces()[level].voxel_m();
    const Matches matches = find_matches(cloud_body, map, fit.T_world_body, level, workspace);
    fit.edges = matches.edges, fit.planes = matches.planes;
    fit.matched_fraction =
        (matches.edges + matches.planes) / std::max(1.0, static_cast<double>(matches.places));
    fit.good = matches.edges + matches.planes >= options.min_matches &&
               fit.matched_fraction >= options.min_matched_fraction;
    if (static_cast<std::int64_t>(matches.all.size()) < std::min<std::int64_t>(options.min_matches, 6))
      return fit;

    double moved = 0, width_m = voxel_m;
    for (std::int64_t i = 0; i < options.max_steps; ++i) {
      const NormalEquations equations = linearize(matches.all, fit.T_world_body, width_m, workspace.threads);
      const Step step = solve(equations, options.degenerate_fraction, options.degenerate_fraction_vertical);
      Pose& T = fit.T_world_body;
      T.position += step.change.head<3>();
      T.orientation = (T.orientation * exp_so3(step.change.tail<3>())).normalized();
      fit.covariance = step.covariance;
      fit.free_directions = step.free_directions;
      fit.rms_residual_m = std::sqrt(equations.squared / equations.robust);
      const double step_m = moved_m(step.change, std::sqrt(equations.squared_distance / equations.weight));
      moved += step_m;
      width_m = std::min(width_m, 3 * equations.absolute / equations.robust);
      if (step_m < kSmallStep) break;
    }
    if (level == 0 && moved < kSettledMove * voxel_m) break;
  }
  return fit;
}

}  // namespace karst::core
