// Scans of a cave with a closed form: a hall, a ball of 3 m, and a passage, a tube of 1.2 m along x that ends
// in half a ball 12 m from the hall's centre. And files of scans.
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core_stack/common/random.h"
#include "sdk/cave_from_cloud/point_cloud.h"
#include "tests/unit/simulator/meshes.h"

namespace karst::test {

constexpr double kHall_m = 3, kPassage_m = 1.2, kLength_m = 12;

/// Distance to the wall, negative in the air; exact but for the edge where hall and passage meet.
inline double to_wall(const Vec3& p) {
  const Vec3 axis(std::clamp(p.x(), 0.0, kLength_m), 0, 0);
  return std::min(p.norm() - kHall_m, (p - axis).norm() - kPassage_m);
}

/// Less half a ball if the passage's end is left out.
inline double hall_and_passage_m3(bool with_end) {
  constexpr double pi = std::numbers::pi;
  const double edge_m = std::sqrt(kHall_m * kHall_m - kPassage_m * kPassage_m), cap_m = kHall_m - edge_m;
  const double hall = 4.0 / 3 * pi * std::pow(kHall_m, 3) - pi * cap_m * cap_m * (3 * kHall_m - cap_m) / 3;
  const double tube = pi * kPassage_m * kPassage_m * (kLength_m - edge_m);
  return hall + tube + (with_end ? 2.0 / 3 * pi * std::pow(kPassage_m, 3) : 0);
}

struct ScanOptions {
  double spacing_m = 0.05, noise_m = 0.005;
  bool entrance = false;   // the passage's end is open
  double roof_hole_m = 0;  // radius of a ball around the hall's highest point, where nothing was measured
  Vec3 origin = Vec3::Zero();
};

/// Random places of even density.
inline std::vector<Vec3> scan_of_hall_and_passage(const ScanOptions& o, std::uint64_t seed = 5) {
  constexpr double pi = std::numbers::pi;
  core::Random random(seed);
  std::vector<Vec3> points;
  const auto add = [&](const Vec3& p) {
    points.push_back(o.origin + p + o.noise_m * Vec3(random.normal(), random.normal(), random.normal()));
  };
  const auto number = [&](double area_m2) { return static_cast<int>(area_m2 / (o.spacing_m * o.spacing_m)); };
  for (int i = number(4 * pi * kHall_m * kHall_m); i > 0; --i) {
    const Vec3 p = kHall_m * random_unit(random);
    const bool in_passage = p.x() > 0 && std::hypot(p.y(), p.z()) < kPassage_m;
    if (!in_passage && (p - Vec3(0, 0, kHall_m)).norm() >= o.roof_hole_m) add(p);
  }
  for (int i = number(2 * pi * kPassage_m * kLength_m); i > 0; --i) {
    const double a = random.uniform(0, 2 * pi);
    const Vec3 p(random.uniform(0, kLength_m), kPassage_m * std::cos(a), kPassage_m * std::sin(a));
    if (p.norm() > kHall_m) add(p);
  }
  for (int i = o.entrance ? 0 : number(2 * pi * kPassage_m * kPassage_m); i > 0; --i) {
    Vec3 d = random_unit(random);
    d.x() = std::abs(d.x());
    add(Vec3(kLength_m, 0, 0) + kPassage_m * d);
  }
  return points;
}

inline from_cloud::PointCloud cloud_of(const std::vector<Vec3>& points) {
  from_cloud::PointCloud cloud;
  for (const Vec3& p : points) cloud.points.push_back(p.cast<float>());
  return cloud;
}

/// A binary .ply file; with normals if there are any.
inline void write_scan(const std::string& path, const std::vector<Vec3>& points,
                       const std::vector<Vec3>& normals = {}) {
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                      std::to_string(points.size()) +
                      "\nproperty double x\nproperty double y\nproperty double z\n";
  if (!normals.empty()) bytes += "property double nx\nproperty double ny\nproperty double nz\n";
  bytes += "end_header\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    bytes.append(reinterpret_cast<const char*>(points[i].data()), 3 * sizeof(double));
    if (!normals.empty()) bytes.append(reinterpret_cast<const char*>(normals[i].data()), 3 * sizeof(double));
  }
  write_bytes(path, bytes);
}

}  // namespace karst::test
