#include "plugins/simulator/cave/cave.h"

#include <boost/property_tree/ptree.hpp>
#include <filesystem>
#include <numbers>
#include <sstream>

#include "core_stack/common/error.h"
#include "core_stack/common/options.h"

namespace karst::cave {
namespace {

using core::InputError;
using core::OptionTable;
using core::Vec3;
namespace pt = boost::property_tree;

std::vector<double> read_numbers(const std::string& source, const std::string& key, const std::string& text,
                                 std::size_t least, std::size_t most, const std::string& expected) {
  std::istringstream words(text);
  std::vector<double> numbers;
  for (std::string word; words >> word;) {
    std::size_t used = 0;
    double v = std::numeric_limits<double>::quiet_NaN();
    try {
      v = std::stod(word, &used);
    } catch (const std::exception&) {
      used = 0;
    }
    if (used != word.size() || !std::isfinite(v))
      throw InputError(source, key, "expected " + expected + ", got \"" + text + "\"");
    numbers.push_back(v);
  }
  if (numbers.size() < least || numbers.size() > most)
    throw InputError(source, key, "expected " + expected + ", got \"" + text + "\"");
  return numbers;
}

Vec3 read_vector(const std::string& source, const std::string& key, const std::string& text) {
  const auto n = read_numbers(source, key, text, 3, 3, "three numbers \"x y z\"");
  return {n[0], n[1], n[2]};
}

StartPose read_start(const std::string& source, const std::string& text) {
  const auto n = read_numbers(source, "start", text, 3, 4, "\"x y z [heading_deg]\"");
  for (std::size_t i = 0; i < 3; ++i)  // as far as a mesh may reach
    if (std::abs(n[i]) > 1e5)
      throw InputError(source, "start", "expected a place within 100 km of the origin, got \"" + text + "\"");
  return {{n[0], n[1], n[2]}, n.size() == 4 ? n[3] * std::numbers::pi / 180.0 : 0.0};
}

Patch read_patch(const std::string& source, const pt::ptree& tree) {
  Patch patch;
  std::string position;
  OptionTable table;
  table.add("patch.position", position, {}, "centre, x y z");
  table.add("patch.radius", patch.radius_m, "m", 0.01, 1000, "of the ball that it fills");
  table.add("patch.reflectivity", patch.reflectivity, "", 0, 1, "share of light returned");
  pt::ptree wrapped;
  wrapped.add_child("patch", tree);
  table.read(source, wrapped);
  patch.position = read_vector(source, "patch.position", position);
  return patch;
}

OreBody read_ore(const std::string& source, const pt::ptree& tree) {
  std::string position, moment;
  OptionTable table;
  table.add("ore.position", position, {}, "place of the dipole, x y z");
  table.add("ore.moment", moment, {}, "dipole moment in A m^2, x y z");
  pt::ptree wrapped;
  wrapped.add_child("ore", tree);
  table.read(source, wrapped);
  return {read_vector(source, "ore.position", position), read_vector(source, "ore.moment", moment)};
}

LooseRock read_loose_rock(const std::string& source, const pt::ptree& tree) {
  LooseRock boulder;
  std::string position, to;
  OptionTable table;
  table.add("boulder.position", position, {}, "centre, x y z");
  table.add("boulder.radius", boulder.radius_m, "m", 0.05, 100, "of the ball");
  table.add("boulder.after", boulder.after_s, "s", 0, 86400, "time from which it is there");
  table.add("boulder.within", boulder.within_m, "m", 0, 1000,
            "if not 0, it is there from when the vehicle first comes so near");
  table.add("boulder.to", to, {}, "other end of its way, x y z");
  table.add("boulder.speed", boulder.speed_mps, "m/s", 0, 10, "on its way to and fro");
  pt::ptree wrapped;
  wrapped.add_child("boulder", tree);
  table.read(source, wrapped);
  boulder.position = read_vector(source, "boulder.position", position);
  boulder.to = to.empty() ? boulder.position : read_vector(source, "boulder.to", to);
  return boulder;
}

CaveDescription read_cave_file(const std::string& path, const std::string& start) {
  CaveDescription cave;
  cave.file = path;
  pt::ptree plain;  // without the blocks that may come any number of times
  for (const auto& [name, child] : core::read_info(path)) {
    if (name == "patch" && !child.empty()) {
      cave.patches.push_back(read_patch(path, child));
    } else if (name == "ore" && !child.empty()) {
      cave.ore_bodies.push_back(read_ore(path, child));
    } else if (name == "boulder" && !child.empty()) {
      cave.boulders.push_back(read_loose_rock(path, child));
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
  if (!std::filesystem::is_regular_file(path))
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
  return {std::move(description), RayScene(std::move(mesh))};
}

double reflectivity_at(const CaveDescription& cave, const Vec3& place) {
  double r = cave.reflectivity;
  for (const Patch& p : cave.patches)
    if ((place - p.position).squaredNorm() <= p.radius_m * p.radius_m) r = p.reflectivity;
  return r;
}

}  // namespace karst::cave
