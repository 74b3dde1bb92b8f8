// The survey of a flight as Therion reads it: the centreline (.th), what to make of it (.thconfig), and the
// wall mesh as an object `scan` (Therion 6.4), which ties it to the stations.
#pragma once
#include <string>

#include "sdk/survey_export/placing.h"

namespace karst::survey_export {

std::string therion_text(const FlownSurvey& flown, const Placing& placing);

/// Models of `file`, named as in the same folder without its ending: "OUT.th", for therion before 6.4.
std::string thconfig_text(const std::string& stem, const Placing& placing);

/// The centreline and the mesh "OUT.stl", which is in the frame of the map. Of many stations, a part ties it.
std::string scan_text(const FlownSurvey& flown, const std::string& stem);

}  // namespace karst::survey_export
