// A recording, whatever it is stored in: a folder of scans, or a bag.
#pragma once
#include <memory>

#include "plugins/replay/recording_info.h"
#include "plugins/replay/sensor_stream.h"

namespace karst::replay {

struct RecordingSource {
  std::string path, info_file;  // info_file: "" without one
  RecordingInfo info;
  std::vector<std::string> assumptions;  // about a bag, a sentence each
  bool is_bag = false;
  std::unique_ptr<SensorStream> sensors;
};

/// True for a folder with point clouds in it.
bool holds_scan_files(const std::string& folder);

/// `info_file` as for open_recording and open_bag_recording. Reads the first scan, so that an error common to
/// all of them is thrown now. Throws InputError.
RecordingSource open_source(const std::string& path, const std::string& info_file);

}  // namespace karst::replay
