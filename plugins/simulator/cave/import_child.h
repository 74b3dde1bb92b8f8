// Importing a mesh in a separate process.
//
// The importer recurses along a Collada scene graph, which may contain itself or multiply at each level, and
// ends the program on some damaged files. In a child process this results in an error message only.
#pragma once
#include <functional>
#include <string>

#include "plugins/simulator/cave/triangle_mesh.h"

namespace karst::cave {

struct ImportLimits {
  std::uint64_t memory_bytes = 0;  // beyond what this process has; 0: 2 GiB, or more for a large file
  std::uint64_t cpu_s = 0;         // 0: 5 s, and 10 s for each megabyte of the file
  int silence_s = 900;             // of the child, wall clock; beyond it the child hangs
};

/// How a refusal names what the child does, and the child.
struct ImportWords {
  const char* failed = "is no mesh that can be read";
  const char* worker = "the importer";
};

/// Runs `import` in a child process and returns its mesh or throws its InputError; a child that crashes or
/// exceeds a limit is an InputError, too. Indices and coordinates are checked here: the child is not trusted.
TriangleMesh import_in_child(const std::string& path, const std::function<TriangleMesh()>& import,
                             ImportLimits limits = {}, const ImportWords& words = {});

}  // namespace karst::cave
