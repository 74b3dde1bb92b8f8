#include "sdk/selection/condition.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "core_stack/common/format_text.h"
#include "core_stack/common/json_text.h"
#include "core_stack/common/options.h"

namespace karst::selection {
namespace {

constexpr std::size_t kSettingsNamed = 4;
constexpr double kSameEndurance = 0.25;  // relative

// Settings that make the kind of a condition, as key or as beginning of keys.
constexpr std::array kOwnKeys{"vehicle",
                              "simulator.vehicle",
                              "simulator.battery_minutes",
                              "simulator.lidar.",
                              "simulator.camera.",
                              "simulator.rgb.",
                              "simulator.pose.fitted",
                              "team.",
                              "radio.",
                              "homing."};

bool is_own(const std::string& key) {
  return std::any_of(kOwnKeys.begin(), kOwnKeys.end(), [&](const std::string& own) {
    return own.ends_with('.') ? key.starts_with(own) : key == own;
  });
}

/// All values by key: a key may occur several times (a list of blocks).
std::map<std::string, std::string> by_key(const Settings& settings) {
  std::map<std::string, std::string> values;
  for (const auto& [key, value] : settings) values[key] += (values.count(key) ? ", " : "") + value;
  return values;
}

double seconds_of(const std::string& key, const std::string& text, const std::string& source) {
  double s = kUnknown;
  if (text.empty()) return s;
  core::OptionTable table;
  table.add(key, s, "s", 0, 1e9, "");
  table.set(source, key, text);
  return s;
}

std::int64_t count_of(const std::string& key, const std::string& text, const std::string& source) {
  std::int64_t n = 1;
  core::OptionTable table;
  table.add(key, n, 1, 1000, "");
  table.set(source, key, text);
  return n;
}

std::string words(const std::string& vehicle, const std::string& sensors, double endurance_s,
                  std::int64_t robots) {
  std::string out = vehicle.empty() ? "any vehicle" : vehicle;
  if (!sensors.empty()) out += " (" + sensors + ")";
  if (std::isfinite(endurance_s)) out += core::format_text(", %.0f s", endurance_s);
  if (robots > 1) out += ", a team of " + std::to_string(robots);
  return out;
}

}  // namespace

void complete(Condition& c, const std::string& flight_time, const std::string& source) {
  const std::map<std::string, std::string> settings = by_key(c.mission);
  const auto setting = [&](const std::string& key) {
    const auto found = settings.find(key);
    return found == settings.end() ? std::string() : found->second;
  };
  if (const std::string robots = setting("team.robots"); !robots.empty())
    c.robots = count_of("team.robots", robots, source);
  if (c.vehicle.empty()) c.vehicle = setting("simulator.vehicle");
  if (c.sensors.empty())
    c.sensors = setting(c.vehicle.find("lidar") != std::string::npos ? "simulator.lidar.unit"
                                                                     : "simulator.camera.kind");
  if (!(c.endurance_s > 0)) {
    const double given_s = seconds_of("mission.max_flight_time", flight_time, source);
    const double battery_s =
        seconds_of("simulator.battery_minutes", setting("simulator.battery_minutes"), source);
    c.endurance_s = std::isnan(given_s) ? c.horizon_s : given_s;
    if (battery_s < c.endurance_s) c.endurance_s = battery_s;
  }
  if (!c.name.empty()) return;
  c.name = c.vehicle.empty() ? "flights" : c.vehicle;
  if (!c.sensors.empty()) c.name += "_" + c.sensors;
  c.name += core::format_text("_%.0fs", c.endurance_s);
  if (c.robots > 1) c.name += "_team" + std::to_string(c.robots);
}

bool same_kind(const Condition& a, const Condition& b) {
  return a.vehicle == b.vehicle && a.sensors == b.sensors && a.endurance_s == b.endurance_s &&
         a.robots == b.robots;
}

std::string difference(const Condition& a, const Condition& b) {
  std::string text;
  const auto differ = [&](const std::string& what, const std::string& there, const std::string& here) {
    text += (text.empty() ? "" : "; ") + what + " " + here + " here, " + there + " there";
  };
  const bool same = same_kind(a, b);
  if (same && a.horizon_s != b.horizon_s)
    differ("horizon", core::json_text(nlohmann::json(a.horizon_s)) + " s",
           core::json_text(nlohmann::json(b.horizon_s)) + " s");
  if (a.profile != b.profile) differ("profile", a.profile, b.profile);
  std::size_t settings = 0;
  const std::map<std::string, std::string> here = by_key(b.mission);
  for (const auto& [key, value] : by_key(a.mission)) {
    if (!same && is_own(key)) continue;
    if (const auto found = here.find(key); found != here.end() && found->second != value)
      if (++settings <= kSettingsNamed) differ(key, value, found->second);
  }
  if (settings > kSettingsNamed) text += "; " + std::to_string(settings - kSettingsNamed) + " more settings";
  return text;
}

AskedConditions asked(const Condition& c) { return {c.vehicle, c.sensors, c.endurance_s, c.robots}; }

bool meets(const Condition& c, const AskedConditions& a) {
  const auto is = [](const std::string& known, const std::string& wanted) {
    return wanted.empty() || known.empty() || known == wanted;
  };
  return is(c.vehicle, a.vehicle) && is(c.sensors, a.sensors) && (a.robots == 0 || a.robots == c.robots) &&
         (std::isnan(a.endurance_s) ||
          std::abs(c.endurance_s - a.endurance_s) <= kSameEndurance * a.endurance_s);
}

std::string in_words(const Condition& c) { return words(c.vehicle, c.sensors, c.endurance_s, c.robots); }
std::string in_words(const AskedConditions& a) {
  return words(a.vehicle, a.sensors, a.endurance_s, a.robots);
}

}  // namespace karst::selection
