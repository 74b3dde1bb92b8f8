// Clouds of every format; the first byte says which, whether there is an offset and another unit, and whether
// normals are wanted. What comes back is finite points, with as many unit normals or none.
#include <array>
#include <cmath>
#include <cstdlib>

#include "sdk/cave_from_cloud/read_cloud.h"
#include "tests/fuzz/as_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  constexpr std::array kEndings{".las", ".ply", ".pcd"};
  karst::cave::MeshFrame frame;
  if ((data[0] & 4) != 0) frame.offset = karst::core::Vec3(672000, 5200000, 400);
  if ((data[0] & 8) != 0) frame.metres_per_unit = 0.001;
  if ((data[0] & 16) != 0) frame.up = karst::core::UpAxis::y;
  const bool with_normals = (data[0] & 32) == 0;
  const char* ending = kEndings[(data[0] & 3) % kEndings.size()];
  return karst::fuzz::read_as_file(data + 1, size - 1, ending, [&](const std::string& path) {
    const karst::from_cloud::CloudFile file = karst::from_cloud::read_cloud(path, frame, with_normals);
    const karst::from_cloud::PointCloud& cloud = file.cloud;
    const std::size_t left_out = file.not_finite + file.withheld + file.without_normal;
    if (cloud.points.empty() || file.points != cloud.points.size() + left_out) std::abort();
    if (cloud.has_normals() && cloud.normals.size() != cloud.points.size()) std::abort();
    for (const auto& p : cloud.points)
      if (!p.allFinite()) std::abort();
    for (const auto& n : cloud.normals)
      if (!(std::abs(n.norm() - 1) < 1e-3f)) std::abort();
  });
}
