// The report's page, styles and scripts, compiled in: the installed program needs no files beside it.
#pragma once
#include <string_view>
#include <vector>

namespace karst::evaluation {

std::string_view report_template();
std::string_view report_style();
std::vector<std::string_view> report_libraries();  // three.js and Chart.js, as Debian packages them
std::vector<std::string_view> report_scripts();    // ours, in the order they must run

}  // namespace karst::evaluation
