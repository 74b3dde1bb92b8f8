#include "sdk/evaluation/accuracy/map_reference.h"

#include <cmath>
#include <filesystem>
#include <limits>

#include "core_stack/common/error.h"
#include "core_stack/mapping/obstacles/point_tree.h"
#include "core_stack/mapping/octomap/octomap_io.h"
#include "plugins/replay/scan_files/scan_file.h"
#include "plugins/simulator/cave/cave.h"
#include "sdk/evaluation/accuracy/map_error.h"

namespace karst::evaluation {
namespace {

using core::InputError;
using core::Vec3;
using core::Vec3f;

constexpr double kMargin_m = 5;
constexpr double kMaxPoints = 6e7;

/// The i-th pair of a low-discrepancy sequence in [0, 1)^2 (generalized golden ratio).
std::pair<double, double> even(std::uint64_t i) {
  const auto part = [](double v) { return v - std::floor(v); };
  const double n = static_cast<double>(i) + 1;
  return {part(n * 0.7548776662466927), part(n * 0.5698402909980532)};
}

std::string ending_of(const std::string& file) { return std::filesystem::path(file).extension().string(); }

bool is_mesh(const std::string& file) {
  const std::string e = ending_of(file);
  if (e == ".ply") return replay::ply_faces(file) > 0;
  return e == ".stl" || e == ".obj" || e == ".dae" || e == ".info";
}

}  // namespace

std::vector<Vec3f> sample_surface(const cave::TriangleMesh& mesh, double points_per_m2,
                                  const Eigen::AlignedBox3d& box, double margin_m, const std::string& name) {
  Eigen::AlignedBox3d grown(box.min() - Vec3::Constant(margin_m), box.max() + Vec3::Constant(margin_m));
  std::vector<Vec3f> points;
  double owed = 0.5;  // points due for the area so far, less those created
  std::uint64_t count = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]].cast<double>(), b = mesh.vertices[t[1]].cast<double>(),
               c = mesh.vertices[t[2]].cast<double>();
    Eigen::AlignedBox3d own(a);
    own.extend(b).extend(c);
    if (!own.intersects(grown)) continue;
    owed += points_per_m2 * (b - a).cross(c - a).norm() / 2;
    if (static_cast<double>(points.size()) + owed > kMaxPoints)
      throw InputError(name, "", "needs more than 60 million points; choose a smaller --density");
    for (; owed >= 1; owed -= 1) {
      auto [u, v] = even(count++);
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      points.push_back((a + u * (b - a) + v * (c - a)).cast<float>());
    }
  }
  return points;
}

MapReference open_reference(const std::string& file, double points_per_m2, const std::vector<Vec3>& points) {
  if (!std::filesystem::is_regular_file(file)) throw InputError(file, "", "no such reference");
  MapReference reference;
  reference.file = file;
  std::vector<Vec3f> samples;
  if (is_mesh(file)) {
    reference.kind = "mesh";
    reference.density_per_m2 = points_per_m2;
    Eigen::AlignedBox3d box;
    for (const Vec3& p : points) box.extend(p);
    if (!points.empty())
      samples = sample_surface(cave::load_mesh(cave::mesh_of(file)), points_per_m2, box, kMargin_m, file);
  } else {
    reference.kind = "cloud";
    for (const replay::ScanPoint& p : replay::read_scan(file).points) samples.push_back(p.position);
  }
  if (samples.empty()) throw InputError(file, "", "holds no point near the map");
  reference.points = samples.size();
  const auto tree = std::make_shared<core::PointTree>(std::move(samples));
  reference.distance_m = [tree](const Vec3& p) {
    const auto nearest = tree->nearest(p);
    return nearest ? nearest->distance_m : std::numeric_limits<double>::infinity();
  };
  return reference;
}

std::vector<Vec3> read_map_points(const std::string& file) {
  const std::string e = ending_of(file);
  std::vector<Vec3> points;
  if (e == ".bt" || e == ".ot") {
    points = occupied_centres(core::read_octomap(file));
  } else {
    for (const replay::ScanPoint& p : replay::read_scan(file).points)
      points.push_back(p.position.cast<double>());
  }
  if (points.empty()) throw InputError(file, "", "the map holds no occupied cell or point");
  return points;
}

}  // namespace karst::evaluation
