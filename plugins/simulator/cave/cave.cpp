#include "plugins/simulator/cave/cave.h"

#include <boost/property_tree/ptree.hpp>
#include <filesystem>
#include <utility>

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

/// A cave as its file has it.
struct CaveOfFile {
  CaveDescription cave;  // without its start
  std::string start;     // "": none
};

CaveOfFile read_cave_file(const std::string& path) {
  CaveOfFile read;
  CaveDescription& cave = read.cave;
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
  std::string mesh;
  core::MeshKeys keys;
  OptionTable table;
  table.add("mesh", mesh, {}, "file of the rock's triangles, relative to this file");
  describe(table, keys);
  table.add("start", read.start, {}, "place above the floor to start from: x y z [heading_deg]");
  table.add("reflectivity", cave.reflectivity, "", 0, 1, "share of light that bare rock returns");
  table.read(path, plain);
  if (mesh.empty()) throw InputError(path, "mesh", "missing: name the file with the rock's triangles");
  cave.mesh_path = (std::filesystem::path(path).parent_path() / mesh).string();
  cave.mesh_frame = mesh_frame(path, cave.mesh_path, keys);
  return read;
}

CaveOfFile read_cave(const std::string& path, const core::MeshKeys& keys) {
  if (path.empty())
    throw InputError(
        "cave", "",
        "no cave given: name a cave's .info file or a mesh, as cave.file of the mission or by --set "
        "cave.file=FILE; `karst cave generate` makes one");
  const bool is_cave_file = std::filesystem::path(path).extension() == ".info";
  if (!std::filesystem::exists(path))
    throw InputError(path, "",
                     is_cave_file ? "no such cave file; `karst cave generate` makes one" : "no such file");
  if (is_cave_file) {
    if (keys != core::MeshKeys{})
      throw InputError(path, "",
                       "is a cave file: it states scale, unit, up and offset of its mesh itself; they can be "
                       "given beside a bare mesh only");
    return read_cave_file(path);
  }
  CaveOfFile bare;
  bare.cave.file = bare.cave.mesh_path = path;
  bare.cave.mesh_frame = mesh_frame(path, path, keys);
  bare.cave.mesh_frame.given_as_options = true;
  return bare;
}

}  // namespace

CaveDescription describe_cave(const std::string& path, const std::string& start, const core::MeshKeys& mesh) {
  CaveOfFile read = read_cave(path, mesh);
  if (start.empty() && read.start.empty())
    throw InputError(path, "start", "missing: give \"x y z [heading_deg]\"; `karst cave info` proposes one");
  read.cave.start =
      start.empty() ? read_start(path, read.start) : read_start("start given for " + path, start);
  return std::move(read.cave);
}

MeshFile mesh_of(const std::string& path, const core::MeshKeys& mesh) {
  return mesh_of(read_cave(path, mesh).cave);
}

bool has_start(const std::string& path) { return !read_cave(path, {}).start.empty(); }

Cave load_cave(const std::string& path, const std::string& start, const core::MeshKeys& keys) {
  CaveDescription description = describe_cave(path, start, keys);
  TriangleMesh mesh = load_mesh(mesh_of(description));
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
