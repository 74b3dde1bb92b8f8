#include "plugins/simulator/cave_generator/recipe.h"

#include <array>

#include "core_stack/common/error.h"

namespace karst::cave {
namespace {

struct Preset {
  const char* name;
  CaveRecipe recipe;
};

const std::array<Preset, 6> kPresets{{
    {"small",
     {.volume_m3 = 1500,
      .passage_width_m = 4,
      .verticality = 0.2,
      .branching = 0.4,
      .loops = 0,
      .domes = 1,
      .shafts = 0,
      .chimneys = 1}},
    {"tight",
     {.volume_m3 = 1500,
      .passage_width_m = 2.4,
      .verticality = 0.4,
      .branching = 0.5,
      .loops = 1,
      .domes = 1,
      .shafts = 1,
      .chimneys = 1,
      .breakdown = 0.3,
      .speleothems = 0.3,
      .roughness_m = 0.2,
      .grid_m = 0.25}},
    {"medium", {}},
    {"vertical",
     {.volume_m3 = 6000,
      .passage_width_m = 4.5,
      .verticality = 0.9,
      .branching = 0.3,
      .loops = 0,
      .domes = 2,
      .shafts = 4,
      .chimneys = 3}},
    {"maze",
     {.volume_m3 = 6000,
      .passage_width_m = 3.5,
      .verticality = 0.15,
      .branching = 0.9,
      .loops = 8,
      .domes = 1,
      .shafts = 0,
      .chimneys = 1}},
    {"large",
     {.volume_m3 = 20000,
      .passage_width_m = 7,
      .verticality = 0.3,
      .branching = 0.5,
      .loops = 2,
      .domes = 4,
      .shafts = 2,
      .chimneys = 2,
      .roughness_m = 0.4}},
}};

}  // namespace

void describe(core::OptionTable& t, CaveRecipe& r) {
  t.add("volume", r.volume_m3, "", 300, 100000, "free volume to come near to, in cubic metres");
  t.add("passage_width", r.passage_width_m, "m", 2, 20, "width of the main passage; it varies along the way");
  t.add("verticality", r.verticality, "", 0, 1, "how steep passages go up and down, 0 for level");
  t.add("branching", r.branching, "", 0, 1, "share of side passages, 0 for a single passage");
  t.add("loops", r.loops, 0, 50, "connections between passages already there, as many as find a place");
  t.add("domes", r.domes, 0, 50, "chambers wider and higher than the passage");
  t.add("shafts", r.shafts, 0, 50, "vertical ways down, with a passage at the foot");
  t.add("chimneys", r.chimneys, 0, 50, "vertical ways up that end blind");
  t.add("breakdown", r.breakdown, "", 0, 1, "density of heaps of fallen blocks");
  t.add("speleothems", r.speleothems, "", 0, 1, "density of stalactites, stalagmites and columns");
  t.add("roughness", r.roughness_m, "m", 0, 1, "amplitude of the walls' roughness");
  t.add("grid", r.grid_m, "m", 0.15, 0.5, "distance of the surface's vertices");
}

const std::vector<std::string>& cave_presets() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> n;
    for (const Preset& p : kPresets) n.push_back(p.name);
    return n;
  }();
  return names;
}

CaveRecipe cave_preset(const std::string& name) {
  std::string known;
  for (const Preset& p : kPresets) {
    if (p.name == name) return p.recipe;
    known += std::string(known.empty() ? "" : ", ") + p.name;
  }
  const std::string near = core::nearest_name(name, cave_presets());
  throw core::InputError(
      "preset", name,
      "no such preset; there are " + known + (near.empty() ? "" : "; did you mean " + near + "?"));
}

}  // namespace karst::cave
