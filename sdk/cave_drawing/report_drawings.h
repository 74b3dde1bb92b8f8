// The drawings of a run as its report shows them.
#pragma once
#include <filesystem>

#include "sdk/evaluation/report/report_drawings.h"

namespace karst::cave_drawing {

/// Of the run's own map, on A4. What cannot be drawn costs no report: a note says why. Never throws
/// core::InputError.
evaluation::ReportDrawings report_drawings(const std::filesystem::path& run);

}  // namespace karst::cave_drawing
