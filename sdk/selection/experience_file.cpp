// An experience as an INFO file.
//
//   schema karst.experience/3
//   flown { profile campaign  mission { motion { max_speed "1.5 m/s" } ... } }      what all flights share
//   condition { name short  horizon "240 s"  endurance "240 s"  robots 1  vehicle camera_uav  sensors stereo
//               mission { simulator { battery_minutes "4 min" } } }                 its other settings
//   cave { name maze1  hash 5f1c...  figures { volume "5800 m^3"  width "2.4 m" } }
//   contestant { name near  policy nearest_frontier  version 1.0.0  parameters { horizon "60 m" } }
//   result { contestant near  cave maze1  condition short  coverage_auc "0.41 10 0.03" }
//
// The values of a figure in a result: mean, flights, deviation over the seeds.
#include <algorithm>
#include <boost/property_tree/info_parser.hpp>
#include <charconv>
#include <cmath>
#include <sstream>

#include "core_stack/common/error.h"
#include "core_stack/common/options.h"
#include "sdk/evaluation/metrics/metric_definitions.h"
#include "sdk/selection/experience.h"

namespace karst::selection {
namespace {

namespace pt = boost::property_tree;
using core::InputError;

constexpr const char* kSchema = "karst.experience/3";
constexpr int kMaxRobots = 31;
constexpr double kLongest_s = 1e7;
constexpr std::size_t kHashDigits = 64;
constexpr double kWidest = 0.708;  // deviation of two figures, the least and the most there is: 1 / sqrt(2)

std::string number_text(double v) {
  std::array<char, 32> text;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), v, std::chars_format::general, 6).ptr;
  return {text.data(), end};
}

std::string required(const pt::ptree& tree, const char* key, const std::string& file,
                     const std::string& place) {
  const auto value = tree.get_optional<std::string>(key);
  if (!value || value->empty()) throw InputError(file, place, std::string("lacks its ") + key);
  return *value;
}

template <class Named>
std::size_t index_of(const std::vector<Named>& all, const std::string& name, const std::string& file,
                     const char* kind) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Named& n) { return n.name == name; });
  if (found == all.end()) throw InputError(file, "result", std::string("no such ") + kind + ": " + name);
  return static_cast<std::size_t>(found - all.begin());
}

template <class Named>
void refuse_twice(const std::vector<Named>& all, const std::string& name, const std::string& file) {
  for (const Named& n : all)
    if (n.name == name) throw InputError(file, name, "is there twice");
}

void check_schema(const std::string& schema, const std::string& file) {
  if (schema == kSchema) return;
  if (schema == "karst.experience/1" || schema == "karst.experience/2")
    throw InputError(file, "schema",
                     schema + " does not tell vehicle, battery and team of its flights; " + kSchema +
                         " does: make it anew from the campaign: karst select --learn STORE --out " + file);
  throw InputError(file, "schema",
                   std::string("expected ") + kSchema + ": it is no experience of karst select");
}

core::OptionTable table_of(Condition& c) {
  core::OptionTable table;
  table.add("name", c.name, {}, "");
  table.add("horizon", c.horizon_s, "s", 1, kLongest_s, "");
  table.add("endurance", c.endurance_s, "s", 1, kLongest_s, "");
  table.add("robots", c.robots, 1, kMaxRobots, "");
  table.add("vehicle", c.vehicle, {}, "");
  table.add("sensors", c.sensors, {}, "");
  return table;
}

/// What all flights share; the conditions have their own settings besides.
Condition shared_of(const pt::ptree& tree, const std::string& file) {
  Condition flown;
  for (const auto& [key, child] : tree)
    if (key == "mission")
      flown.mission = core::leaves_of(child);
    else if (key == "profile")
      flown.profile = child.data();
    else
      throw InputError(file, "flown." + key, "no such key; there are profile, mission");
  if (flown.profile.empty()) throw InputError(file, "flown", "lacks its profile");
  return flown;
}

Condition condition_of(const pt::ptree& tree, const Condition& shared, const std::string& file) {
  Condition c = shared;
  core::OptionTable table = table_of(c);
  for (const auto& [key, child] : tree)
    if (key == "mission")
      for (auto& setting : core::leaves_of(child)) c.mission.push_back(std::move(setting));
    else
      table.set(file + ": condition " + tree.get("name", ""), key, child.data());
  const std::string place = "condition " + c.name;
  if (c.name.empty()) throw InputError(file, "condition", "lacks its name");
  if (!(c.horizon_s > 0)) throw InputError(file, place, "lacks its horizon");
  if (!(c.endurance_s > 0)) throw InputError(file, place, "lacks its endurance");
  return c;
}

