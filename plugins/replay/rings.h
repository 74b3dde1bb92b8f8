// Which ring each point of a scan belongs to, where the file does not say.
#pragma once
#include "plugins/replay/recording_info.h"
#include "plugins/replay/scan.h"

namespace karst::replay {

/// The nearest of the rings spread evenly between the lowest and the highest elevation, the highest being 0.
/// Points more than a ring's spacing above or below all rings are left out.
void rings_by_elevation(Scan& scan, const RecordingInfo& info);

/// The file holds ring after ring, each once around, as KITTI's does: a new ring begins where the azimuth
/// comes round to where the first point was, after it has been on the other side.
void rings_by_order(Scan& scan);

}  // namespace karst::replay
