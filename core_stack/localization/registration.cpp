#include "core_stack/localization/registration.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <array>

#include "core_stack/common/so3.h"
#include "core_stack/localization/parallel.h"

namespace karst::core {
namespace {

constexpr std::size_t kChunk = 128;     // features
constexpr double kFreeDeviation = 100;  // m, along directions that nothing measures

/// What a feature is matched with; kept between iterations while the feature stays in its voxel.
struct Match {
  Eigen::Vector3i voxel = Eigen::Vector3i::Constant(1 << 30);
  int normals = 0;  // 0: none, 1: plane, 2: line
  Vec3 mean, n1, n2;
  double deviation_m = 0;
};

struct Sums {
  Matrix6 information = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();
  double weight = 0, absolute = 0, squared = 0, rms_weight = 0, squared_distance = 0;
  int edges = 0, planes = 0;

  void operator+=(const Sums& o) {
    information += o.information, gradient += o.gradient;
    weight += o.weight, absolute += o.absolute, squared += o.squared, rms_weight += o.rms_weight;
    squared_distance += o.squared_distance;
    edges += o.edges, planes += o.planes;
  }
};

bool set_plane(Match& m, const VoxelLevel& level, const Vec3& place) {
  constexpr double kLeast = 12;
  const Surface s = level.surface_near(place, kLeast);
  const double wide = s.deviation_m[1], thick = s.deviation_m[0];
  if (s.points < kLeast || wide < 0.25 * level.voxel_m() || thick > 0.35 * wide) return false;
  m.normals = 1, m.mean = s.mean, m.n1 = s.axes.col(0), m.deviation_m = thick;
  return true;
}

bool set_line(Match& m, const VoxelLevel& level, const Vec3& place) {
  constexpr double kLeast = 8;
  const Surface s = level.surface_near(place, kLeast);
  if (s.points < kLeast || s.deviation_m[2] < 0.5 * level.voxel_m() ||
      s.deviation_m[1] > 0.3 * s.deviation_m[2])
    return false;
  m.normals = 2, m.mean = s.mean, m.n1 = s.axes.col(0), m.n2 = s.axes.col(1),
  m.deviation_m = s.deviation_m[1];
  return true;
}

class Problem {
 public:
  Problem(const Cloud& cloud, const MapLevels& map, const RegistrationOptions& o, int threads)
      : cloud_(cloud),
        map_(map),
        options_(o),
        threads_(threads),
        matches_(cloud.edges.size() + cloud.planes.size()) {}

  std::size_t size() const { return matches_.size(); }

  /// Normal equations at a pose.
  Sums linearize(const Pose& T, double width_m) {
    std::vector<Sums> parts(chunk_count(size(), kChunk));
    for_each_chunk(size(), kChunk, threads_, [&](std::size_t chunk, std::size_t first, std::size_t end) {
      const Eigen::Matrix3d R = T.orientation.toRotationMatrix();
      for (std::size_t i = first; i < end; ++i) add(parts[chunk], i, R, T.position, width_m);
    });
    Sums all;
    for (const Sums& s : parts) all += s;
    return all;
  }

 private:
  void add(Sums& sums, std::size_t i, const Eigen::Matrix3d& R, const Vec3& t, double width_m) {
    const bool edge = i < cloud_.edges.size();
    const Vec3 p = (edge ? cloud_.edges[i] : cloud_.planes[i - cloud_.edges.size()]).cast<double>();
    const Vec3 place = R * p + t;
    Match& m = matches_[i];
    const VoxelLevel& own = edge ? *map_.edges : *map_.fine;
    const Eigen::Vector3i voxel = own.voxel_of(place);
    if (voxel != m.voxel) {
      m.voxel = voxel, m.normals = 0;
      if (edge)
        set_line(m, own, place);
      else if (!set_plane(m, own, place))
        set_plane(m, *map_.coarse, place);
    }
    if (m.normals == 0) return;
    const Vec3 d = place - m.mean;
    const double r1 = m.n1.dot(d), r2 = m.normals == 2 ? m.n2.dot(d) : 0;
    const double squared = r1 * r1 + r2 * r2;
    const double sigma2 = m.deviation_m * m.deviation_m + options_.range_noise_m * options_.range_noise_m;
    const double k2 = std::max(width_m * width_m, 9 * sigma2);
    if (squared > 9 * k2) return;
    const double robust = k2 * k2 / ((k2 + squared) * (k2 + squared));
    const double w = robust / sigma2;
    const auto row = [&](const Vec3& n, double r) {
      Vector6 j;
      j.head<3>() = n;
      j.tail<3>() = p.cross(R.transpose() * n);
      sums.information.selfadjointView<Eigen::Lower>().rankUpdate(j, w);
      sums.gradient += w * r * j;
    };
    row(m.n1, r1);
    if (m.normals == 2) row(m.n2, r2);
    sums.weight += w * m.normals;
    sums.absolute += robust * std::sqrt(squared);
    sums.squared += robust * squared;
    sums.rms_weight += robust;
    sums.squared_distance += w * m.normals * p.squaredNorm();
    ++(edge ? sums.edges : sums.planes);
  }

