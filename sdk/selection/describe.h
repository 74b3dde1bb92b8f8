// Computes the figures of a cave from a file.
#pragma once
#include <string>

#include "sdk/selection/cave_figures.h"
#include "sdk/selection/free_space.h"

namespace karst::selection {

/// The figures of the passages, from their centre lines (passage_graph.h).
CaveFigures describe(const FreeSpace& space);

enum class Source { mesh, map, numbers };
struct Description {
  CaveFigures figures;
  Source source;
};

/// The kind of `file`: a mesh or a cave's .info file (with its start, unless `start` gives another), the map
/// of a flight (.bt, .ot), or an INFO file of figures. Throws InputError.
Source source_of(const std::string& file);
Description describe_file(const std::string& file, const std::string& start,
                          const FreeSpaceOptions& options = {});

}  // namespace karst::selection
