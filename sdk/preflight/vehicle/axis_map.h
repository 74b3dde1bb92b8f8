// Sensors whose axes are swapped or turned by right angles, found by what must stand still in the world:
// gravity, and the earth's magnetic field.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "sdk/preflight/vehicle/gyro_track.h"

namespace karst::preflight {

/// The 48 matrices that swap and invert axes; the first is the identity.
const std::vector<Eigen::Matrix3d>& axis_maps();

/// The axis map nearest to `m`.
Eigen::Matrix3d nearest_axis_map(const Eigen::Matrix3d& m);

bool is_identity(const Eigen::Matrix3d& map);

/// What each axis really is, such as "x is y, y is x, z is -z" for the rows of the map.
std::string axis_words(const Eigen::Matrix3d& map);

struct VectorSample {
  core::TimeNs stamp = 0;
  core::Vec3 v = core::Vec3::Zero();  // body frame
};

/// The axis map by which what was measured keeps its direction best.
struct AxisTest {
  Eigen::Matrix3d best = Eigen::Matrix3d::Identity();
  double scatter = 0, scatter_as_is = 0;  // root mean square about the mean, by `best` and by the identity
  double strength = 0;                    // mean length of the vectors
  int samples = 0;

  /// Whether the axes are other than they should be: a clearly smaller scatter, and what is left is noise.
  bool turned() const;
};

/// Maps of the vectors: of the magnetic field against `track`, which is of another sensor. Only of the 24
/// that are rotations, as a vector with all components inverted stands still as well: a mirrored map is found
/// as its negative, and one that inverts all axes cannot be found.
AxisTest axes_of_vectors(std::span<const VectorSample> vectors, std::span<const Orientation> track);

/// Maps of the gyroscope against the accelerometer of the same IMU, by gravity; accelerations by hand are
/// noise here.
AxisTest axes_of_gyroscope(std::span<const core::ImuSample> samples, const core::Vec3& bias_radps);

}  // namespace karst::preflight
