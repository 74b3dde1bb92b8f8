#include "sdk/tools/cave_cap.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core_stack/common/counted.h"
#include "core_stack/common/decimal_text.h"
#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/json_point.h"
#include "plugins/simulator/cave/cap_holes.h"
#include "sdk/terminal/terminal.h"

namespace karst::tools {
namespace {

using cave::LeftOpen;
using core::InputError;
using nlohmann::ordered_json;

constexpr std::size_t kMostLines = 20;  // of loops, on the screen

std::string fate_of(const cave::CapOfLoop& c, double limit_m) {
  switch (c.left) {
    case LeftOpen::no:
      return "closed";
    case LeftOpen::slit:
      return "left open, all on one line: nothing passes";
    case LeftOpen::too_large:
      return core::format_text("left open, wider than --cap-limit (%g m)", limit_m);
    case LeftOpen::seam:
      break;
  }
  return "left open, air on both sides: parts of the mesh meet there";
}

ordered_json cap_json(const cave::CapOfLoop& c) {
  return {{"fate", core::name_of(c.left)},
          {"edges", c.loop.vertices.size()},
          {"area_m2", c.loop.area_m2},
          {"diameter_m", c.loop.diameter_m},
          {"centre_m", core::list(c.loop.centre)}};
}

}  // namespace

void write_capped(const cave::MeshFile& mesh, const CapArguments& args, bool json) {
  if (const std::string e = cave::lower_extension(args.out); e != ".ply" && e != ".stl")
    throw InputError("--cap", args.out, "meshes are written as .ply or .stl");
  if (std::filesystem::exists(args.out))
    throw InputError(args.out, "", "is there already; choose another name for --cap");
  const cave::Capped capped = cave::cap_holes(cave::RayScene(cave::load_mesh(mesh)), args.limit_m);
  if (capped.loops.empty()) throw InputError(mesh.path, "", "has no open edge: there is nothing to close");
  const auto closed = static_cast<std::size_t>(
      std::count_if(capped.loops.begin(), capped.loops.end(),
                    [](const cave::CapOfLoop& c) { return c.left == LeftOpen::no; }));
  if (closed > 0) cave::write_mesh(args.out, capped.mesh);
  if (json) {
    ordered_json j{{"file", mesh.path}, {"closed", closed}, {"loops", ordered_json::array()}};
    for (const cave::CapOfLoop& c : capped.loops) j["loops"].push_back(cap_json(c));
    print_json(j);
  } else {
    print_out("%s: %s of open edges, %zu closed\n", mesh.path.c_str(),
              core::counted(capped.loops.size(), "loop").c_str(), closed);
    for (std::size_t i = 0; i < capped.loops.size() && i < kMostLines; ++i) {
      const cave::CapOfLoop& c = capped.loops[i];
      print_out("  %8.2f m², %6.2f m across, around %s: %s\n", c.loop.area_m2, c.loop.diameter_m,
                core::decimal_text(c.loop.centre, 1).c_str(), fate_of(c, args.limit_m).c_str());
    }
    if (capped.loops.size() > kMostLines)
      print_out("  and %zu smaller ones; --json lists all\n", capped.loops.size() - kMostLines);
    if (closed > 0)
      print_out("written, in metres with z up: %s\nnext:\n  karst cave info %s\n", args.out.c_str(),
                args.out.c_str());
  }
  if (closed == 0) throw InputError(mesh.path, "", "no hole was closed; nothing is written");
}

}  // namespace karst::tools
