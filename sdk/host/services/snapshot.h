// The map behind a policy's handle, and the queries on it.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/planning/roadmap/work_budget.h"
#include "sdk/abi/karst_abi_services.h"
#include "sdk/host/services/passage_question.h"

namespace karst::host {

/// The core's map during one decide(), or a copy.
struct Snapshot {
  const core::VoxelMap* map = nullptr;
  std::uint64_t revision = 0;  // of the core's map, also for a copy
  std::unique_ptr<const core::VoxelMap> copy;
  core::Vec3 start = core::Vec3::Zero();  // of the mission
  // Shared with copies, which hold the same cells.
  std::shared_ptr<PassageQuestion> passages = std::make_shared<PassageQuestion>();
};

/// An independent map with the same classes and log-odds.
std::unique_ptr<Snapshot> copy_of(const Snapshot& original);

karst_map_info_t info_of(const Snapshot& s);
karst_ray_end_t cast_ray(const core::VoxelMap& map, const karst_segment_t& ray, bool through_unknown);
/// nullopt if the box holds 2^63 cells or more.
std::optional<karst_cell_counts_t> count_in_box(const core::VoxelMap& map, const karst_box_t& box);
std::vector<karst_vec3_t> surface_in_box(const core::VoxelMap& map, const karst_box_t& box);

/// Work of one query of distances to rock, in cells visited. About half a second.
constexpr std::uint64_t kMaxRockWork = 100'000'000;
/// Distance from p, which is within 100 km of the origin, to the centre of the nearest occupied cell;
/// `limit_m` if none is nearer. nullopt once `work` is exhausted.
std::optional<double> distance_to_rock(const core::VoxelMap& map, const core::Vec3& p, double limit_m,
                                       core::WorkBudget& work);

inline core::Vec3 to_core(const karst_vec3_t& v) { return {v.x, v.y, v.z}; }
inline karst_vec3_t to_abi(const core::Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace karst::host
