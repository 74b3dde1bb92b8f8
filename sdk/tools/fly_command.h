// `karst fly`: one mission, from the mission file to the report.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

void add_fly_command(CLI::App& app);

}  // namespace karst::tools
