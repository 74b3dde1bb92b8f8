// Which way a surveyor looked who noted left and right.
#pragma once
#include "sdk/survey/survey.h"

namespace karst::survey {

/// Sets Section::facing of the sections of each run, by the directions of the legs of that run before and
/// behind; sections of a run without legs look along the line of their stations. Sections of a run must stand
/// together, those of legs in the order of the legs.
void set_facings(Survey& survey);

}  // namespace karst::survey
