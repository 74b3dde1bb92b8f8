// cavern's .err file: how far the legs between two junctions had to move.
#pragma once
#include <filesystem>
#include <vector>

#include "sdk/survey/survey.h"

namespace karst::survey {

/// The largest error first. No file, or one without a loop, gives none.
std::vector<Loops::Traverse> read_err_file(const std::filesystem::path& file);

}  // namespace karst::survey
