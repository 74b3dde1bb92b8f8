// loops.csv: the loop closures of a replay.
#pragma once
#include <filesystem>

#include "core_stack/loops/loop_closing.h"

namespace karst::replay {

/// One line for each closure, used or not; docs/loops.md describes the columns. Stamps are those of the
/// recording: `origin` is added. Throws InputError if the file cannot be written.
void write_loops(const std::filesystem::path& file, const core::LoopClosing& loops, core::TimeNs origin);

}  // namespace karst::replay
