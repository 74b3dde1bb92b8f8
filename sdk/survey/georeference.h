// Where fixed stations lie on the plane, and how compass north turns into the plane's north.
#pragma once
#include <string>
#include <vector>

#include "sdk/survey/network.h"
#include "sdk/survey/readings.h"

namespace karst::survey {

struct Georeference {
  std::string system;               // of the plane, as Survex names it; empty: local coordinates
  std::vector<core::Vec3> fixes_m;  // of each of Network::fixes: east, north, up
  std::vector<double> turn_deg;     // of each of Readings::conditions: added to bearings
};

/// Local coordinates stay as they are. Those of a coordinate system are converted by cavern (which has PROJ),
/// to the system of the first fix, or to its UTM zone where that has latitude and longitude. Bearings turn by
/// the declination and, with a coordinate system, by the convergence of the meridians. Readings without a
/// declination get that of the International Geomagnetic Reference Field at the mean of the fixed stations,
/// at sea level, at their date; those without a date, that of the first year of the survey. All as Therion
/// does. Notes are added to the log.
Georeference georeference(Readings& readings, const Network& network);

}  // namespace karst::survey
