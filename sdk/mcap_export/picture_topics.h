// The colour camera's pictures.
#pragma once
#include <string>
#include <vector>

#include "sdk/evaluation/record/run_record.h"
#include "sdk/mcap_export/topic.h"

namespace karst::mcap {

/// Of frames.csv and the pictures it names: /camera/image_raw/compressed, /camera/camera_info and the
/// camera's frames in /tf, as the core estimated them. A picture that is missing or no JPEG is left out and
/// reported.
std::vector<Topic> picture_topics(const evaluation::RunRecord& run, const FlightClock& clock,
                                  std::vector<std::string>& problems);

}  // namespace karst::mcap
