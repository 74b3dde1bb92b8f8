// `karst cave from-cloud`: makes a cave of the point cloud of a real one.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

/// `cave` is the command `karst cave`.
void add_from_cloud_command(CLI::App& cave);

}  // namespace karst::tools
