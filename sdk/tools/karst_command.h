// The command line of `karst` with all its commands.
#pragma once
#include <memory>

namespace CLI {
class App;
}

namespace karst::tools {

std::shared_ptr<CLI::App> karst_command();

}  // namespace karst::tools
