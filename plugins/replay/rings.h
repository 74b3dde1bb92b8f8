// Assigns each point of a scan to a ring if the file does not contain rings.
#pragma once
#include "plugins/replay/recording_info.h"
#include "plugins/replay/scan_files/scan.h"

namespace karst::replay {

/// Assigns the nearest of the rings spaced evenly between the lowest and highest elevation; the highest is 0.
/// Drops points more than a ring's spacing above or below all rings.
void rings_by_elevation(Scan& scan, const RecordingInfo& info);

/// For files that hold ring after ring, one turn each, as KITTI's do: a new ring begins where the azimuth
/// returns to that of the first point, after it has been on the other side.
void rings_by_order(Scan& scan);

}  // namespace karst::replay
