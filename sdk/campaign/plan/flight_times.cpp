#include "sdk/campaign/plan/flight_times.h"

#include <algorithm>

#include "core_stack/common/format_text.h"
#include "core_stack/common/options.h"
#include "core_stack/homing/path_home/home.h"

namespace karst::campaign {
namespace {

constexpr double kNoLimit_s = 1e9;
constexpr double kLeastShareExploring = 0.5;

}  // namespace

double quantity_in(const boost::property_tree::ptree& mission, const std::string& key,
                   const std::string& unit, double otherwise) {
  const auto text = mission.get_optional<std::string>(key);
  if (!text) return otherwise;
  double value = otherwise;
  core::OptionTable table;
  table.add(key, value, unit, 0, 1e9, "");
  table.set("mission", key, *text);
  return value;
}

double longest_flight_s(const boost::property_tree::ptree& mission) {
  return std::min(quantity_in(mission, "mission.max_flight_time", "s", kNoLimit_s),
                  quantity_in(mission, "simulator.battery_minutes", "s", kNoLimit_s));
}

double longest_exploration_s(const boost::property_tree::ptree& mission) {
  const double height_m = quantity_in(mission, "mission.takeoff_height", "m", 0),
               landing_mps = quantity_in(mission, "mission.landing_speed", "m/s", 0),
               vertical_s = landing_mps > 0 ? height_m / landing_mps : 0;  // climbs are no slower
  return std::max(0.0, core::home_slack_s(longest_flight_s(mission) - vertical_s, vertical_s,
                                          quantity_in(mission, "mission.home_margin", "", 0),
                                          quantity_in(mission, "mission.home_reserve", "s", 0)));
}

std::string little_exploration_text(const Plan& plan) {
  const PlannedContestant* least = nullptr;
  for (const PlannedContestant& c : plan.contestants)
    if (!least || longest_exploration_s(c.mission) < longest_exploration_s(least->mission)) least = &c;
  if (!least) return "";
  const double flight_s = longest_flight_s(least->mission),
               exploring_s = longest_exploration_s(least->mission);
  if (exploring_s >= kLeastShareExploring * flight_s) return "";
  return core::format_text("the flight time of %.0f s leaves ", flight_s) +
         (exploring_s > 0 ? core::format_text("at most %.0f s to explore", exploring_s)
                          : std::string("no time to explore")) +
         " (contestant " + least->name +
         core::format_text(
             "): take-off, the way home, landing and a reserve of %.0f s (mission.home_reserve) "
             "come out of it; give a longer time (flight_time, --time) or a shorter reserve",
             quantity_in(least->mission, "mission.home_reserve", "s", 0));
}

}  // namespace karst::campaign
