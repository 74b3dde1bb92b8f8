#include "core_stack/team/team_options.h"

#include <boost/math/special_functions/erf.hpp>
#include <cmath>

#include "core_stack/common/error.h"
#include "core_stack/common/install_location.h"

namespace karst::core {

void describe(OptionTable& t, TeamOptions& o) {
  t.add("robots", o.robots, 1, kMaxRobots - 1, "1: one vehicle alone, and no team");
  constexpr int kMaxNodes = kMaxRobots / 2 - 2;
  t.add("nodes", o.nodes, 0, kMaxNodes,
        "communication nodes that each robot carries, and drops where it comes out of reach");
  t.add("stagger", o.stagger_s, "s", 0, 7200, "between two starts; whole seconds");
  t.add("strategy", o.strategy,
        "where a robot lands when its battery runs low (" + doc_path("docs/homing.md") + ")");
  t.add("separation", o.separation_m, "m", 1.0, 20,
        "of two vehicles nearer than this, and what they need to stop, one gives way: to who lands or has no "
        "room, "
        "then to who goes home, else the higher number");
  t.add("claim_radius", o.claim_radius_m, "m", 0, 50, "frontiers so near to another's goal are left to it");
  t.add("claim_age", o.claim_age_s, "s", 1, 3600, "a goal claimed longer ago is free again");
  t.add("linger", o.linger_s, "s", 0, 600, "the radios go on for so long after the last landing");
  t.add("key_file", o.key_file, {},
        "64 hexadecimal digits, as from openssl rand -hex 32: the key that frames on the radio are "
        "authenticated "
        "with, one for each mission; none: a key of the seed, which is for simulation only");
}

void describe(OptionTable& t, HomingOptions& o) {
  t.add("arrival_probability", o.arrival_probability, "", 0.5, 0.999999,
        "of reaching the landing place before the reserve is touched");
  t.add("flown_mean", o.flown_mean, "", 0.1, 3, "mean of flown over estimated time of flights home");
  t.add("flown_deviation", o.flown_deviation, "", 0, 1, "its standard deviation");
  t.section("tree", o.tree);
  t.section("landing", o.landing);
  t.section("relay", o.relay);
  t.section("gossip", o.gossip);
}

void check(const TeamOptions& team, const HomingOptions& homing, const std::string& source) {
  if (team.nodes > 0 && team.robots == 1)
    throw InputError(source, "team.nodes", "a vehicle alone is no team: team.robots is 1");
  if (team.robots * (1 + team.nodes) >= kMaxRobots)
    throw InputError(source, "team.nodes",
                     std::to_string(team.robots) + " robots that carry " + std::to_string(team.nodes) +
                         " each are " + std::to_string(team.robots * (1 + team.nodes)) +
                         " radios, and messages can name " + std::to_string(kMaxRobots - 1) +
                         " beside the base's: " + std::to_string((kMaxRobots - 1) / team.robots - 1) +
                         " each at most");
  if (homing.tree.longest_edge_m <= homing.tree.min_edge_m)
    throw InputError(source, "homing.tree.longest_edge",
                     "is no longer than homing.tree.min_edge: no two nodes would be joined");
}

double homing_margin(const HomingOptions& o) {
  const double z = std::sqrt(2.0) * boost::math::erf_inv(2 * o.arrival_probability - 1);
  return o.flown_mean + z * o.flown_deviation - 1;
}

}  // namespace karst::core
