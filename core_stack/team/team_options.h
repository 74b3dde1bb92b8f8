// The mission file's sections `team` and `homing`: the team's size, and how its robots land.
#pragma once
#include "core_stack/common/options.h"
#include "core_stack/homing/landing/landing_options.h"
#include "core_stack/homing/path_home/homing_tree.h"
#include "core_stack/team/communication/gossip.h"
#include "core_stack/team/communication/relay_graph.h"

namespace karst::core {

/// Where a robot lands when its battery runs low.
enum class LandingStrategy { return_to_base, relay_tree, relay_chain };
constexpr auto names_of(LandingStrategy) {
  using enum LandingStrategy;
  return std::to_array<Named<LandingStrategy>>(
      {{return_to_base, "return_to_base"}, {relay_tree, "relay_tree"}, {relay_chain, "relay_chain"}});
}

struct TeamOptions {
  std::int64_t robots = 1;
  std::int64_t nodes = 0;  // carried by each robot
  double stagger_s = 60;
  LandingStrategy strategy = LandingStrategy::relay_chain;
  double separation_m = 3.0;
  double claim_radius_m = 4.0;
  double claim_age_s = 60;
  double linger_s = 60;
  std::string key_file;  // of the radio; empty: a key derived from the mission's seed
};
void describe(OptionTable& t, TeamOptions& o);

struct HomingOptions {
  double arrival_probability = 0.99;
  // Ratio of flown to estimated time. Measured flights home took 0.82 to 0.91 of the estimate.
  double flown_mean = 0.87, flown_deviation = 0.04;
  HomingTreeOptions tree;
  LandingOptions landing;
  RelayOptions relay;
  GossipOptions gossip;
};
void describe(OptionTable& t, HomingOptions& o);

/// Throws InputError naming `source` if individually valid options contradict each other.
void check(const TeamOptions& team, const HomingOptions& homing, const std::string& source);

/// The fraction to add to an estimated flight time so that the flight keeps within it with the configured
/// probability: mean + z(p) * deviation - 1, as the ratio of flown to estimated time is normally distributed.
/// Negative where flights are faster than estimated.
double homing_margin(const HomingOptions& o);

}  // namespace karst::core
