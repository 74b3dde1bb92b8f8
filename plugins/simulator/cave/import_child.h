// Importing a mesh in a process of its own.
//
// The importer recurses along a Collada scene graph, which may contain itself or multiply at each level, and
// ends the program on some damaged files. In a child this costs a message.
#pragma once
#include <functional>
#include <string>

#include "plugins/simulator/cave/triangle_mesh.h"

namespace karst::cave {

struct ImportLimits {
  std::uint64_t memory_bytes = 0;  // beyond what this process has; 0: 2 GiB, or more for a large file
  unsigned cpu_s = 600;
};

/// What `import` makes of the file, or its InputError. It runs in a child, whose limits or whose death become
/// an InputError too. Indices and coordinates are checked here: a child that went wrong may say anything.
TriangleMesh import_in_child(const std::string& path, const std::function<TriangleMesh()>& import,
                             ImportLimits limits = {});

}  // namespace karst::cave
