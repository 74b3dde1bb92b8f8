// The reports' pages, styles and scripts, compiled in: the installed program needs no files beside it.
#pragma once
#include <string_view>
#include <vector>

namespace karst::evaluation {

// Used by every page.
std::string_view page_style();
std::vector<std::string_view> three_library();  // three.js, as Debian packages it
std::vector<std::string_view> page_scripts();   // in order of execution

// The page of a run.
std::string_view report_template();
std::vector<std::string_view> chart_library();  // Chart.js, likewise
std::vector<std::string_view> report_scripts();
std::vector<std::string_view> team_report_scripts();  // for the same page, of a team

}  // namespace karst::evaluation
