// report.html: one file that shows a run in 3D over time and in plots. docs/report.md
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "sdk/evaluation/record/run_record.h"
#include "sdk/evaluation/report/report_drawings.h"

namespace karst::evaluation {

/// All data shown on the page, as one JSON object; large arrays are base64 of little-endian numbers.
nlohmann::ordered_json report_data(const RunRecord& run, const nlohmann::ordered_json& metrics);

/// The complete page with scripts, styles and data; it loads no other files.
std::string report_page(const nlohmann::ordered_json& data);

/// Writes run_dir/report.html from the files of the run directory; uses its metrics.json if there is one.
/// A truncated run gives a report of its readable part. Without drawings and note the page does not speak of
/// drawings. Throws InputError if `run_dir` is not a directory or the file cannot be written.
void write_report(const std::filesystem::path& run_dir, const ReportDrawings& drawings = {});

}  // namespace karst::evaluation
