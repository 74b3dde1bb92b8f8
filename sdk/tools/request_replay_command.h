// `karst policy replay`: sends recorded requests to a policy again, without a vehicle.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

/// Adds `replay` to `karst policy`.
void add_request_replay_command(CLI::App& policy);

}  // namespace karst::tools
