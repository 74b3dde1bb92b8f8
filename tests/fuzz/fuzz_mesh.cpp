// Meshes of every format; the first byte says which. Our own check of PLY and STL runs here, the importer in
// its child: what comes back is a mesh of finite corners, or an InputError.
#include <array>
#include <cstdlib>

#include "plugins/simulator/cave/triangle_mesh.h"
#include "tests/fuzz/as_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  constexpr std::array kEndings{".ply", ".stl", ".obj", ".dae"};
  return karst::fuzz::read_as_file(data + 1, size - 1, kEndings[data[0] % 4], [](const std::string& path) {
    const karst::cave::TriangleMesh mesh = karst::cave::load_mesh(path);
    if (mesh.triangles.empty()) std::abort();
    for (const auto& v : mesh.vertices)
      if (!v.allFinite()) std::abort();
    for (const auto& t : mesh.triangles)
      for (const std::uint32_t i : t)
        if (i >= mesh.vertices.size()) std::abort();
  });
}
