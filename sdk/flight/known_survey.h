// Reads the survey that a mission names, for the core: what is known of the cave before the flight.
#pragma once
#include <functional>
#include <string>

#include "sdk/flight/mission_file.h"

namespace karst::flight {

/// The mission with its survey read, and survey.offset as it is used. The same mission if it names none.
/// `note` gets sentences on how the survey lies in the cave, and on what is doubtful of it.
/// Throws core::InputError on a survey that cannot be read, that has no passage, of which it is not known
/// where it lies, or that contradicts the stations of the cave.
Mission with_survey(Mission mission, const std::function<void(const std::string&)>& note = {});

}  // namespace karst::flight
