#include "sdk/flight/cave_check.h"

#include "plugins/simulator/cave/cave.h"
#include "plugins/simulator/cave/preflight.h"
#include "sdk/evaluation/reachable/reachable.h"

namespace karst::flight {

void check_cave(const std::string& cave_file, const std::string& start) {
  const cave::Cave cave = cave::load_cave(cave_file, start);
  cave::check_start(cave, 0);  // has the best message for a bad start
  evaluation::check_reachable(cave.scene.mesh(), cave.description.start.position, {},
                              cave.description.mesh_path);
}

}  // namespace karst::flight
