// Reads a survey as cavers have it, its loops closed.
#pragma once
#include <string>

#include "sdk/survey/survey.h"

namespace karst::survey {

/// By the ending of the name: Therion (.th), Survex (.svx, .3d), Compass (.dat, .mak, .plt). Loops are closed
/// by the least squares of Survex, whose programs `cavern` and `dump3d` must be installed. Throws
/// core::InputError naming file, line and reason.
Survey read_survey(const std::string& file);

}  // namespace karst::survey
