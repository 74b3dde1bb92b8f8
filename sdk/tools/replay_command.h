// `karst replay SCANS --out DIR`: localization and mapping on recorded scans.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

void add_replay_command(CLI::App& app);

}  // namespace karst::tools
