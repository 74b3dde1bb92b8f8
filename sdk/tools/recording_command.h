// karst recording info: what a bag contains.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

void add_recording_command(CLI::App& app);

}  // namespace karst::tools
