// Cache of the reachable space of a cave in a file: it is the same for all flights in a cave, and takes
// seconds to compute for a large one.
#pragma once
#include <filesystem>

#include "sdk/evaluation/reachable/reachable.h"

namespace karst::evaluation {

/// find_reachable(), or the result that an earlier call for the same mesh, start and options stored in
/// `folder`. A file that is damaged or belongs to other inputs is ignored; a file that cannot be written is
/// not an error. Safe for concurrent processes. With an empty `folder` nothing is stored.
Reachable find_reachable_once(const cave::TriangleMesh& mesh, const core::Vec3& start,
                              const ReachableOptions& options, const std::string& name,
                              const std::filesystem::path& folder);

}  // namespace karst::evaluation
