#include "sdk/evaluation/metrics/metric_definitions.h"

#include <array>

#include "core_stack/common/error.h"

namespace karst::evaluation {
namespace {

using enum Better;
using enum IfFailed;

constexpr std::array kDefinitions = {
    MetricDefinition{"completed", "", more, nothing,
                     "1 if it landed at the start after exploring to its end or its time, else 0", 0, 1},
    MetricDefinition{"contacts", "", less, unknown, "times the vehicle touched rock"},
    MetricDefinition{"flight_time_s", "s", neither, unknown, "length of the flight"},
    MetricDefinition{"exploration_time_s", "s", neither, unknown, "time spent exploring"},
    MetricDefinition{"path_length_m", "m", neither, unknown, "length of the way flown"},
    MetricDefinition{"mean_speed_mps", "m/s", more, unknown, "path length over flight time"},
    MetricDefinition{"exploring_speed_mps", "m/s", more, unknown, "mean speed while exploring"},
    MetricDefinition{"standing_share", "", less, unknown, "share of the exploring time below 0.2 m/s", 0, 1},
    MetricDefinition{"longest_stall_s", "s", less, unknown, "longest time within 0.5 m of one place"},
    MetricDefinition{"energy_wh", "Wh", less, unknown, "energy drawn from the battery during the flight"},
    MetricDefinition{"explored_volume_m3", "m^3", more, nothing, "known-free volume of the final map"},
    MetricDefinition{"reachable_volume_m3", "m^3", neither, unknown,
                     "volume of the cave that could be explored (R)"},
    MetricDefinition{"coverage", "", more, nothing, "share of R that the final map knows to be free", 0, 1},
    MetricDefinition{"coverage_auc", "", more, nothing,
                     "mean over the horizon of the coverage reached by then", 0, 1},
    MetricDefinition{"coverage_at_25", "", more, nothing, "coverage after a quarter of the horizon", 0, 1},
    MetricDefinition{"coverage_at_50", "", more, nothing, "coverage after half of the horizon", 0, 1},
    MetricDefinition{"coverage_at_75", "", more, nothing, "coverage after three quarters of the horizon", 0,
                     1},
    MetricDefinition{"t50_s", "s", less, unknown, "time from take-off to 50 % coverage, if it was reached"},
    MetricDefinition{"t90_s", "s", less, unknown, "time from take-off to 90 % coverage, if it was reached"},
    MetricDefinition{"t95_s", "s", less, unknown, "time from take-off to 95 % coverage, if it was reached"},
    MetricDefinition{"restricted_t50_s", "s", less, horizon,
                     "time to 50 % coverage, or the horizon if it was not reached before"},
    MetricDefinition{"restricted_t90_s", "s", less, horizon,
                     "time to 90 % coverage, or the horizon if it was not reached before"},
    MetricDefinition{"restricted_t95_s", "s", less, horizon,
                     "time to 95 % coverage, or the horizon if it was not reached before"},
    MetricDefinition{"surface_seen", "", more, nothing,
                     "share of the rock surface around R that the map holds", 0, 1},
    MetricDefinition{"surface_imaged", "", more, nothing,
                     "share of the rock surface around R that the colour camera's pictures show", 0, 1},
    MetricDefinition{"depth_m", "m", more, nothing,
                     "greatest distance from the start, measured along the way flown without its detours"},
    MetricDefinition{"vertical_reach_m", "m", more, nothing, "greatest height above or below the start"},
    MetricDefinition{"min_clearance_m", "m", more, unknown, "least distance from hull to rock in the air",
                     -std::numeric_limits<double>::infinity()},
    MetricDefinition{"landing_error_m", "m", less, unknown, "how far from the start it landed"},
    MetricDefinition{"battery_left", "", neither, unknown, "last battery fraction", 0, 1},
    MetricDefinition{"map_error_mean_m", "m", less, unknown, "mean distance from the map's cells to rock"},
    MetricDefinition{"map_error_std_m", "m", less, unknown, "standard deviation of that distance"},
    MetricDefinition{"drift_percent", "%", less, unknown, "last error of the position over the path length"},
    MetricDefinition{"heading_error_rad", "rad", less, unknown, "root mean square of the heading's error"},
    MetricDefinition{"tracking_rms_m", "m", less, unknown,
                     "root mean square of the distance to the reference"},
    MetricDefinition{"goals_accepted", "", neither, unknown, "goals accepted"},
    MetricDefinition{"goals_rejected", "", less, unknown, "goals rejected"},
    MetricDefinition{"overruns", "", less, unknown, "jobs that were late"},
    MetricDefinition{"objects_placed", "", neither, unknown, "objects of interest in the cave"},
    MetricDefinition{"objects_seen", "", more, nothing,
                     "those that were in view of a camera in 6 images at least"},
    MetricDefinition{"objects_found", "", more, nothing,
                     "objects found where one of that kind lies within 3 m"},
    MetricDefinition{"objects_reported", "", more, nothing, "those that the base knew in the end"},
    MetricDefinition{"objects_reported_share", "", more, nothing,
                     "share of the objects seen that the base knew in the end", 0, 1},
    MetricDefinition{"object_report_time_s", "s", less, unknown,
                     "mean time from the mission's start to when the base knew of an object"},
    MetricDefinition{"object_error_m", "m", less, unknown,
                     "mean distance from where the base has an object to where it lies"},
    MetricDefinition{"objects_false", "", less, unknown, "objects the base was told of that are none"},
    MetricDefinition{"data_at_base_share", "", more, nothing,
                     "share of what a team's robots told that the base held at the end", 0, 1},
    MetricDefinition{"robots_landed", "", more, nothing, "share of a team's robots that landed", 0, 1},
    MetricDefinition{"robots_connected", "", more, unknown,
                     "share of those that reached the base over the relay graph at the end", 0, 1},
    MetricDefinition{"exploration_time_1_s", "s", more, nothing,
                     "time robot 1 of a team explored before homing"},
    MetricDefinition{"exploration_time_2_s", "s", more, nothing, "the same of robot 2"},
    MetricDefinition{"exploration_time_3_s", "s", more, nothing, "the same of robot 3"},
    MetricDefinition{"exploration_time_4_s", "s", more, nothing, "the same of robot 4"},
    MetricDefinition{"exploration_time_5_s", "s", more, nothing, "the same of robot 5"},
    MetricDefinition{"unsurveyed_volume_m3", "m^3", more, nothing,
                     "explored volume that the mission's survey lacks"},
    MetricDefinition{"time_to_unsurveyed_50_s", "s", less, unknown,
                     "time from take-off to 50 m³ that the survey lacks, if they were reached"},
    MetricDefinition{"earlier_map_found", "", more, nothing,
                     "1 if the vehicle found its place in the mission's earlier map, else 0"},
    MetricDefinition{"earlier_volume_m3", "m^3", neither, unknown,
                     "free volume of the earlier map, if found"},
    MetricDefinition{"added_volume_m3", "m^3", more, nothing,
                     "explored volume that the earlier map lacks, if found"},
    MetricDefinition{"volume_per_wh_m3", "m^3", more, nothing,
                     "explored volume for each watt-hour drawn in flight"},
};

}  // namespace

std::span<const MetricDefinition> metric_definitions() { return kDefinitions; }

int metric_index(std::string_view name) {
  for (std::size_t i = 0; i < kDefinitions.size(); ++i)
    if (kDefinitions[i].name == name) return static_cast<int>(i);
  return -1;
}

double better_sign(const std::string& name, const std::string& source) {
  const int i = metric_index(name);
  if (i < 0) throw core::InputError(source, name, "no such figure");
  const Better better = metric_definitions()[static_cast<std::size_t>(i)].better;
  if (better == Better::neither)
    throw core::InputError(source, name, "more of it is neither better nor worse: nothing to choose by");
  return better == Better::more ? 1 : -1;
}

}  // namespace karst::evaluation
