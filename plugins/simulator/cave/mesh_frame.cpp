#include "plugins/simulator/cave/mesh_frame.h"

#include <cmath>

#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/units.h"
#include "plugins/simulator/cave/cave_blocks.h"
#include "plugins/simulator/cave/triangle_mesh.h"

namespace karst::cave {

using core::InputError;
using core::MeshUnit;
using core::UpAxis;
using core::Vec3;

bool has_offset(const MeshFrame& frame) { return frame.offset.squaredNorm() > 0; }

bool is_plain(const MeshFrame& frame) {
  return frame.metres_per_unit == 1 && frame.up == UpAxis::z && !has_offset(frame);
}

Vec3 to_metres(const MeshFrame& frame, const Vec3& p) {
  return frame.metres_per_unit * (frame.up == UpAxis::z ? p : Vec3(p.x(), -p.z(), p.y()));
}

Vec3 to_file(const MeshFrame& frame, const Vec3& place_m) {
  const Vec3 p = place_m / frame.metres_per_unit;
  return frame.offset + (frame.up == UpAxis::z ? p : Vec3(p.x(), p.z(), -p.y()));
}

std::string unit_text(const MeshFrame& frame) {
  for (const std::string& name : core::all_names<MeshUnit>())
    if (const double m = *core::unit_factor(name, "m"); std::abs(frame.metres_per_unit - m) <= 1e-9 * m)
      return name;
  return core::shortest_text(frame.metres_per_unit) + " m";
}

std::string to_text(const MeshFrame& frame) {
  std::string text =
      core::shortest_text(frame.metres_per_unit) + " m a unit, " + core::name_of(frame.up) + " up, offset";
  for (const double v : {frame.offset.x(), frame.offset.y(), frame.offset.z()})
    text += " " + core::shortest_text(v);
  return text;
}

MeshFrame mesh_frame(const std::string& source, const std::string& mesh_path, const core::MeshKeys& keys) {
  MeshFrame frame;
  frame.states_its_own = lower_extension(mesh_path) == ".dae";
  const auto refuse = [&](const char* key, const char* remedy) {
    if (frame.states_its_own)
      throw InputError(source, key, std::string("is stated by a Collada file itself: ") + remedy);
  };
  if (keys.unit != MeshUnit::m) refuse("unit", "if it is wrong there, give a scale");
  if (keys.up != UpAxis::z) refuse("up", "if it is wrong there, export the mesh anew");
  frame.metres_per_unit = keys.scale * *core::unit_factor(core::name_of(keys.unit), "m");
  frame.up = keys.up;
  if (!keys.offset.empty()) frame.offset = read_vector(source, "offset", keys.offset);
  return frame;
}

}  // namespace karst::cave
