// `karst python`: Python with the module karst.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

void add_python_command(CLI::App& app);

}  // namespace karst::tools
