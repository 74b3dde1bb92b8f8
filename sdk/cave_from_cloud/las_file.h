// LAS 1.0 to 1.4 (ASPRS, LAS Specification): the coordinates of the points, for all point formats, 0 to 10.
#pragma once
#include <cstddef>
#include <string>

#include "plugins/replay/scan_files/fields.h"

namespace karst::from_cloud {

/// Gives x, y and z of each point to `sink`. Returns the number of points that the file marks as withheld,
/// which means deleted; the sink does not get them. Throws InputError naming file, place and reason; a
/// compressed file (LAZ) is refused. Reads piece by piece.
std::size_t read_las(const std::string& path, replay::PointSink& sink);

}  // namespace karst::from_cloud
