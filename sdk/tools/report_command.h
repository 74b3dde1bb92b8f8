// `karst report RUN`: evaluates a run directory again and rewrites its metrics.json and report.html, or
// writes the report of a campaign.
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace CLI {
class App;
}

namespace karst::tools {

void add_report_command(CLI::App& app);

/// Writes metrics.json and, if asked, report.html into a run directory; returns the metrics. `cave` and
/// `start` may be "" when the cave is not known: what needs it is null. What is the same for all flights of
/// a cave is kept in the folder `cave_cache`, if one is named.
nlohmann::json finish_run(const std::filesystem::path& run_dir, const std::string& cave,
                          const std::string& start, bool with_report,
                          const std::filesystem::path& cave_cache = {});

/// A line of the summary, if there were objects of interest to find.
void print_objects(const nlohmann::json& metrics);

/// The same of a team whose robots' runs are finished: adds to `metrics` what the merged map says, and writes
/// metrics.json, telemetry.csv (the team's volume over time) and, if asked, report.html.
void finish_team(const std::filesystem::path& run_dir, const std::string& cave, const std::string& start,
                 nlohmann::ordered_json& metrics, bool with_report,
                 const std::filesystem::path& cave_cache = {});

}  // namespace karst::tools
