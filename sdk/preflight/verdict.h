// Go or no-go, and what to watch for. The rules and their thresholds: docs/preflight.md.
#pragma once
#include <string>
#include <vector>

#include "sdk/preflight/preflight.h"

namespace karst::preflight {

enum class Severity { no_go, watch };
constexpr auto names_of(Severity) {
  using enum Severity;
  return std::to_array<core::Named<Severity>>({{no_go, "no_go"}, {watch, "watch"}});
}

struct Finding {
  Severity severity = Severity::watch;
  Subject subject = Subject::cave;
  std::string text;  // without a full stop
};

constexpr double kNarrowFraction = 0.01;  // of the space that the hull alone could reach
constexpr double kBlindFraction = 0.01;   // of the places
constexpr double kLowConfidence = 0.6;    // below it another policy wins in two of five resamplings
constexpr double kMuchCoverage = 0.9;     // expected; below it the cave is larger than the flight explores
constexpr double kNearHole_m = 10;        // from the start
constexpr double kOtherHorizon = 0.1;     // relative difference from the flights of the experience

/// Reasons against the mission first, then what to watch for.
std::vector<Finding> findings_of(const Preflight& preflight);

/// Whether none of the findings speaks against the mission.
bool is_go(const std::vector<Finding>& findings);

}  // namespace karst::preflight
