#include "sdk/preflight/vehicle/axis_map.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace karst::preflight {
namespace {

using core::Vec3;
using Eigen::Matrix3d;

constexpr double kClearly = 0.5;  // of the scatter as it is
/// Of the strength. Hands accelerate by 1 to 2 m/s^2, and iron on the vehicle turns the field by a tenth.
constexpr double kNoise = 0.35;

std::vector<Matrix3d> all_axis_maps() {
  std::vector<Matrix3d> maps;
  std::array<int, 3> axes{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Matrix3d m = Matrix3d::Zero();
      for (int row = 0; row < 3; ++row)
        m(row, axes[static_cast<std::size_t>(row)]) = (signs >> row & 1) ? -1 : 1;
      maps.push_back(m);
    }
  } while (std::next_permutation(axes.begin(), axes.end()));
  return maps;
}

double scatter_of(std::span<const VectorSample> vectors, std::span<const Orientation> track,
                  const Matrix3d& map) {
  Vec3 mean = Vec3::Zero();
  double squares = 0;
  for (const VectorSample& s : vectors) {
    const Vec3 v = orientation_at(track, s.stamp) * (map * s.v);
    mean += v;
    squares += v.squaredNorm();
  }
  const auto n = static_cast<double>(vectors.size());
  return std::sqrt(std::max(0.0, squares / n - (mean / n).squaredNorm()));
}

double mean_length(std::span<const VectorSample> vectors) {
  double sum = 0;
  for (const VectorSample& s : vectors) sum += s.v.norm();
  return vectors.empty() ? 0 : sum / static_cast<double>(vectors.size());
}

/// The best of the maps by `scatter`, a function of the map.
template <class Scatter>
AxisTest best_axes(std::span<const VectorSample> vectors, const std::vector<Matrix3d>& maps,
                   const Scatter& scatter) {
  AxisTest test;
  test.samples = static_cast<int>(vectors.size());
  test.strength = mean_length(vectors);
  test.scatter = test.scatter_as_is = scatter(Matrix3d(Matrix3d::Identity()));
  for (const Matrix3d& map : maps)
    if (const double s = scatter(map); s < test.scatter) {
      test.scatter = s;
      test.best = map;
    }
  return test;
}

}  // namespace

const std::vector<Matrix3d>& axis_maps() {
  static const std::vector<Matrix3d> maps = all_axis_maps();
  return maps;
}

Matrix3d nearest_axis_map(const Matrix3d& m) {
  const auto likeness = [&m](const Matrix3d& map) { return map.cwiseProduct(m).sum(); };
  return *std::max_element(axis_maps().begin(), axis_maps().end(),
                           [&](const Matrix3d& a, const Matrix3d& b) { return likeness(a) < likeness(b); });
}

bool is_identity(const Matrix3d& map) { return map.isApprox(Matrix3d::Identity()); }

std::string axis_words(const Matrix3d& map) {
  constexpr const char* kNames[] = {"x", "y", "z"};
  std::string words;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) {
      if (map(row, column) == 0) continue;
      words += (row > 0 ? ", " : "") + std::string(kNames[row]) + " is " + (map(row, column) < 0 ? "-" : "") +
               kNames[column];
    }
  return words;
}

bool AxisTest::turned() const {
  return samples > 0 && !is_identity(best) && scatter < kClearly * scatter_as_is &&
         scatter < kNoise * strength;
}

AxisTest axes_of_vectors(std::span<const VectorSample> vectors, std::span<const Orientation> track) {
  if (vectors.empty() || track.empty()) return {};
  std::vector<Matrix3d> turns;
  std::copy_if(axis_maps().begin(), axis_maps().end(), std::back_inserter(turns),
               [](const Matrix3d& m) { return m.determinant() > 0; });
  return best_axes(vectors, turns, [&](const Matrix3d& map) { return scatter_of(vectors, track, map); });
}

AxisTest axes_of_gyroscope(std::span<const core::ImuSample> samples, const Vec3& bias_radps) {
  std::vector<VectorSample> force;
  for (const core::ImuSample& s : samples)
    if (s.specific_force_mps2.allFinite()) force.push_back({s.stamp, s.specific_force_mps2});
  if (force.empty() || gyro_track(samples, bias_radps).empty()) return {};
  return best_axes(force, axis_maps(), [&](const Matrix3d& map) {
    return scatter_of(force, gyro_track(samples, bias_radps, map), Matrix3d::Identity());
  });
}

}  // namespace karst::preflight
