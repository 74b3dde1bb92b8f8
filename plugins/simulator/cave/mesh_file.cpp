#include <algorithm>
#include <cstring>
// After what it uses and does not include.
#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <utility>

#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/little_endian.h"
#include "core_stack/common/output_file.h"
#include "plugins/simulator/cave/import_child.h"
#include "plugins/simulator/cave/mesh_advice.h"
#include "plugins/simulator/cave/mesh_offset.h"
#include "plugins/simulator/cave/triangle_mesh.h"

namespace karst::cave {
namespace {

using core::InputError;
using core::Vec3;
using core::Vec3f;

/// Opens the mesh and no file that the mesh names, such as an OBJ's materials: that may be a FIFO, or
/// anything. With `bytes` the mesh is read from there.
class OnlyThisFile final : public Assimp::DefaultIOSystem {
 public:
  OnlyThisFile(std::string path, std::string bytes) : path_(std::move(path)), bytes_(std::move(bytes)) {}
  bool Exists(const char* file) const override { return file == path_ && DefaultIOSystem::Exists(file); }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    if (file != path_) return nullptr;
    if (bytes_.empty()) return DefaultIOSystem::Open(file, mode);
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes_.data()), bytes_.size());
  }

 private:
  std::string path_, bytes_;
};

/// Numbers equal vertices once, in the order of first appearance. The importer's own steps for this and for
/// polygons end the program on some damaged files.
class JoinedVertices {
 public:
  explicit JoinedVertices(std::vector<Vec3f>& vertices) : vertices_(vertices) {}
  std::uint32_t index(const Vec3f& v) {
    const Vec3f plain = v.array() + 0.0f;  // no negative zero
    for (std::size_t i = slot_of(plain);; i = (i + 1) & (slots_.size() - 1)) {
      if (slots_[i] == kFree) {
        slots_[i] = static_cast<std::uint32_t>(vertices_.size());
        vertices_.push_back(plain);
        if (2 * vertices_.size() > slots_.size()) grow();
        return static_cast<std::uint32_t>(vertices_.size() - 1);
      }
      if (bits_of(vertices_[slots_[i]]) == bits_of(plain)) return slots_[i];
    }
  }

 private:
  using Bits = std::array<std::uint32_t, 3>;
  static constexpr std::uint32_t kFree = ~std::uint32_t{0};

  static Bits bits_of(const Vec3f& v) {
    Bits bits;
    std::memcpy(bits.data(), v.data(), sizeof bits);
    return bits;
  }
  std::size_t slot_of(const Vec3f& v) const {
    const Bits b = bits_of(v);
    std::uint64_t h = b[0];
    h = (h ^ (h >> 29)) * 0x9e3779b97f4a7c15ull + b[1];
    h = (h ^ (h >> 31)) * 0xbf58476d1ce4e5b9ull + b[2];
    return ((h ^ (h >> 30)) * 0x94d049bb133111ebull >> 24) & (slots_.size() - 1);
  }
  void grow() {
    slots_.assign(2 * slots_.size(), kFree);
    for (std::uint32_t n = 0; n < vertices_.size(); ++n) {
      std::size_t i = slot_of(vertices_[n]);
      while (slots_[i] != kFree) i = (i + 1) & (slots_.size() - 1);
      slots_[i] = n;
    }
  }

  std::vector<Vec3f>& vertices_;
  std::vector<std::uint32_t> slots_ = std::vector<std::uint32_t>(1024, kFree);  // a power of two, half full
};

/// A part of the file, and how its vertices become places in metres.
struct MeshPart {
  const aiMesh& mesh;
  aiMatrix4x4 T_file_part;
  const MeshFrame& frame;
  Vec3 offset_left;  // what is still to be subtracted

  Vec3 vertex(unsigned i) const {
    const aiVector3D v = T_file_part * mesh.mVertices[i];
    return to_metres(frame, Vec3(v.x, v.y, v.z) - offset_left);
  }
};

/// Refuses coordinates that floats do not resolve, and says what helps: other units, or an offset.
void check_reach(const std::string& path, const std::vector<MeshPart>& parts, const MeshFrame& frame) {
  Eigen::AlignedBox3d box;
  for (const MeshPart& part : parts)
    for (unsigned i = 0; i < part.mesh.mNumVertices; ++i) {
      const Vec3 v = part.vertex(i);
      if (!v.allFinite()) throw InputError(path, "vertex " + std::to_string(i), kReachRule);
      box.extend(v);
    }
  std::string why = reach_problem(box, frame);
  if (why.empty()) return;
  if (box.sizes().maxCoeff() <= kFarthestVertex_m && !holds_double_precision(path))
    why += core::format_text(
        "; but the file holds single precision, which there is rounded to %.2g: export it near its "
        "origin, or as OBJ",
        float_spacing((to_file(frame, box.min()) - frame.offset).cwiseAbs().maxCoeff()));
  throw InputError(path, "", why);
}

