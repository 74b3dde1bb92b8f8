// What is known of a mission before it is flown: the values that `karst preflight` judges and prints
// (docs/preflight.md).
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core_stack/common/enum_names.h"
#include "core_stack/common/geometry.h"
#include "sdk/preflight/plan_view.h"
#include "sdk/preflight/time_budget.h"
#include "sdk/selection/cave_facts.h"
#include "sdk/selection/cave_figures.h"

namespace karst::preflight {

/// What a finding is about.
enum class Subject { cave, start, hole, passages, climbs, time, policy, confidence, coverage };
constexpr auto names_of(Subject) {
  using enum Subject;
  return std::to_array<core::Named<Subject>>({{cave, "cave"},
                                              {start, "start"},
                                              {hole, "hole"},
                                              {passages, "passages"},
                                              {climbs, "climbs"},
                                              {time, "time"},
                                              {policy, "policy"},
                                              {confidence, "confidence"},
                                              {coverage, "coverage"}});
}

/// Why a check that `karst fly` makes as well refuses the mission.
struct Refusal {
  Subject subject = Subject::cave;
  std::string reason;
};

struct VehicleFacts {
  std::string name;
  double radius_m = 0;                          // of the hull
  double clearance_m = 0;                       // least distance of its paths to rock
  double looks_up_rad = 0, looks_down_rad = 0;  // the steepest directions that its sensors see
};

/// A loop of open edges of the mesh that encloses more than a slit.
struct Hole {
  core::Vec3 centre = core::Vec3::Zero();
  double diameter_m = 0;
  double distance_m = 0;  // from the start to the hole's edge
};

struct CaveFacts {
  selection::CaveFigures figures;
  selection::PassageFacts passages;
  core::Vec3 start = core::Vec3::Zero();
  double start_clearance_m = 0;
  double explorable_m3 = 0;         // what coverage is measured by, as in `karst cave info`
  double reachable_m3 = 0;          // with the vehicle's clearance
  double hull_reachable_m3 = 0;     // of a vehicle that needs no more room than its hull
  double blind_climb_fraction = 0;  // of the places, those to which only climbs lead that no sensor covers
  std::string blind_climb;          // the first of these climbs; "" if there is none
  std::vector<Hole> holes;          // nearest first
  PlanView plan;
};

struct ExpectedFigure {
  std::string metric, unit;
  double value = selection::kUnknown;
};

struct RankedPolicy {
  std::string name;  // of the contestant
  double expected = selection::kUnknown, low = selection::kUnknown, high = selection::kUnknown;
};

struct PolicyFacts {
  std::string policy;
  std::vector<std::pair<std::string, std::string>> parameters;
  std::vector<std::pair<std::string, std::string>> changed;  // of those selected: what is not the default
  bool selected = false;                                     // for this cave
  bool fallback = false;                    // nothing could be selected; neither: named by the user
  std::string reason;                       // of the selection, or why nothing is expected
  std::string metric;                       // by which policies are ranked
  double level = 0.9;                       // of the intervals
  double confidence = selection::kUnknown;  // share of resamplings in which the first of the ranking is first
  std::string confidence_words;             // the same, and how far to trust it
  double horizon_s = selection::kUnknown;   // the longest exploration of the flights it rests on
  std::vector<RankedPolicy> ranking;        // best first; empty if nothing is expected
  std::optional<std::size_t> own;           // place of this policy in the ranking
  std::vector<ExpectedFigure> expected;     // of this policy, in the time that this flight has
};

struct Preflight {
  std::string cave_file;
  std::vector<std::string> mesh_notes;  // what the mesh suggests though it can be flown in
  std::vector<Refusal> refusals;
  std::optional<VehicleFacts> vehicle;
  std::optional<CaveFacts> cave;
  std::optional<TimeBudget> time;
  std::optional<PolicyFacts> policy;
};

/// The expected value of a metric; NaN if it is not known.
double expected_value(const PolicyFacts& policy, const std::string& metric);

}  // namespace karst::preflight