  const Cloud& cloud_;
  const MapLevels& map_;
  const RegistrationOptions& options_;
  int threads_;
  std::vector<Match> matches_;
};

/// The step along well-measured directions, and the covariance.
struct Solution {
  Vector6 step;
  Matrix6 covariance;
  int free_directions = 0;
};

Solution solve(const Sums& s, double degenerate_share) {
  const double length = std::sqrt(s.squared_distance / s.weight);  // L
  Vector6 scale;
  scale << 1, 1, 1, 1 / length, 1 / length, 1 / length;
  const Matrix6 full = s.information.selfadjointView<Eigen::Lower>();
  const Matrix6 scaled = scale.asDiagonal() * full * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(scaled);
  Vector6 inverse, variance;
  Solution out;
  for (int i = 0; i < 6; ++i) {
    const double value = solver.eigenvalues()[i];
    const bool free = value < degenerate_share * s.weight;
    out.free_directions += free;
    inverse[i] = free ? 0 : 1 / value;
    variance[i] = free ? kFreeDeviation * kFreeDeviation : 1 / value;
  }
  const Matrix6 V = scale.asDiagonal() * solver.eigenvectors();
  out.step = -(V * inverse.asDiagonal() * V.transpose() * s.gradient);
  out.covariance = V * variance.asDiagonal() * V.transpose();
  return out;
}

}  // namespace

void describe(OptionTable& t, RegistrationOptions& o) {
  t.add("max_iterations", o.max_iterations, 1, 100, "Gauss-Newton steps at most");
  t.add("range_noise", o.range_noise_m, "m", 1e-4, 1, "standard deviation of a range");
  t.add("max_distance", o.max_distance_m, "m", 0.01, 10, "residuals larger than this count little at first");
  t.add("degenerate_share", o.degenerate_share, "", 0, 0.3,
        "a direction is free if the mean squared cosine of the surfaces' normals along it is less");
  t.add("min_matched_share", o.min_matched_share, "", 0, 1,
        "of the features that must match for a valid pose");
  t.add("min_matches", o.min_matches, 6, 100'000, "features that must match for a valid pose");
}

Row distance_row(const Pose& T_world_body, const Vec3& p, const Vec3& q, const Vec3& n) {
  Row row;
  row.residual = n.dot(T_world_body * p - q);
  row.jacobian << n, p.cross(T_world_body.orientation.conjugate() * n);
  return row;
}

Fit fit_to_map(const Cloud& cloud, const MapLevels& map, const Pose& guess,
               const RegistrationOptions& options, double first_width_m, int threads) {
  Problem problem(cloud, map, options, threads);
  Fit fit;
  fit.T_world_body = guess;
  double width_m = first_width_m;
  for (int i = 0; i < options.max_iterations; ++i) {
    const Sums s = problem.linearize(fit.T_world_body, width_m);
    fit.iterations = i + 1;
    fit.edges = s.edges, fit.planes = s.planes;
    fit.matched_share = static_cast<double>(s.edges + s.planes) /
                        static_cast<double>(std::max<std::size_t>(1, problem.size()));
    if (s.edges + s.planes < options.min_matches || s.weight <= 0) return fit;
    fit.rms_residual_m = std::sqrt(s.squared / s.rms_weight);
    const Solution solution = solve(s, options.degenerate_share);
    fit.free_directions = solution.free_directions;
    fit.covariance = solution.covariance;
    fit.T_world_body.position += solution.step.head<3>();
    fit.T_world_body.orientation =
        (fit.T_world_body.orientation * exp_so3(solution.step.tail<3>())).normalized();
    const double length2 = s.squared_distance / s.weight;
    const double moved =
        std::sqrt(solution.step.head<3>().squaredNorm() + length2 * solution.step.tail<3>().squaredNorm());
    if (moved < 5e-4 && i > 0) {
      fit.converged = true;
      break;
    }
    width_m = std::min(width_m, 3 * s.absolute / s.rms_weight);
  }
  fit.converged = fit.converged || true;
  return fit;
}

}  // namespace karst::core
