#include "plugins/simulator/cave/cave_blocks.h"

#include <algorithm>
#include <boost/property_tree/ptree.hpp>
#include <limits>
#include <numbers>
#include <sstream>

#include "core_stack/common/error.h"
#include "core_stack/common/options.h"

namespace karst::cave {

using core::InputError;
using core::OptionTable;
using core::Vec3;
namespace pt = boost::property_tree;

namespace {

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

/// Reads a block; `table` holds its keys with the block's name as prefix.
void read_block(const std::string& source, const std::string& name, const pt::ptree& tree,
                OptionTable& table) {
  pt::ptree wrapped;
  wrapped.add_child(name, tree);
  table.read(source, wrapped);
}

/// The substance of a cloud.
enum class CloudOf { dust, droplets };
constexpr auto names_of(CloudOf) {
  using enum CloudOf;
  return std::to_array<core::Named<CloudOf>>({{dust, "dust"}, {droplets, "droplets"}});
}

}  // namespace

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
  read_block(source, "patch", tree, table);
  patch.position = read_vector(source, "patch.position", position);
  return patch;
}

OreBody read_ore(const std::string& source, const pt::ptree& tree) {
  std::string position, moment;
  OptionTable table;
  table.add("ore.position", position, {}, "place of the dipole, x y z");
  table.add("ore.moment", moment, {}, "dipole moment in A m^2, x y z");
  read_block(source, "ore", tree, table);
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
  read_block(source, "boulder", tree, table);
  boulder.position = read_vector(source, "boulder.position", position);
  boulder.to = to.empty() ? boulder.position : read_vector(source, "boulder.to", to);
  return boulder;
}

Cloud read_cloud(const std::string& source, const pt::ptree& tree) {
  Cloud cloud;
  std::string position, size;
  CloudOf of = CloudOf::dust;
  double radius_m = 0;
  OptionTable table;
  table.add("cloud.position", position, {}, "centre, x y z");
  table.add("cloud.radius", radius_m, "m", 0.05, 1000, "of a ball");
  table.add("cloud.size", size, {}, "edges of a box along the axes, x y z in metres");
  table.add("cloud.extinction", cloud.extinction_1pm, "1/m", 0.001, 100, "share of light lost per metre");
  table.add("cloud.of", of, "what floats in it");
  table.add("cloud.after", cloud.after_s, "s", 0, 86400, "time from which it is there");
  read_block(source, "cloud", tree, table);
  cloud.position = read_vector(source, "cloud.position", position);
  cloud.box = !size.empty();
  if (cloud.box == (radius_m > 0))
    throw InputError(source, "cloud.radius", "expected either a radius, of a ball, or a size, of a box");
  cloud.half_size_m.setConstant(radius_m);
  if (cloud.box) cloud.half_size_m = read_vector(source, "cloud.size", size) / 2;
  if (cloud.half_size_m.minCoeff() <= 0)
    throw InputError(source, "cloud.size", "expected three edges above 0 m, got \"" + size + "\"");
  cloud.lidar_ratio_sr = of == CloudOf::dust ? Cloud::kDust_sr : Cloud::kDroplets_sr;
  return cloud;
}

Fault read_fault(const std::string& source, const pt::ptree& tree) {
  Fault fault;
  std::optional<Fault::Sensor> sensor;
  OptionTable table;
  table.add("fault.sensor", sensor, "whose messages it strikes");
  table.add("fault.kind", fault.kind, "what goes wrong; all but lost are of the LiDAR's scans");
  table.add("fault.after", fault.after_s, "s", 0, 86400, "when it begins");
  table.add("fault.for", fault.lasts_s, "s", 0, 86400, "how long it lasts; 0: one message");
  read_block(source, "fault", tree, table);
  if (!sensor) throw InputError(source, "fault.sensor", "missing: name the sensor that fails");
  fault.sensor = *sensor;
  if (fault.kind != Fault::Kind::lost && fault.sensor != Fault::Sensor::lidar)
    throw InputError(source, "fault.kind",
                     std::string("expected lost, which is all that can happen to the ") +
                         core::name_of(fault.sensor) + ", got \"" + core::name_of(fault.kind) + "\"");
  return fault;
}

CaveObject read_object(const std::string& source, const pt::ptree& tree) {
  std::vector<std::string> kinds = core::all_names<core::ObjectKind>();
  std::erase(kinds, core::name_of(core::ObjectKind::none));
  std::string kind, position;
  OptionTable table;
  table.add("object.kind", kind, std::move(kinds), "what it is");
  table.add("object.position", position, {}, "its middle, a little off the rock it lies on, x y z");
  read_block(source, "object", tree, table);
  if (kind.empty()) throw InputError(source, "object.kind", "missing: say what it is, such as backpack");
  return {*core::parse<core::ObjectKind>(kind), read_vector(source, "object.position", position),
          Vec3::Zero()};
}

}  // namespace karst::cave
