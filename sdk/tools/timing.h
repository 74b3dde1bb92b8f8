// timing.json: what depends on the machine, kept apart from metrics.json.
#pragma once
#include <filesystem>

#include "core_stack/common/executive.h"

namespace karst::tools {

void write_timing(const std::filesystem::path& run_dir, const core::Executive& executive, double wall_s);

}  // namespace karst::tools
