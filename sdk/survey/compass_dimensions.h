// Left, right, up and down in Compass's survey files, which cavern does not pass on.
//
// Source: L. Fish, Compass Survey Data File Format: rows of FROM TO LENGTH BEARING INC LEFT UP DOWN RIGHT,
// lengths in feet, surveys apart by form feeds.
#pragma once
#include <string>
#include <vector>

#include "sdk/survey/source_log.h"
#include "sdk/survey/survey.h"

namespace karst::survey {

struct CompassDimensions {
  std::string from, to;  // of the leg that they were noted with
  bool at_end = false;   // at its second station
  Dimensions dimensions;
  std::uint32_t series = 0;  // the survey
  Source source;
};

/// Of a .dat file, or of those that a .mak file names. A row that is none of the format is left out:
/// cavern says what is wrong with it. A file that is named and missing is noted.
std::vector<CompassDimensions> read_compass_dimensions(const std::string& file, SourceLog& log);

/// Adds them as sections. Left and right are as seen along the leg.
void add_compass_sections(const std::vector<CompassDimensions>& dimensions, Survey& survey);

}  // namespace karst::survey
