// `karst cave describe`: the figures by which caves are compared.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

/// Adds `describe` to `karst cave`.
void add_cave_describe(CLI::App& cave);

}  // namespace karst::tools
