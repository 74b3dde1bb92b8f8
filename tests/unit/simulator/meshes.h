// Meshes with a closed form, and places for files, for the simulator's tests.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>

#include "core_stack/common/error.h"
#include "core_stack/common/random.h"
#include "plugins/simulator/cave/cave.h"

namespace karst::test {

using core::Vec3;
using core::Vec3f;

inline void add_quad(cave::TriangleMesh& m, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto i = static_cast<std::uint32_t>(m.vertices.size());
  for (const Vec3& v : {a, b, c, d}) m.vertices.push_back(v.cast<float>());
  m.triangles.push_back({i, i + 1, i + 2});
  m.triangles.push_back({i, i + 2, i + 3});
}

/// The six walls of an axis-parallel box; `faces` leaves some out: bits -x +x -y +y -z +z.
inline cave::TriangleMesh box_mesh(const Vec3& lo, const Vec3& hi, unsigned faces = 0b111111) {
  const auto corner = [&](int i) {
    return Vec3(i & 1 ? hi.x() : lo.x(), i & 2 ? hi.y() : lo.y(), i & 4 ? hi.z() : lo.z());
  };
  constexpr int kFaces[6][4] = {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}};
  cave::TriangleMesh m;
  for (unsigned f = 0; f < 6; ++f)
    if (faces >> f & 1)
      add_quad(m, corner(kFaces[f][0]), corner(kFaces[f][1]), corner(kFaces[f][2]), corner(kFaces[f][3]));
  return m;
}

inline void append(cave::TriangleMesh& m, const cave::TriangleMesh& other) {
  const auto first = static_cast<std::uint32_t>(m.vertices.size());
  m.vertices.insert(m.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& t : other.triangles) m.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

inline Eigen::AlignedBox3d box_of(const cave::TriangleMesh& m) {
  Eigen::AlignedBox3d box;
  for (const Vec3f& v : m.vertices) box.extend(v.cast<double>());
  return box;
}

/// A closed tunnel along x with a rough, many-cornered cross section.
inline cave::TriangleMesh tunnel_mesh(double length_m, double radius_m, std::uint64_t seed) {
  constexpr std::uint32_t kCorners = 24;
  core::Random random(seed);
  cave::TriangleMesh m;
  const auto rings = static_cast<std::uint32_t>(length_m) + 1;
  for (std::uint32_t i = 0; i < rings; ++i)
    for (std::uint32_t k = 0; k < kCorners; ++k) {
      const double a = 2 * std::numbers::pi * k / kCorners, r = radius_m * random.uniform(0.8, 1.2);
      m.vertices.emplace_back(static_cast<float>(i), static_cast<float>(r * std::cos(a)),
                              static_cast<float>(r * std::sin(a)));
    }
  for (std::uint32_t i = 0; i + 1 < rings; ++i)
    for (std::uint32_t k = 0; k < kCorners; ++k) {
      const std::uint32_t a = i * kCorners + k, b = i * kCorners + (k + 1) % kCorners;
      m.triangles.push_back({a, b, b + kCorners});
      m.triangles.push_back({a, b + kCorners, a + kCorners});
    }
  for (const std::uint32_t ring : {0u, (rings - 1) * kCorners})
    for (std::uint32_t k = 1; k + 1 < kCorners; ++k) m.triangles.push_back({ring, ring + k, ring + k + 1});
  return m;
}

inline cave::Cave make_cave(cave::TriangleMesh mesh, const Vec3& start = Vec3::Zero(),
                            double heading_rad = 0) {
  cave::CaveDescription d;
  d.file = "made in code";
  d.start = {start, heading_rad};
  return {d, cave::RayScene(std::move(mesh))};
}

inline Vec3 random_unit(core::Random& r) {
  const double x = r.normal(), y = r.normal(), z = r.normal();
  return Vec3(x, y, z).normalized();
}

/// A folder of this test's own, empty at the start.
inline std::string scratch_folder() {
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  const auto path =
      std::filesystem::temp_directory_path() /
      (std::string("karst_") + info->test_suite_name() + "_" + info->name() + "_" + std::to_string(getpid()));
  std::filesystem::remove_all(path);
  std::filesystem::create_directories(path);
  return path.string();
}

inline std::string read_bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// What an InputError says, or "" if none is thrown.
template <class F>
std::string error_of(F f) {
  try {
    f();
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "";
}

inline std::string caves_folder() { return std::string(KARST_SOURCE_DIR) + "/../shared/data/caves/develop/"; }

#define SKIP_WITHOUT_CAVES() \
  if (!std::filesystem::exists(karst::test::caves_folder())) GTEST_SKIP() << "skipped: no ../shared"

}  // namespace karst::test
