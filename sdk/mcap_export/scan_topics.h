// The scans and the IMU that a flight recorded (record.scans).
#pragma once
#include <vector>

#include "plugins/replay/bag/bag.h"
#include "sdk/evaluation/record/run_record.h"
#include "sdk/mcap_export/topic.h"

namespace karst::mcap {

/// Of the folder scans: /points, /imu, /compass, and the LiDAR's place in /tf_static. None if there is no
/// such folder. The files are read one by one. What is damaged ends its topic, and is added to `problems`
/// when the topic comes to it: it outlives the topics.
std::vector<Topic> scan_topics(const evaluation::RunRecord& run, const FlightClock& clock,
                               std::vector<std::string>& problems);

/// What the messages of these topics cannot say: a metadata record from which `karst replay` takes it. Empty
/// without scans.
replay::RecordedSettings recorded_settings(const evaluation::RunRecord& run);

}  // namespace karst::mcap
