#include "plugins/simulator/cave/joined_vertices.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace karst::cave {

std::vector<std::uint32_t> first_at_position(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> order(mesh.vertices.size()), first(mesh.vertices.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto key = [&](std::uint32_t i) {
    const core::Vec3f& v = mesh.vertices[i];
    return std::array<float, 3>{v.x(), v.y(), v.z()};
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::pair(key(a), a) < std::pair(key(b), b); });
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? first[order[i - 1]] : order[i];
  return first;
}

}  // namespace karst::cave
