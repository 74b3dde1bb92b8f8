// Writes a run directory as one MCAP file, as Foxglove, RViz 2 and ros2 bag have flights.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/common/time.h"
#include "sdk/mcap_export/topic.h"

namespace karst::mcap {

struct McapExport {
  std::vector<TopicCount> topics;
  std::uint64_t messages = 0, bytes = 0;
  double duration_s = 0;              // of the flight
  core::TimeNs epoch = 0;             // time since 1970 at flight time 0
  std::vector<std::string> problems;  // of the run's files: what they concern is left out
};

/// Without `epoch`, that of the recording that was replayed, else 0. The file is whole or not there. Throws
/// core::InputError if `run` is no run directory, or holds no trajectory; if it is a team's; or naming the
/// file that cannot be written. `version`: of karst.
McapExport export_mcap(const std::filesystem::path& run, const std::filesystem::path& file,
                       std::optional<core::TimeNs> epoch, const std::string& version);

}  // namespace karst::mcap
