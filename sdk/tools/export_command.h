// `karst export`: writes what a flight found for other programs.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

void add_export_command(CLI::App& app);

}  // namespace karst::tools
