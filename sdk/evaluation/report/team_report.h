// report.html of a team: all vehicles in one view over time, and what the base knew when. docs/report.md
#pragma once
#include "sdk/evaluation/team/team_record.h"

namespace karst::evaluation {

/// All the page shows, as one JSON object in the manner of report_data().
nlohmann::ordered_json team_report_data(const TeamRecord& team, const nlohmann::ordered_json& metrics);

/// The page with scripts, styles and data inside; it loads nothing from anywhere.
std::string team_report_page(const nlohmann::ordered_json& data);

/// Writes report.html into the team's run directory. Throws InputError if it cannot.
void write_team_report(const TeamRecord& team, const nlohmann::ordered_json& metrics);

/// Writes run_dir/report.html from what lies in the run directory, the team's metrics.json among it. Throws
/// InputError where read_team() does, or if the file cannot be written.
void write_team_report(const std::filesystem::path& run_dir);

}  // namespace karst::evaluation