/// Polygons become triangle fans around their first corner.
void append_part(const std::string& path, const MeshPart& placed, JoinedVertices& joined, TriangleMesh& out) {
  const aiMesh& part = placed.mesh;
  std::vector<std::uint32_t> index(part.mNumVertices);
  for (unsigned i = 0; i < part.mNumVertices; ++i) index[i] = joined.index(placed.vertex(i).cast<float>());
  for (unsigned f = 0; f < part.mNumFaces; ++f) {
    const aiFace& face = part.mFaces[f];
    for (unsigned k = 0; k < face.mNumIndices; ++k)
      if (face.mIndices[k] >= part.mNumVertices)
        throw InputError(path, "face " + std::to_string(f), "names a vertex that does not exist");
    for (unsigned k = 2; k < face.mNumIndices; ++k) {
      const std::array t{index[face.mIndices[0]], index[face.mIndices[k - 1]], index[face.mIndices[k]]};
      const Vec3f& a = out.vertices[t[0]];
      if ((out.vertices[t[1]] - a).cross(out.vertices[t[2]] - a).squaredNorm() > 0)
        out.triangles.push_back(t);
    }
  }
}

void collect_parts(const aiScene& scene, const aiNode& node, const aiMatrix4x4& T_parent,
                   const MeshFrame& frame, const Vec3& offset_left, std::vector<MeshPart>& out) {
  const aiMatrix4x4 T = T_parent * node.mTransformation;
  for (unsigned i = 0; i < node.mNumMeshes; ++i)
    out.push_back({*scene.mMeshes[node.mMeshes[i]], T, frame, offset_left});
  for (unsigned i = 0; i < node.mNumChildren; ++i)
    collect_parts(scene, *node.mChildren[i], T, frame, offset_left, out);
}

std::string stl_bytes(const TriangleMesh& mesh) {
  std::string bytes(80, ' ');
  core::append_bytes(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    const Vec3f &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3f normal = (b - a).cross(c - a).normalized();
    for (const Vec3f& v : {normal, a, b, c})
      for (int k = 0; k < 3; ++k) core::append_bytes(bytes, v[k]);
    core::append_bytes(bytes, std::uint16_t{0});
  }
  return bytes;
}

std::string ply_bytes(const TriangleMesh& mesh) {
  std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment units metres; z up\nelement vertex " +
                      std::to_string(mesh.vertices.size()) +
                      "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                      std::to_string(mesh.triangles.size()) +
                      "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3f& v : mesh.vertices)
    for (int k = 0; k < 3; ++k) core::append_bytes(bytes, v[k]);
  for (const auto& t : mesh.triangles) {
    core::append_bytes(bytes, std::uint8_t{3});
    for (const std::uint32_t i : t) core::append_bytes(bytes, i);
  }
  return bytes;
}

TriangleMesh import_mesh(const std::string& path, const std::string& extension, const MeshFrame& frame) {
  const bool is_collada = extension == ".dae";  // nested transforms: the offset is subtracted afterwards
  std::string bytes;
  if (has_offset(frame) && !is_collada) bytes = bytes_less_offset(path, frame);
  Assimp::Importer importer;
  importer.SetIOHandler(new OnlyThisFile(path, std::move(bytes)));  // the importer owns it
  const aiScene* scene = importer.ReadFile(path, 0);
  if (scene == nullptr || scene->mRootNode == nullptr)
    throw InputError(path, "", std::string("is no mesh that can be read: ") + importer.GetErrorString());

  // The Collada importer rotates every file to y up: rotate it back to z up.
  aiMatrix4x4 T_world_file;
  if (is_collada) aiMatrix4x4::RotationX(AI_MATH_HALF_PI_F, T_world_file);
  std::vector<MeshPart> parts;
  collect_parts(*scene, *scene->mRootNode, T_world_file, frame,
                is_collada ? frame.offset : Vec3(Vec3::Zero()), parts);
  if (is_collada && has_offset(frame)) {  // the importer rounded them to floats where they were before
    MeshFrame before = frame;
    before.offset.setZero();
    std::vector<MeshPart> unmoved;
    collect_parts(*scene, *scene->mRootNode, T_world_file, before, Vec3::Zero(), unmoved);
    check_reach(path, unmoved, before);
  }
  check_reach(path, parts, frame);
  TriangleMesh mesh;
  JoinedVertices joined(mesh.vertices);
  for (const MeshPart& part : parts) append_part(path, part, joined, mesh);
  if (mesh.triangles.empty())
    throw InputError(path, "",
                     "the mesh has no triangle; a point cloud? `karst cave from-cloud` makes a cave of it");
  return mesh;
}

}  // namespace

std::string lower_extension(const std::string& path) {
  std::string e = std::filesystem::path(path).extension().string();
  std::transform(e.begin(), e.end(), e.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return e;
}

TriangleMesh load_mesh(const std::string& path, const MeshFrame& frame) {
  const std::string extension = lower_extension(path);
  if (extension != ".stl" && extension != ".ply" && extension != ".obj" && extension != ".dae")
    throw InputError(path, "", "a mesh must be a .stl, .ply, .obj or .dae file");
  check_declared_size(path);
  return import_in_child(path, [&] { return import_mesh(path, extension, frame); });
}

void write_mesh(const std::string& path, const TriangleMesh& mesh) {
  const std::string extension = lower_extension(path);
  if (extension != ".stl" && extension != ".ply")
    throw InputError(path, "", "meshes are written as .ply or .stl");
  const std::string bytes = extension == ".stl" ? stl_bytes(mesh) : ply_bytes(mesh);
  std::ofstream out = core::open_output(path);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.flush();
  if (!out) throw InputError(path, "", "cannot be written");
}

}  // namespace karst::cave
