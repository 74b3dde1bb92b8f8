#include "plugins/replay/recording_source.h"

#include <filesystem>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "plugins/replay/bag_sensors.h"
#include "plugins/replay/recording.h"

namespace karst::replay {

namespace {

namespace fs = std::filesystem;

bool is_bag_recording(const std::string& path) {
  if (!fs::exists(path)) throw core::InputError(path, "", "no such bag, and no such folder of scans");
  if (!fs::is_directory(path)) {
    core::check_input(path, core::kMaxDataFileBytes);
    return true;
  }
  if (!is_folder_of_bags(path)) return false;
  if (holds_scan_files(path)) throw core::InputError(path, "", "holds scans and bags: name the bag");
  return true;
}

}  // namespace

bool holds_scan_files(const std::string& folder) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.is_regular_file() && is_scan_file(entry.path().string())) return true;
  return false;
}

RecordingSource open_source(const std::string& path, const std::string& info_file) {
  RecordingSource source;
  source.path = path;
  source.is_bag = is_bag_recording(path);
  if (source.is_bag) {
    BagRecording bag = open_bag_recording(path, info_file);
    source.info_file = bag.info_file;
    source.info = bag.info;
    source.assumptions = bag.assumptions;
    source.sensors = std::make_unique<BagSensors>(std::move(bag));
  } else {
    Recording folder = open_recording(path, info_file);
    read_sweep(folder, 0);
    source.info_file = folder.info_file;
    source.info = folder.info;
    source.sensors = std::make_unique<FolderSensors>(std::move(folder));
  }
  return source;
}

}  // namespace karst::replay
