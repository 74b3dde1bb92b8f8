// `karst evaluate RUN`: trajectory and map errors of a run.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

void add_evaluate_command(CLI::App& app);

}  // namespace karst::tools
