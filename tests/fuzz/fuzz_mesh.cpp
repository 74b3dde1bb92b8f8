// Meshes of every format; the first byte says which, and whether an offset is subtracted. Our own check of
// PLY and STL runs here, the importer and the subtraction in its child: what comes back is a mesh of finite
// corners, or an InputError.
#include <array>
#include <cstdlib>

#include "plugins/simulator/cave/mesh_offset.h"
#include "plugins/simulator/cave/triangle_mesh.h"
#include "tests/fuzz/as_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  constexpr std::array kEndings{".ply", ".stl", ".obj", ".dae"};
  const std::size_t format = data[0] % 4;
  const bool has_offset = (data[0] & 4) != 0;
  karst::cave::MeshFrame frame;
  if (has_offset) frame.offset = karst::core::Vec3(1e6, -2, 0.5);
  return karst::fuzz::read_as_file(data + 1, size - 1, kEndings[format], [&](const std::string& path) {
    // Of Collada the offset is not subtracted from the bytes. Here, not in the child, the fuzzer sees the
    // code.
    if (has_offset && format != 3) karst::cave::bytes_less_offset(path, frame);
    const karst::cave::TriangleMesh mesh = karst::cave::load_mesh(path, frame);
    if (mesh.triangles.empty()) std::abort();
    for (const auto& v : mesh.vertices)
      if (!v.allFinite()) std::abort();
    for (const auto& t : mesh.triangles)
      for (const std::uint32_t i : t)
        if (i >= mesh.vertices.size()) std::abort();
  });
}
