// `karst compare`: fly contestants through caves and say which is better; `karst results`: what a campaign
// found.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

void add_compare_command(CLI::App& app);
void add_trials_command(CLI::App& app);
void add_results_command(CLI::App& app);

}  // namespace karst::tools
