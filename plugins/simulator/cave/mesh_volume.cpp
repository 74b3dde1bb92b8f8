#include "plugins/simulator/cave/mesh_volume.h"

namespace karst::cave {

using core::Vec3;

double enclosed_volume_m3(const TriangleMesh& mesh) {
  double six_volumes = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]].cast<double>(), b = mesh.vertices[t[1]].cast<double>(),
               c = mesh.vertices[t[2]].cast<double>();
    six_volumes -= a.dot(b.cross(c));
  }
  return six_volumes / 6;
}

}  // namespace karst::cave
