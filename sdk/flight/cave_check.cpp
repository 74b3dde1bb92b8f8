#include "sdk/flight/cave_check.h"

#include <optional>
#include <utility>

#include "core_stack/common/error.h"
#include "plugins/simulator/cave/cave.h"
#include "plugins/simulator/cave/mesh_advice.h"
#include "plugins/simulator/cave/preflight.h"
#include "plugins/simulator/cave/remedies.h"
#include "sdk/evaluation/reachable/reachable.h"

namespace karst::flight {
namespace {

using core::InputError;

[[noreturn]] void refuse_without_start(const std::string& cave_file, const core::MeshKeys& keys) {
  const cave::MeshFile mesh = cave::mesh_of(cave_file, keys);
  const cave::RayScene scene(cave::load_mesh(mesh));
  // What is wrong with the mesh comes first: a start would be one in a wrong frame.
  std::string wrong;
  for (const cave::MeshAdvice& a : cave::mesh_advice(cave::shape_of(scene), mesh.frame))
    wrong += cave::to_text(a) + "; ";
  if (!wrong.empty())
    throw InputError(cave_file, "mesh", wrong + "then give a start, \"x y z [heading_deg]\"");
  throw InputError(cave_file, "start",
                   "missing: give \"x y z [heading_deg]\"" + cave::remedies(scene, mesh.frame, std::nullopt));
}

}  // namespace

std::vector<std::string> check_cave(const std::string& cave_file, const std::string& start,
                                    const core::MeshKeys& keys) {
  if (start.empty() && !cave::has_start(cave_file)) refuse_without_start(cave_file, keys);
  cave::CaveDescription description = cave::describe_cave(cave_file, start, keys);
  cave::RayScene scene(cave::load_mesh(cave::mesh_of(description)));
  cave::Cave cave{std::move(description), std::move(scene)};
  const core::Vec3 place = cave.description.start.position;
  try {
    cave::lay_objects(cave);
    cave::check_start(cave, 0);  // has the best message for a bad start
    evaluation::check_reachable(cave.scene.mesh(), place, {}, cave.description.mesh_path);
  } catch (const InputError& e) {
    throw InputError(e, cave::remedies(cave.scene, cave.description.mesh_frame, place));
  }
  std::vector<std::string> notes;
  for (const cave::MeshAdvice& a : cave::mesh_advice(cave::shape_of(cave.scene), cave.description.mesh_frame))
    notes.push_back(cave::to_text(a));
  return notes;
}

}  // namespace karst::flight
