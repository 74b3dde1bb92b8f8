// Reads IMU samples one by one, so that a recording of hours need not fit into memory.
#pragma once
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/vehicle/messages.h"

namespace karst::replay {

class ImuFile {
 public:
  /// `columns` as in RecordingInfo. Throws InputError if the file cannot be opened or a column is missing.
  ImuFile(const std::string& path, const std::string& columns, core::TimeNs unit_ns,
          const core::Quat& R_body_imu);

  /// The next sample, body frame, with the recording's own stamp; nullopt at the end. Skips lines that begin
  /// with # or with a letter (a heading). Throws InputError with the line on anything else that is no sample
  /// or goes back in time.
  std::optional<core::ImuSample> next();

 private:
  std::string path_;
  std::ifstream in_;
  std::size_t line_ = 0, columns_ = 0;
  std::array<std::size_t, 7> at_{};  // columns of t, ax, ay, az, wx, wy, wz
  core::TimeNs unit_ns_;
  core::Quat R_body_imu_;
  std::optional<core::TimeNs> last_;
};

}  // namespace karst::replay
