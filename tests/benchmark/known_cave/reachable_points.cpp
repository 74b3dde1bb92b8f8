// Writes the space of a cave that a vehicle can see, for the policy known_cave: one point in each cube of two
// map cells, x y z in metres as 32-bit floats.
#include <array>
#include <cstdio>
#include <exception>
#include <fstream>

#include "core_stack/common/error.h"
#include "plugins/simulator/cave/cave.h"
#include "sdk/evaluation/reachable/reachable.h"

namespace {

void write_points(const char* cave_file, const char* out_file) {
  using namespace karst;
  const cave::Cave cave = cave::load_cave(cave_file, "");
  const evaluation::Reachable r =
      evaluation::find_reachable(cave.scene.mesh(), cave.description.start.position, {}, cave_file);
  std::ofstream out(out_file, std::ios::binary);
  r.reachable.for_each([&](const core::CellKey& k) {
    if (k.x % 2 != 0 || k.y % 2 != 0 || k.z % 2 != 0) return;
    const core::Vec3 p = evaluation::center_of(k, r.options.resolution_m);
    const std::array<float, 3> point{static_cast<float>(p.x()), static_cast<float>(p.y()),
                                     static_cast<float>(p.z())};
    out.write(reinterpret_cast<const char*>(point.data()), sizeof point);
  });
  if (!out.flush()) throw core::InputError(out_file, "", "cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: reachable_points CAVE.info OUT\n");
    return 1;
  }
  try {
    write_points(argv[1], argv[2]);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "reachable_points: %s\n", e.what());
    return 1;
  }
  return 0;
}
