// What a run directory gets after the flight: the figures against ground truth, and the report.
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace karst::flight {

enum class Report { written, none };

struct Finishing {
  std::string cave, start;  // "" when the cave is not known: what needs it is null
  Report report = Report::written;
  std::filesystem::path cave_cache = {};  // keeps what is the same for all flights of a cave; "": nowhere
};

/// Writes metrics.json and, if asked, report.html into a run directory; returns the metrics.
nlohmann::json finish_run(const std::filesystem::path& run_dir, const Finishing& how);

/// The same of a team whose robots' runs are finished: adds to `metrics` what the merged map says, and writes
/// metrics.json, telemetry.csv (the team's volume over time) and, if asked, report.html.
void finish_team(const std::filesystem::path& run_dir, const Finishing& how, nlohmann::ordered_json& metrics);

}  // namespace karst::flight
