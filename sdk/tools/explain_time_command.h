// `karst explain-time RUN...`: what a flight lost time for.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

void add_explain_time_command(CLI::App& app);

}  // namespace karst::tools
