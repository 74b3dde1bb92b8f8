// Reads the survey that a mission names, for the core: what is known of the cave before the flight.
#pragma once
#include "sdk/flight/mission_file.h"

namespace karst::flight {

/// The mission with its survey read, and survey.offset as it is used. The same mission if it names none.
/// Throws core::InputError on a survey that cannot be read, that has no passage, or of which it is not known
/// where it lies.
Mission with_survey(Mission mission);

}  // namespace karst::flight
