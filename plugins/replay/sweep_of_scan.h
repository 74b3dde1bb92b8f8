// A recorded scan as a sweep for localization, by what is known of the recording.
#pragma once
#include <string>

#include "core_stack/localization/sweep.h"
#include "plugins/replay/recording_info.h"
#include "plugins/replay/scan_files/scan.h"
#include "plugins/replay/sensor_stream.h"

namespace karst::replay {

/// Names a scan in errors: its file, and the place in it ("" for a file of one scan).
struct ScanPlace {
  std::string file, place;
};

/// Assigns rings, and times relative to the end of the sweep, which becomes the stamp; orders the points by
/// ring, and by time within it (by azimuth where there is no time). Throws InputError where `info` does not
/// fit.
core::Sweep sweep_of(Scan scan, core::TimeNs stamp, const ScanPlace& place, const RecordingInfo& info,
                     const RecordingLayout& layout, ReadNotes* notes);

}  // namespace karst::replay
