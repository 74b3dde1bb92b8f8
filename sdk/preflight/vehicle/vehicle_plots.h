// Drawings of the checklist page, as SVG.
#pragma once
#include <string>

#include "sdk/preflight/vehicle/measurements.h"

namespace karst::preflight {

/// Messages in each second, of what each sensor should send; "" if nothing came.
std::string rates_svg(const VehicleMeasurements& m);

/// How fast the vehicle turned, by the LiDAR and by the gyroscope; "" without a motion.
std::string turns_svg(const VehicleMeasurements& m);

/// A scan from above, forward is up, with the hull and the room that it needs; "" without one.
std::string pad_svg(const VehicleMeasurements& m);

}  // namespace karst::preflight