/// The settings that all conditions have, in the order of the first.
Settings settings_of_all(const std::vector<Condition>& conditions) {
  Settings common;
  for (const auto& setting : conditions.front().mission)
    if (std::all_of(conditions.begin(), conditions.end(), [&](const Condition& c) {
          const auto of_key = [&](const Settings& all) {
            Settings out;
            std::copy_if(all.begin(), all.end(), std::back_inserter(out),
                         [&](const auto& s) { return s.first == setting.first; });
            return out;
          };
          return of_key(c.mission) == of_key(conditions.front().mission);
        }))
      common.push_back(setting);
  return common;
}

KnownCave cave_of(const pt::ptree& tree, const std::string& file) {
  KnownCave cave;
  cave.name = required(tree, "name", file, "cave");
  cave.hash = tree.get("hash", "");
  if (!cave.hash.empty() && (cave.hash.size() != kHashDigits ||
                             cave.hash.find_first_not_of("0123456789abcdef") != std::string::npos))
    throw InputError(file, "cave " + cave.name,
                     "hash: expected the SHA-256 of its mesh, got \"" + cave.hash + "\"");
  core::OptionTable table;
  for (const FigureDefinition& f : figure_definitions())
    table.add(std::string(f.name), cave.figures.*f.value, std::string(f.unit), f.low, f.high, "");
  table.read(file + ": cave " + cave.name, tree.get_child("figures", {}));
  return cave;
}

/// Upper bound of a figure; none of the learned figures can be negative.
double max_of(const std::string& metric, double horizon_s) {
  const evaluation::MetricDefinition& m =
      evaluation::metric_definitions()[static_cast<std::size_t>(evaluation::metric_index(metric))];
  return m.if_failed == evaluation::IfFailed::horizon ? horizon_s : m.most;
}

Fared fared_of(const std::string& text, double most, const std::string& file, const std::string& place) {
  Fared f;
  std::istringstream in(text);
  std::string rest;
  const bool good = static_cast<bool>(in >> f.mean >> f.flights);
  const bool spread = good && in >> f.deviation;
  if (good && !spread) {
    in.clear();
    f.deviation = kUnknown;
  }
  const bool sound = good && std::isfinite(f.mean) && f.flights > 0 && (!spread || f.deviation >= 0);
  if (!sound || in >> rest)
    throw InputError(file, place, "expected \"mean flights [deviation]\", got \"" + text + "\"");
  if (f.mean < 0 || f.mean > most)
    throw InputError(file, place,
                     "the mean " + number_text(f.mean) + " is impossible: expected 0 " +
                         (std::isinf(most) ? "or more" : "to " + number_text(most)));
  if (spread && f.flights < 2) throw InputError(file, place, "a single flight has no deviation");
  if (spread && !(f.deviation <= kWidest * most))
    throw InputError(file, place,
                     "the deviation " + number_text(f.deviation) + " is impossible of figures in 0 to " +
                         number_text(most));
  return f;
}

/// The results, once all that they name has been read.
void read_result(const pt::ptree& tree, Experience& e, const std::string& file) {
  const std::string who = required(tree, "contestant", file, "result"),
                    where = required(tree, "cave", file, "result"),
                    how = required(tree, "condition", file, "result of " + who + " in " + where);
  const std::size_t k = index_of(e.contestants, who, file, "contestant"),
                    c = index_of(e.caves, where, file, "cave"),
                    q = index_of(e.conditions, how, file, "condition"), s = q * e.caves.size() + c;
  const std::string place = who + " in " + where;
  for (const auto& [name, value] : tree) {
    if (name == "contestant" || name == "cave" || name == "condition") continue;
    const auto metric = std::find(e.metrics.begin(), e.metrics.end(), name);
    if (metric == e.metrics.end()) throw InputError(file, "result." + name, "no such figure");
    Fared& there = e.at(k, s, static_cast<std::size_t>(metric - e.metrics.begin()));
    if (there.flights > 0) throw InputError(file, place, name + " is there twice under " + how);
    there = fared_of(value.data(), max_of(name, e.conditions[q].horizon_s), file, place + ": " + name);
  }
}

/// Leaves out what was never flown.
Experience flown_only(const Experience& all) {
  Experience e = all;
  std::vector<Site> sites;
  std::vector<std::size_t> before;
  for (std::size_t s = 0; s < all.sites.size(); ++s) {
    bool flown = false;
    for (std::size_t k = 0; k < all.contestants.size(); ++k)
      for (std::size_t m = 0; m < all.metrics.size(); ++m) flown |= all.at(k, s, m).flights > 0;
    if (!flown) continue;
    sites.push_back(all.sites[s]);
    before.push_back(s);
  }
  lay_out(e, std::move(sites));
  for (std::size_t k = 0; k < e.contestants.size(); ++k)
    for (std::size_t s = 0; s < e.sites.size(); ++s)
      for (std::size_t m = 0; m < e.metrics.size(); ++m) e.at(k, s, m) = all.at(k, before[s], m);
  return e;
}

}  // namespace

