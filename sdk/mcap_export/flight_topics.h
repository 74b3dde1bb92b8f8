// The topics of a flight, of what its run directory holds (docs/export_mcap.md lists them). The record
// outlives the topics.
#pragma once
#include <vector>

#include "sdk/evaluation/record/run_record.h"
#include "sdk/mcap_export/topic.h"

namespace karst::mcap {

constexpr const char *kMapFrame = "map", *kBodyFrame = "base_link", *kTrueBodyFrame = "base_link_truth";

/// /tf, /odometry, /path and, of a simulated flight, /truth/odometry.
std::vector<Topic> pose_topics(const evaluation::RunRecord& run, const FlightClock& clock);
/// /map, /map/new. A stored map that cannot be read is added to `problems`.
std::vector<Topic> map_topics(const evaluation::RunRecord& run, const FlightClock& clock,
                              std::vector<std::string>& problems);
/// /plan, /frontiers, /goals, /drawings, /objects, /phase, /events.
std::vector<Topic> event_topics(const evaluation::RunRecord& run, const FlightClock& clock);
/// /battery.
Topic battery_topic(const evaluation::RunRecord& run, const FlightClock& clock);

/// A message of /tf_static.
Topic static_transform(const FlightClock& clock, const char* parent, const char* child,
                       const core::Pose& T_parent_child);

/// Times at which what has grown until then is told whole: not more than 40, whole seconds apart, the last at
/// the end. So all of them are at most about twenty times as large as the last, however long the flight.
std::vector<double> snapshot_times(double end_s);

}  // namespace karst::mcap
