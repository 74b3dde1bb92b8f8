// Coordinate systems in degrees, which a survey in metres cannot lie in.
#pragma once
#include <string>

namespace karst::survey_export {

/// Whether a name of Survex or Therion is that of latitude and longitude: "lat-long", "long-lat",
/// "EPSG:4326", "ESRI:104000". Of EPSG's and ESRI's codes, it knows the ranges that hold no system in metres
/// (PROJ 9.1): 9 in 10 of the geographic ones. Others are for Survex to refuse.
bool is_geographic(const std::string& system);

}  // namespace karst::survey_export
