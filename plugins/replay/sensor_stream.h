// The scans and IMU samples of a recording, whatever it is stored in.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core_stack/localization/sweep.h"
#include "core_stack/vehicle/messages.h"

namespace karst::replay {

/// Remarks on the scan that was read.
struct ReadNotes {
  core::TimeNs stamp = 0;      // of the scan, set before it is read
  std::size_t dropped = 0;     // points that are not finite or out of range
  bool without_times = false;  // not motion-compensated, and the points have no measurement times
};

class SensorStream {
 public:
  virtual ~SensorStream() = default;

  /// One sweep before the first scan, in the recording's own time: where a replay's time begins.
  virtual core::TimeNs begin() const = 0;
  /// How many scans there are, if that is known before they are read.
  virtual std::optional<std::size_t> scans() const = 0;
  /// The next scan, its stamp in the recording's own time and later than the last one's; nullopt at the end.
  /// Throws InputError if it cannot be read.
  virtual std::optional<core::Sweep> next_sweep(ReadNotes& notes) = 0;
  virtual bool has_imu() const = 0;
  /// The next sample in the body frame, with the recording's own stamp; nullopt if there is none, or none
  /// yet.
  virtual std::optional<core::ImuSample> next_imu() = 0;
  /// What was left out because it was damaged, each as "file: place: reason". `count` counts all, also those
  /// that are not kept.
  struct Damage {
    std::vector<std::string> first;
    std::size_t count = 0;
  };
  virtual Damage damage() const { return {}; }
  /// Scans that were skipped, as no point of theirs is within range: of a blocked or a starting LiDAR.
  virtual std::size_t scans_without_returns() const { return 0; }
};

}  // namespace karst::replay
