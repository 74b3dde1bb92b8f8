#include "sdk/survey_export/wall_mesh.h"

#include <array>
#include <unordered_map>
#include <utility>

#include "core_stack/common/little_endian.h"
#include "core_stack/mapping/occupancy/voxel_reader.h"

namespace karst::survey_export {
namespace {

using core::append_bytes;
using core::Cell;
using core::CellKey;
using core::Vec3;
using core::Vec3f;

/// The four corners of the face between a cell and its neighbour across core::kFaces[face], counter-clockwise
/// seen from the cell. Corner k is at k times the resolution.
std::array<CellKey, 4> corners(const CellKey& k, std::size_t face) {
  const std::size_t axis = face / 2;
  const bool above = face % 2 == 1;  // the neighbour is on the positive side
  const std::array<CellKey, 3> unit{CellKey{1, 0, 0}, CellKey{0, 1, 0}, CellKey{0, 0, 1}};
  const CellKey &u = unit[(axis + 1) % 3], &v = unit[(axis + 2) % 3];
  const CellKey base = above ? k + unit[axis] : k;
  std::array<CellKey, 4> c{base, base + u, base + u + v, base + v};  // counter-clockwise against the axis
  if (above) std::swap(c[1], c[3]);
  return c;
}

class Net {
 public:
  explicit Net(const core::VoxelMap& map) : map_(map) {}

  WallMesh made() {
    core::VoxelReader reader(map_);
    map_.for_each_known([&](const CellKey& k, Cell c, float) {
      if (c != Cell::free) return;
      for (std::size_t face = 0; face < core::kFaces.size(); ++face)
        if (reader.at(k + core::kFaces[face]) == Cell::occupied) add_face(k, face);
    });
    for (std::size_t i = 0; i < sums_.size(); ++i)
      walls_.mesh.vertices.push_back((sums_[i] / counts_[i]).cast<float>());
    add_triangles();
    add_normals();
    count_open_edges();
    return std::move(walls_);
  }

 private:
  void add_face(const CellKey& k, std::size_t face) {
    const Vec3 middle = 0.5 * (map_.center_of(k) + map_.center_of(k + core::kFaces[face]));
    std::array<std::uint32_t, 4> quad{};
    const std::array<CellKey, 4> at = corners(k, face);
    for (std::size_t i = 0; i < 4; ++i) {
      const auto [found, added] = vertex_.try_emplace(at[i], static_cast<std::uint32_t>(sums_.size()));
      if (added) {
        sums_.push_back(Vec3::Zero());
        counts_.push_back(0);
      }
      quad[i] = found->second;
      sums_[quad[i]] += middle;
      counts_[quad[i]] += 1;
    }
    quads_.push_back(quad);
  }

  /// Each quad along its shorter diagonal.
  void add_triangles() {
    const auto& v = walls_.mesh.vertices;
    for (const auto& q : quads_) {
      if ((v[q[0]] - v[q[2]]).squaredNorm() <= (v[q[1]] - v[q[3]]).squaredNorm()) {
        walls_.mesh.triangles.push_back({q[0], q[1], q[2]});
        walls_.mesh.triangles.push_back({q[0], q[2], q[3]});
      } else {
        walls_.mesh.triangles.push_back({q[0], q[1], q[3]});
        walls_.mesh.triangles.push_back({q[1], q[2], q[3]});
      }
    }
  }

  /// Means of the normals of the triangles around, by their areas.
  void add_normals() {
    const auto& v = walls_.mesh.vertices;
    walls_.normals.assign(v.size(), Vec3f::Zero());
    for (const auto& t : walls_.mesh.triangles) {
      const Vec3f normal = (v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]);
      for (const std::uint32_t i : t) walls_.normals[i] += normal;
    }
    for (Vec3f& n : walls_.normals)
      if (n.norm() > 0) n.normalize();
  }

  /// An edge that runs one way more often than back is open.
  void count_open_edges() {
    std::unordered_map<std::uint64_t, int> runs;
    const auto key = [](std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32 | b; };
    for (const auto& t : walls_.mesh.triangles)
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = t[i], b = t[(i + 1) % 3];
        runs[a < b ? key(a, b) : key(b, a)] += a < b ? 1 : -1;
      }
    for (const auto& [edge, balance] : runs) walls_.open_edges += balance != 0 ? 1u : 0u;
  }

  const core::VoxelMap& map_;
  std::unordered_map<CellKey, std::uint32_t, core::CellKeyHash> vertex_;
  std::vector<Vec3> sums_;  // of each vertex: the middles of the faces around it
  std::vector<double> counts_;
  std::vector<std::array<std::uint32_t, 4>> quads_;
  WallMesh walls_;
};

}  // namespace

WallMesh wall_mesh(const core::VoxelMap& map) { return Net(map).made(); }

std::string ply_bytes(const WallMesh& walls) {
  const cave::TriangleMesh& mesh = walls.mesh;
  std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment walls of a karst map, metres, z up\n";
  bytes += "element vertex " + std::to_string(mesh.vertices.size()) + '\n';
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"})
    bytes += std::string("property float ") + name + '\n';
  bytes += "element face " + std::to_string(mesh.triangles.size()) +
           "\nproperty list uchar uint vertex_indices\nend_header\n";
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    for (const Vec3f* v : {&mesh.vertices[i], &walls.normals[i]})
      for (int axis = 0; axis < 3; ++axis) append_bytes(bytes, (*v)[axis]);
  for (const auto& t : mesh.triangles) {
    append_bytes(bytes, std::uint8_t{3});
    for (const std::uint32_t i : t) append_bytes(bytes, i);
  }
  return bytes;
}

}  // namespace karst::survey_export
