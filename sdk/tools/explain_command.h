// `karst explain RUN --at 1:34`: why the vehicle flew to this goal.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

void add_explain_command(CLI::App& app);

}  // namespace karst::tools
