// The times of a resolved mission: how long a vehicle may fly, and how much of this can be exploration.
#pragma once
#include <boost/property_tree/ptree.hpp>
#include <string>

#include "sdk/campaign/plan/plan.h"

namespace karst::campaign {

/// A quantity of a resolved mission in this unit; `otherwise` where the mission does not have it.
double quantity_in(const boost::property_tree::ptree& mission, const std::string& key,
                   const std::string& unit, double otherwise);

/// The longest flight of one vehicle: the flight time or the battery's endurance.
double longest_flight_s(const boost::property_tree::ptree& mission);

/// The longest time that a vehicle can explore: as long as it stays at its start, from where the way home is
/// no longer than the landing. Take-off, landing and reserve are the mission's.
double longest_exploration_s(const boost::property_tree::ptree& mission);

/// A warning about flights of which take-off, landing and reserve take more than a half; "" if there are
/// none.
std::string little_exploration_text(const Plan& plan);

}  // namespace karst::campaign
