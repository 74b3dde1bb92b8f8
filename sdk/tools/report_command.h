// `karst report RUN`: evaluates a run directory again and rewrites its metrics.json and report.html, or
// writes the report of a campaign.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

void add_report_command(CLI::App& app);

}  // namespace karst::tools
