// report.html of a team: all vehicles in one view over time, and the base's knowledge. docs/report.md
#pragma once
#include "sdk/evaluation/team/team_record.h"

namespace karst::evaluation {

/// All data shown on the page, as one JSON object in the form of report_data().
nlohmann::ordered_json team_report_data(const TeamRecord& team, const nlohmann::ordered_json& metrics);

/// The complete page with scripts, styles and data; it loads no other files.
std::string team_report_page(const nlohmann::ordered_json& data);

/// Writes report.html into the team's run directory. Throws InputError if writing fails.
void write_team_report(const TeamRecord& team, const nlohmann::ordered_json& metrics);

/// Writes run_dir/report.html from the files of the run directory, including the team's metrics.json. Throws
/// InputError like read_team(), or if the file cannot be written.
void write_team_report(const std::filesystem::path& run_dir);

}  // namespace karst::evaluation
