#include "sdk/cave_from_cloud/cave_from_cloud.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include "core_stack/common/counted.h"
#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "plugins/simulator/cave/cap_holes.h"
#include "plugins/simulator/cave/import_child.h"
#include "plugins/simulator/cave/mesh_advice.h"
#include "plugins/simulator/cave/mesh_volume.h"
#include "plugins/simulator/cave/propose_start.h"
#include "sdk/cave_from_cloud/mesh_parts.h"
#include "sdk/cave_from_cloud/poisson.h"
#include "sdk/cave_from_cloud/read_cloud.h"
#include "sdk/cave_from_cloud/usable_points.h"
#include "sdk/evaluation/reachable/reachable.h"

namespace karst::from_cloud {
namespace {

using cave::TriangleMesh;
using core::format_text;
using core::InputError;
using core::Vec3;

/// The views in metres relative to the cloud's origin.
std::vector<Vec3> views_at(const std::string& path, const PointCloud& cloud, const cave::MeshFrame& frame,
                           const std::vector<Vec3>& places) {
  constexpr double kFarthest_m = 100;
  Eigen::AlignedBox3d box;
  for (const core::Vec3f& p : cloud.points) box.extend(p.cast<double>());
  std::vector<Vec3> views;
  for (const Vec3& place : places)
    if (const Vec3 v = cave::to_metres(frame, place - frame.offset) - cloud.origin;
        box.exteriorDistance(v) <= kFarthest_m)
      views.push_back(v);
  if (views.empty() && !places.empty())
    throw InputError(path, "",
                     "no place of the scanner is within 100 m of the points: are they in the cloud's "
                     "own coordinates?");
  return views;
}

/// Sees to it that each point has a normal that points into the air.
void complete_normals(PointCloud& cloud, const std::vector<Vec3>& views, CloudReport& report) {
  constexpr std::size_t kNeighbours = 12;
  const core::PointTree tree(cloud.points);
  const Neighbours neighbours(tree, kNeighbours);
  report.normals = cloud.has_normals() ? NormalsFrom::file : NormalsFrom::points;
  if (!cloud.has_normals()) cloud.normals = plane_normals(cloud.points, neighbours);
  if (report.normals == NormalsFrom::points || !views.empty())
    report.orientation = orient(tree, neighbours, views, report.resolution_m, cloud.normals);
  report.agreement = agreement(cloud.normals, neighbours);
}

TriangleMesh whole_surface(const std::string& path, const PointCloud& cloud, double cell_m) {
  constexpr unsigned kDay_s = 86400;
  constexpr std::uint64_t kMemory = std::uint64_t{4} << 30, kMemoryPerPoint = 20'000;
  const TriangleMesh mesh =
      cave::import_in_child(path, [&] { return poisson_surface(cloud, cell_m); },
                            {kMemory + kMemoryPerPoint * cloud.points.size(), kDay_s, kDay_s},
                            {"its surface cannot be reconstructed", "PCL"});
  if (mesh.triangles.empty()) throw InputError(path, "", "no surface runs through its points");
  return mesh;
}

/// The part with the most measured surface, of those around the start if there is one.
std::uint32_t part_with_cave(const std::string& path, const TriangleMesh& mesh, const MeshParts& parts,
                             const std::vector<bool>& guessed, const std::optional<Vec3>& start) {
  std::vector<double> measured_m2(parts.count, 0);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (!guessed[i]) measured_m2[parts.of_triangle[i]] += area_m2(mesh, i);
  if (start) {
    const std::vector<double> windings = winding_numbers(mesh, parts, *start);
    for (std::size_t i = 0; i < parts.count; ++i)
      if (std::abs(windings[i]) < 0.5) measured_m2[i] = -1;
  }
  const auto best = std::max_element(measured_m2.begin(), measured_m2.end());
  if (*best < 0)
    throw InputError(path, "start",
                     "no part of the surface encloses it: it lies in rock or outside the cave");
  return static_cast<std::uint32_t>(best - measured_m2.begin());
}

/// Counts what is left out beside the part.
void count_other_parts(const TriangleMesh& mesh, const MeshParts& parts, std::uint32_t kept,
                       CloudReport& report) {
  report.other_parts = parts.count - 1;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (parts.of_triangle[i] != kept) report.other_parts_m2 += area_m2(mesh, i);
}

void face_air(TriangleMesh& mesh) {
  if (cave::enclosed_volume_m3(mesh) >= 0) return;
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
}

/// Closes what the reconstruction left open.
void close_holes(const std::string& path, TriangleMesh& mesh, double cap_limit_m, CloudReport& report) {
  report.holes = cave::boundary_loops(mesh);
  for (const cave::BoundaryLoop& hole : report.holes) {
    if (hole.diameter_m > cap_limit_m)
      throw InputError(path, "",
                       format_text("its surface stays open: a hole %.1f m across around %.1f %.1f %.1f; "
                                   "--cap-limit closes wider holes",
                                   hole.diameter_m, hole.centre.x(), hole.centre.y(), hole.centre.z()));
    const auto cap = cave::cap_of(hole, mesh);
    mesh.triangles.insert(mesh.triangles.end(), cap.begin(), cap.end());
  }
  if (!cave::boundary_loops(mesh).empty()) throw InputError(path, "", "its surface cannot be closed");
}

std::size_t points_off(const cave::RayScene& scene, const core::PointTree& measured, double beyond_m) {
  std::size_t off = 0;
  for (const core::Vec3f& p : measured.points())
    if (!scene.nearest(p.cast<double>(), beyond_m).found) ++off;
  return off;
}

/// In the cave's own coordinates.
std::vector<core::Vec3f> moved(const std::vector<core::Vec3f>& points, const Vec3& by) {
  std::vector<core::Vec3f> out;
  out.reserve(points.size());
  for (const core::Vec3f& p : points) out.push_back((p.cast<double>() + by).cast<float>());
  return out;
}

void add_findings(const std::string& path, const cave::RayScene& scene, const cave::MeshFrame& frame,
                  const std::optional<cave::StartPose>& start, CloudReport& report) {
  constexpr double kMostGuessed = 0.2, kMostOff = 0.05, kLeastAgreement = 0.9, kSure = 0.9;
  for (const cave::MeshAdvice& a : cave::mesh_advice(cave::shape_of(scene), frame))
    report.findings.push_back(cave::to_text(a));
  const auto used = static_cast<double>(report.thinned - report.lonely);
  if (report.agreement < kLeastAgreement)
    report.findings.push_back(
        format_text("only %.0f %% of the normals agree with their neighbours%s", 100 * report.agreement,
                    report.normals == NormalsFrom::file ? " (--estimate-normals)" : ""));
  if (const auto& o = report.orientation;
      o && o->rays > 0 && static_cast<double>(o->agreed) < kSure * static_cast<double>(o->rays))
    report.findings.emplace_back(
        "which side of the walls is air is not sure (--scanner, --path, or a finer --resolution)");
  if (report.guessed.area_m2 > kMostGuessed * report.guessed.whole_m2)
    report.findings.emplace_back("much of the surface is guessed: the points leave large gaps");
  if (static_cast<double>(report.off_surface) > kMostOff * used)
    report.findings.emplace_back("many points lie off the cave's surface: passages may be cut off there");
  try {
    if (start) evaluation::check_reachable(scene.mesh(), start->position, {}, path);
  } catch (const InputError& e) {
    report.findings.emplace_back(e.what());
  }
}

}  // namespace

CaveFromCloud cave_from_cloud(const std::string& path, const cave::MeshFrame& frame,
                              const CloudOptions& options,
                              const std::function<void(const char*, double)>& progress) {
  const auto step = [&](const std::string& what, double fraction) {
    if (progress) progress(what.c_str(), fraction);
  };
  CaveFromCloud made;
  CloudReport& report = made.report;

  step("reading " + std::filesystem::path(path).filename().string(), 0);
  CloudFile file = read_cloud(path, frame, options.file_normals);
  report.points = file.points;
  report.not_finite = file.not_finite;
  report.withheld = file.withheld;
  report.without_normal = file.without_normal;

  step("thinning out " + core::grouped(file.points) + " points", 0.1);
  PointCloud cloud = usable_points(path, file.cloud, options.resolution_m, report);
  file = {};  // gives its memory back
  report.guessed_beyond_m = options.guessed_beyond_m > 0 ? options.guessed_beyond_m : 2 * report.resolution_m;

  step("finding the normals of " + core::grouped(cloud.points.size()) + " points", 0.2);
  complete_normals(cloud, views_at(path, cloud, frame, options.views), report);

  step("reconstructing the surface", 0.4);
  TriangleMesh mesh = whole_surface(path, cloud, report.resolution_m);
  mesh.vertices = moved(mesh.vertices, cloud.origin);
  const core::PointTree measured(moved(cloud.points, cloud.origin));

  step("choosing the part of the surface that is the cave", 0.8);
  const MeshParts parts = parts_of(mesh);
  const std::uint32_t kept =
      part_with_cave(path, mesh, parts, guessed_triangles(mesh, measured, report.guessed_beyond_m),
                     options.start ? std::optional(options.start->position) : std::nullopt);
  count_other_parts(mesh, parts, kept, report);
  TriangleMesh part = part_of(mesh, parts, kept);
  const std::size_t reconstructed = part.triangles.size();

  step("closing holes", 0.85);
  close_holes(path, part, options.cap_limit_m, report);
  face_air(part);
  const cave::RayScene scene(std::move(part));
  std::vector<bool> guessed = guessed_triangles(scene.mesh(), measured, report.guessed_beyond_m);
  std::fill(guessed.begin() + static_cast<std::ptrdiff_t>(reconstructed), guessed.end(), true);  // caps
  report.guessed = guessed_surface(scene.mesh(), guessed);
  report.volume_m3 = cave::enclosed_volume_m3(scene.mesh());
  report.off_surface = points_off(scene, measured, report.guessed_beyond_m);

  step(options.start ? "checking the start" : "looking for a start", 0.95);
  made.start = options.start ? options.start : cave::propose_start(scene);
  add_findings(path, scene, frame, made.start, report);
  made.mesh = scene.mesh();
  return made;
}

}  // namespace karst::from_cloud
