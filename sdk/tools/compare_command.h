// `karst compare`: flies contestants through caves and reports which is better; `karst results`: shows a
// campaign's results.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

void add_compare_command(CLI::App& app);
void add_trials_command(CLI::App& app);
void add_results_command(CLI::App& app);

}  // namespace karst::tools
