// From a file to what a cave is like.
#pragma once
#include <string>

#include "sdk/selection/cave_figures.h"
#include "sdk/selection/free_space.h"

namespace karst::selection {

/// The passages' figures, of their centre lines (passage_graph.h).
CaveFigures describe(const FreeSpace& space);

enum class Source { mesh, map, numbers };
struct Description {
  CaveFigures figures;
  Source source;
};

/// What `file` is: a mesh or a cave's .info file (its start, unless `start` says another), the map of a
/// flight (.bt, .ot), or an INFO file of figures. Throws InputError.
Source source_of(const std::string& file);
Description describe_file(const std::string& file, const std::string& start,
                          const FreeSpaceOptions& options = {});

}  // namespace karst::selection
