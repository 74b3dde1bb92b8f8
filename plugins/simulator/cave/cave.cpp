#include "plugins/simulator/cave/cave.h"

#include <boost/property_tree/ptree.hpp>
#include <filesystem>

#include "core_stack/common/error.h"
#include "core_stack/common/options.h"
#include "plugins/simulator/cave/cave_blocks.h"
#include "plugins/simulator/cave/preflight.h"

namespace karst::cave {
namespace {

using core::InputError;
using core::OptionTable;
using core::Vec3;
namespace pt = boost::property_tree;

CaveDescription read_cave_file(const std::string& path, const std::string& start) {
  CaveDescription cave;
  cave.file = path;
  pt::ptree plain;  // without the blocks that may be repeated
  for (const auto& [name, child] : core::read_info(path)) {
    if (name == "patch" && !child.empty()) {
      cave.patches.push_back(read_patch(path, child));
    } else if (name == "ore" && !child.empty()) {
      cave.ore_bodies.push_back(read_ore(path, child));
    } else if (name == "boulder" && !child.empty()) {
      cave.boulders.push_back(read_loose_rock(path, child));
    } else if (name == "cloud" && !child.empty()) {
      cave.clouds.push_back(read_cloud(path, child));
    } else if (name == "fault" && !child.empty()) {
      cave.faults.push_back(read_fault(path, child));
    } else if (name == "object" && !child.empty()) {
      cave.objects.push_back(read_object(path, child));
    } else {
      plain.push_back({name, child});
    }
  }
  std::string own_start, mesh;
  OptionTable table;
  table.add("mesh", mesh, {}, "file of the rock's triangles, relative to this file");
  table.add("start", own_start, {}, "place above the floor to start from: x y z [heading_deg]");
  table.add("reflectivity", cave.reflectivity, "", 0, 1, "share of light that bare rock returns");
  table.read(path, plain);
  if (mesh.empty()) throw InputError(path, "mesh", "missing: name the file with the rock's triangles");
  cave.mesh_path = (std::filesystem::path(path).parent_path() / mesh).string();
  if (start.empty() && own_start.empty())
    throw InputError(path, "start", "missing: give \"x y z [heading_deg]\"");
  cave.start = start.empty() ? read_start(path, own_start) : read_start("start given for " + path, start);
  return cave;
}

}  // namespace

CaveDescription describe_cave(const std::string& path, const std::string& start) {
  if (path.empty()) throw InputError("cave", "", "no cave given: name a cave's .info file or a mesh");
  if (!std::filesystem::exists(path))
    throw InputError(path, "", "no such cave file; `karst cave generate` makes one");
  if (std::filesystem::path(path).extension() == ".info") return read_cave_file(path, start);
  if (start.empty())
    throw InputError(path, "start", "a bare mesh needs a start pose \"x y z [heading_deg]\"");
  CaveDescription cave;
  cave.file = cave.mesh_path = path;
  cave.start = read_start("start given for " + path, start);
  return cave;
}

Cave load_cave(const std::string& path, const std::string& start) {
  CaveDescription description = describe_cave(path, start);
  TriangleMesh mesh = load_mesh(description.mesh_path);
  Cave cave{std::move(description), RayScene(std::move(mesh))};
  lay_objects(cave);
  return cave;
}

double reflectivity_at(const CaveDescription& cave, const Vec3& place) {
  double r = cave.reflectivity;
  for (const Patch& p : cave.patches)
    if ((place - p.position).squaredNorm() <= p.radius_m * p.radius_m) r = p.reflectivity;
  return r;
}

}  // namespace karst::cave
