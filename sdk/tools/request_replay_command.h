// `karst policy replay`: recorded requests put to a policy once more, without a vehicle.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

/// Adds `replay` to `karst policy`.
void add_request_replay_command(CLI::App& policy);

}  // namespace karst::tools
