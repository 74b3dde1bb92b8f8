// `karst draw`: plan, extended profile and projected profile of a cave.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

void add_draw_command(CLI::App& app);

}  // namespace karst::tools
