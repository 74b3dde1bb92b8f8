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

/// No slip in a reading moves the end of a traverse by more than twice its length; a fix or an equate of the
/// wrong station does. Below 20 m, it may be a coarse fix of an entrance.
constexpr double kTorn = 2, kTorn_m = 20;

/// Throws core::InputError naming the first leg of a traverse whose error is beyond these.
void refuse_torn_loops(const Survey& survey);

}  // namespace karst::survey
