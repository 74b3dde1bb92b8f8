// Surveys that Survex reads itself: its own files, and those of Compass.
#pragma once
#include <string>

#include "sdk/survey/survey.h"

namespace karst::survey {

/// A survey that cavern processes first: .svx, .dat, .mak. What cavern warns of becomes a note.
Survey read_by_cavern(const std::string& file);

/// A processed one: .3d, .plt. Legs meet where their ends have the same coordinates, to the centimetre.
Survey read_processed(const std::string& file);

}  // namespace karst::survey
