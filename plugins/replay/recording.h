// A folder of recorded scans: its files, their stamps, and each as a sweep.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core_stack/localization/sweep.h"
#include "plugins/replay/recording_info.h"
#include "plugins/replay/scan_files/imu_file.h"
#include "plugins/replay/sensor_stream.h"

namespace karst::replay {

struct RecordedFile {
  std::filesystem::path path, point_times;  // point_times is "" if there is no such file
  core::TimeNs stamp = 0;                   // the recording's own time
};

struct Recording {
  std::filesystem::path folder;
  std::string info_file;  // "" without one: RecordingInfo's defaults apply
  RecordingInfo info;
  RecordingLayout layout;
  std::vector<RecordedFile> files;  // stamps strictly increasing
};

/// Opens a folder, reading `info_file`, or recording.info in it if that is "" and there is one. Throws
/// InputError: no scan there, stamps that are missing or go back, a key that is wrong.
Recording open_recording(const std::filesystem::path& folder, const std::string& info_file);

/// Reads one scan: rings assigned, times relative to the end of the sweep, which becomes the stamp; points by
/// ring, in the order of time within it (of azimuth where there is no time). Throws InputError.
core::Sweep read_sweep(const Recording& recording, std::size_t i, ReadNotes* notes = nullptr);

/// The recording's IMU, if it has one.
std::optional<ImuFile> open_imu(const Recording& recording);

class FolderSensors final : public SensorStream {
 public:
  explicit FolderSensors(Recording recording);

  core::TimeNs begin() const override;
  std::optional<std::size_t> scans() const override { return recording_.files.size(); }
  std::optional<core::Sweep> next_sweep(ReadNotes& notes) override;
  bool has_imu() const override { return imu_.has_value(); }
  std::optional<core::ImuSample> next_imu() override;

 private:
  Recording recording_;
  std::optional<ImuFile> imu_;
  std::size_t next_ = 0;
};

}  // namespace karst::replay
