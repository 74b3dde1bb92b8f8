// What of a survey looks like a blunder: loops that do not close, and readings far beyond the usual.
#pragma once
#include <string>
#include <vector>

#include "sdk/survey/survey.h"

namespace karst::survey {

/// Surveys by compass and tape close to 1 or 2 %. Beyond 5 % and three standard deviations, which noise
/// exceeds once in 300 loops or less, a reading or an equate is wrong.
constexpr double kWrongLoop_percent = 5, kWrongLoop_sigmas = 3;
/// Tapes are 30 to 50 m long, and laser meters for caves reach 50 to 100 m.
constexpr double kLongLeg_m = 100;
/// Few chambers are wider. Decimetres, or a decimal point that was left out, are more common.
constexpr double kFarWall_m = 50;

/// A sentence for each kind, with the worst case and its place; empty if nothing looks wrong. Of legs and
/// sections underground only.
std::vector<std::string> survey_checks(const Survey& survey);

/// Beyond twice the length of the legs between two fixed stations, and 20 m, no reading is to blame but a
/// fix. Coordinates of entrances may be coarse: 20 m are not much for them.
constexpr double kWrongFix = 2, kWrongFix_m = 20;

/// Throws core::InputError naming the first leg of a traverse between two fixed stations whose error is
/// beyond these, and beyond what the standard deviations given with the fixes allow.
void refuse_contradictory_fixes(const Survey& survey);

}  // namespace karst::survey
