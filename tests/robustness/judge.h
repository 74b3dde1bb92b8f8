// What became of a trial, by the simulator's ground truth and the way its process ended.
#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "sdk/evaluation/record/run_record.h"
#include "sdk/host/isolation/process.h"

namespace karst::robustness {

/// From best to worst. The first two are what a flight may end in.
enum class Outcome {
  home,        // it stands within 1 m of its start, level and up or down, and touched nothing
  elsewhere,   // it stands somewhere else, and touched nothing
  stalled,     // it landed, but once kept within 0.5 m of a place for more than 15 s of a phase in the air
  in_the_air,  // its process ended before the vehicle stood
  contact,     // it touched rock other than by landing
  no_exit,     // its process did not end in time
  not_flown    // there is no record, or karst refused it
};
inline constexpr std::array kOutcomes{Outcome::home,       Outcome::elsewhere, Outcome::stalled,
                                      Outcome::in_the_air, Outcome::contact,   Outcome::no_exit,
                                      Outcome::not_flown};
const char* name_of(Outcome outcome);
inline bool is_bad(Outcome outcome) { return outcome > Outcome::elsewhere; }

constexpr double kAtHome_m = 1, kStallRadius_m = 0.5, kStall_s = 15;

struct Verdict {
  Outcome outcome = Outcome::not_flown;
  std::optional<double> least_clearance_m;  // of the hull from rock, between take-off and landing
  double stall_s = 0;                       // longest_stall_s
  double in_air_s = 0;
  std::string reason;
};

/// The longest time between take-off and landing, in one phase of the mission, within kStallRadius_m of one
/// true place: the clock starts again where the vehicle has come farther than that from where it started
/// last, and with each phase. A vehicle that is blind may stand for 10 s (safety.blind_home) before it goes
/// home.
double longest_stall_s(const evaluation::RunRecord& run);

/// One vehicle's.
Verdict judge_vehicle(const evaluation::RunRecord& run);

/// A run directory's, of one vehicle or a team: the worst of them.
Verdict judge(const std::filesystem::path& run_dir, const host::ProcessEnd& end);

}  // namespace karst::robustness
