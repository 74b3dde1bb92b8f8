// Completes a run directory after the flight: the metrics against ground truth, and the report.
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core_stack/vehicle/mesh_keys.h"

namespace karst::flight {

enum class Report { written, none };

struct Finishing {
  std::string cave, start;  // "" if the cave is not known: metrics that need it are null
  Report report = Report::written;
  std::filesystem::path cave_cache = {};  // folder for data common to all flights of a cave; "": no cache
  core::MeshKeys mesh = {};               // of a cave that is a bare mesh
  std::string problem = {};               // why the cave is not known; finish_run reports it
};

/// As mission.info says, with the problem if it is not there or damaged.
Finishing recorded_finishing(const std::filesystem::path& run_dir, Report report);

/// Completes a run with the ground truth that the vehicle's own process wrote into `truth` (karst vehicle
/// serve), and evaluates it again. Throws core::InputError if that folder has none or that of
/// another flight (truth_of_flight.h), or the run has other truth already.
void take_truth(const std::filesystem::path& run_dir, const std::filesystem::path& truth, Report report);

/// Writes metrics.json and, if asked, report.html into a run directory; returns the metrics.
nlohmann::json finish_run(const std::filesystem::path& run_dir, const Finishing& how);

/// The same for a team whose robots' runs are finished: adds the metrics of the merged map to `metrics`, and
/// writes metrics.json, telemetry.csv (the team's volume over time) and, if asked, report.html.
void finish_team(const std::filesystem::path& run_dir, const Finishing& how, nlohmann::ordered_json& metrics);

}  // namespace karst::flight
