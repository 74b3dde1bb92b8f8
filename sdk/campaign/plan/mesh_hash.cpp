#include "sdk/campaign/plan/mesh_hash.h"

#include "sdk/campaign/plan/hash.h"

namespace karst::campaign {

std::string mesh_hash(const cave::MeshFile& mesh) {
  const std::string of_bytes = sha256_of_file(mesh.path);
  return cave::is_plain(mesh.frame) ? of_bytes : sha256(of_bytes + "\n" + cave::to_text(mesh.frame));
}

}  // namespace karst::campaign
