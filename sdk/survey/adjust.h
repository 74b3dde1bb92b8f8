// Closes the loops of readings by the least squares of cavern.
#pragma once
#include "sdk/survey/readings.h"
#include "sdk/survey/survey.h"

namespace karst::survey {

/// Throws core::InputError naming file and line where cavern refuses a reading, or if it is not installed.
Survey adjusted(Readings readings);

}  // namespace karst::survey
