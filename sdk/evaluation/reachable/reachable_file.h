// What can be reached in a cave, kept in a file: the same for all flights of a cave, and seconds of work in
// a large one.
#pragma once
#include <filesystem>

#include "sdk/evaluation/reachable/reachable.h"

namespace karst::evaluation {

/// find_reachable(), or what an earlier call for the same mesh, start and options left in `folder`. A file
/// that is damaged or of something else is not used; one that cannot be written is done without. Several
/// processes may do the same at once. With an empty `folder` nothing is kept.
Reachable find_reachable_once(const cave::TriangleMesh& mesh, const core::Vec3& start,
                              const ReachableOptions& options, const std::string& name,
                              const std::filesystem::path& folder);

}  // namespace karst::evaluation
