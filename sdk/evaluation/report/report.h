// report.html: one file that shows a run, in 3D over time and in plots. docs/report.md
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "sdk/evaluation/record/run_record.h"

namespace karst::evaluation {

/// All the page shows, as one JSON object; large arrays are base64 of little-endian numbers.
nlohmann::ordered_json report_data(const RunRecord& run, const nlohmann::ordered_json& metrics);

/// The page with scripts, styles and data inside; it loads nothing from anywhere.
std::string report_page(const nlohmann::ordered_json& data);

/// Writes run_dir/report.html from what lies in the run directory; uses its metrics.json if there is one.
/// A run cut short gives a report of what there is. Throws InputError if `run_dir` is no directory or the
/// file cannot be written.
void write_report(const std::filesystem::path& run_dir);

}  // namespace karst::evaluation
