// How the mesh file of a cave is to be read: its unit, its upward axis and its origin, as a cave file, a
// mission or a command line gives them.
#pragma once
#include <string>

#include "core_stack/common/options.h"

namespace karst::core {

enum class MeshUnit { m, cm, mm, ft };
constexpr auto names_of(MeshUnit) {
  using enum MeshUnit;
  return std::to_array<Named<MeshUnit>>({{m, "m"}, {cm, "cm"}, {mm, "mm"}, {ft, "ft"}});
}

enum class UpAxis { z, y };
constexpr auto names_of(UpAxis) {
  using enum UpAxis;
  return std::to_array<Named<UpAxis>>({{z, "z"}, {y, "y"}});
}

struct MeshKeys {
  double scale = 1;
  MeshUnit unit = MeshUnit::m;
  UpAxis up = UpAxis::z;
  std::string offset;  // "x y z" in the file's own coordinates; "": none

  bool operator==(const MeshKeys&) const = default;
};

inline void describe(OptionTable& t, MeshKeys& k) {
  t.add("scale", k.scale, "", 1e-6, 1e6, "of the mesh: factor for its coordinates, beside the unit");
  t.add("unit", k.unit, "of the mesh's coordinates");
  t.add("up", k.up, "the mesh's axis that points up");
  t.add("offset", k.offset, {},
        "\"x y z\" in the mesh's own coordinates, which becomes the origin: subtracted before all else");
}

}  // namespace karst::core