Experience read_experience(const std::string& file) {
  const pt::ptree tree = core::read_info(file);
  check_schema(tree.get("schema", ""), file);
  if (tree.count("flown") != 1) throw InputError(file, "flown", "expected one such block");
  const Condition shared = shared_of(tree.get_child("flown"), file);
  Experience e;
  for (const auto& [key, child] : tree) {
    if (key == "condition") {
      Condition condition = condition_of(child, shared, file);
      refuse_twice(e.conditions, condition.name, file);
      for (const Condition& c : e.conditions)
        if (same_kind(c, condition))
          throw InputError(file, condition.name, "is the same condition as " + c.name);
      e.conditions.push_back(std::move(condition));
    } else if (key == "cave") {
      KnownCave cave = cave_of(child, file);
      refuse_twice(e.caves, cave.name, file);
      e.caves.push_back(std::move(cave));
    } else if (key == "contestant") {
      const std::string name = required(child, "name", file, key);
      refuse_twice(e.contestants, name, file);
      e.contestants.push_back({name, required(child, "policy", file, name), child.get("version", ""),
                               child.get_child("parameters", {})});
    } else if (key != "schema" && key != "flown" && key != "result") {
      const std::string near =
          core::nearest_name(key, {"schema", "flown", "condition", "cave", "contestant", "result"});
      throw InputError(file, key, "no such key" + (near.empty() ? "" : "; did you mean " + near + "?"));
    }
  }
  if (e.conditions.empty()) throw InputError(file, "", "holds no condition");
  if (e.caves.empty() || e.contestants.empty()) throw InputError(file, "", "holds no cave or no contestant");
  lay_out(e, all_sites(e));
  for (const auto& [key, child] : tree)
    if (key == "result") read_result(child, e, file);
  return flown_only(e);
}

std::string to_info(const Experience& e) {
  pt::ptree tree;
  tree.put("schema", kSchema);
  const Settings common = settings_of_all(e.conditions);
  pt::ptree flown, mission;
  flown.put("profile", e.conditions.front().profile);
  for (const auto& [key, value] : common) mission.add(key, value);
  flown.add_child("mission", mission);
  tree.add_child("flown", flown);
  for (Condition condition : e.conditions) {
    pt::ptree node = table_of(condition).resolved(), own;
    for (const auto& setting : condition.mission)
      if (std::find(common.begin(), common.end(), setting) == common.end())
        own.add(setting.first, setting.second);
    if (!own.empty()) node.add_child("mission", own);
    tree.push_back({"condition", node});
  }
  for (const KnownCave& cave : e.caves) {
    pt::ptree node;
    node.put("name", cave.name);
    if (!cave.hash.empty()) node.put("hash", cave.hash);
    for (const FigureDefinition& f : figure_definitions())
      if (const double v = cave.figures.*f.value; std::isfinite(v))
        node.put("figures." + std::string(f.name),
                 number_text(v) + (f.unit.empty() ? "" : " " + std::string(f.unit)));
    tree.push_back({"cave", node});
  }
  for (const Preset& preset : e.contestants) {
    pt::ptree node;
    node.put("name", preset.name);
    node.put("policy", preset.policy);
    node.put("version", preset.version);
    if (!preset.parameters.empty()) node.put_child("parameters", preset.parameters);
    tree.push_back({"contestant", node});
  }
  for (std::size_t k = 0; k < e.contestants.size(); ++k)
    for (std::size_t s = 0; s < e.sites.size(); ++s) {
      pt::ptree node;
      node.put("contestant", e.contestants[k].name);
      node.put("cave", e.caves[e.sites[s].cave].name);
      node.put("condition", e.conditions[e.sites[s].condition].name);
      const std::size_t keys = node.size();
      for (std::size_t m = 0; m < e.metrics.size(); ++m) {
        const Fared& f = e.at(k, s, m);
        if (f.flights == 0) continue;
        std::string text = number_text(f.mean) + " " + std::to_string(f.flights);
        if (std::isfinite(f.deviation)) text += " " + number_text(f.deviation);
        node.put(e.metrics[m], text);
      }
      if (node.size() > keys) tree.push_back({"result", node});
    }
  std::ostringstream out;
  pt::write_info(out, tree);
  return out.str();
}

}  // namespace karst::selection
