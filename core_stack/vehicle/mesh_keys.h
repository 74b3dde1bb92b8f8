// How the mesh file of a cave is to be read: its unit, its upward axis and its origin, as a cave file, a
// mission or a command line gives them.
#pragma once
#include <string>

#include "core_stack/common/options.h"

namespace karst::core {

enum class MeshUnit { m, cm, mm, ft, in };
constexpr auto names_of(MeshUnit) {
  using enum MeshUnit;
  return std::to_array<Named<MeshUnit>>({{m, "m"}, {cm, "cm"}, {mm, "mm"}, {ft, "ft"}, {in, "in"}});
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
  t.add("scale", k.scale, "", 1e-6, 1e6, "extra scale factor for mesh coordinates");
  t.add("unit", k.unit, "unit of the mesh's coordinates");
  t.add("up", k.up, "axis of the mesh that points up");
  t.add("offset", k.offset, {},
        "\"x y z\" in the mesh's own coordinates: this place becomes the origin, before all else");
}

}  // namespace karst::core
