// `policy { name auto }`: the policy is selected at mission start, from what is known of the cave beforehand.
//
//   policy {
//     name auto
//     auto {
//       description known.info        ; figures a caver gives, or the map of an earlier flight (.bt, .ot)
//       survey cave.ply               ; instead: a survey of the cave, a mesh or a cave's .info file
//       survey_start "1 2 1.5"        ; of a mesh
//       results mine.info             ; what policies are known by; default: what is installed
//       metric coverage_auc
//       otherwise nearest_frontier    ; if nothing similar was flown; without it the mission is refused
//       cave { name maze1  policy unknown_ratio  parameters { ratio_worth "8 m" } }   ; settled: any number
//       of these cave { name sump   preset tuned.info }
//     }
//   }
//
// A cave's name is that of its file without folder and ending. The simulator's cave is never looked at unless
// it is named as the survey.
#pragma once
#include "sdk/flight/mission_file.h"

namespace karst::flight {

inline constexpr const char* kAutoPolicy = "auto";

/// Gives the mission a policy with its parameters, and the reason (`policy_selection`), if it asks for
/// `auto`. Throws InputError naming file, key and reason: also if nothing is known of the cave, and if
/// nothing similar was flown.
void choose_policy(Mission& mission);

}  // namespace karst::flight
