#include "plugins/replay/recording_source.h"

#include <filesystem>

#include "plugins/replay/bag_sensors.h"
#include "plugins/replay/recording.h"

namespace karst::replay {

RecordingSource open_source(const std::string& path, const std::string& info_file) {
  RecordingSource source;
  source.path = path;
  source.is_bag = std::filesystem::is_regular_file(path) || is_folder_of_bags(path);
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
