// `policy { name auto }`: the policy is selected at mission start, from what is known of the cave beforehand.
//
//   policy {
//     name auto
//     auto {
//       description known.info        ; figures a caver gives, or the map of an earlier flight (.bt, .ot)
//       survey cave.ply               ; instead: a survey of the cave, a mesh or a cave's .info file
//       survey_start "1 2 1.5"        ; of a mesh
//       results mine.info             ; results of earlier flights; default: the installed ones
//       metric coverage_auc
//       otherwise nearest_frontier    ; if nothing similar was flown; without it the mission is refused
//       cave { name maze1  policy unknown_ratio  parameters { ratio_worth "8 m" } }   ; fixed choices, any
//       cave { name sump   preset tuned.info }                                        ; number of blocks
//     }
//   }
//
// A cave's name is that of its file without folder and extension. The simulator's cave file is never read
// unless it is given as the survey. All keys: auto_options.h.
#pragma once
#include "sdk/flight/mission_file.h"
#include "sdk/selection/condition.h"

namespace karst::flight {

inline constexpr const char* kAutoPolicy = "auto";

/// The conditions of a mission that a selection depends on, as far as it states them: a vehicle that is not
/// simulated has no name here.
selection::AskedConditions conditions_of(const Mission& mission);

/// If the mission asks for `auto`, sets its policy, the policy's parameters and the reason
/// (`policy_selection`). Throws InputError naming file, key and reason, also if nothing is known of the cave,
/// or if nothing similar was flown.
void choose_policy(Mission& mission);

}  // namespace karst::flight
