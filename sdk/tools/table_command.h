// `karst table RUN...`: the figures of many runs, one line each.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

void add_table_command(CLI::App& app);

}  // namespace karst::tools
