// What a link between two places would be like, judged by the map: for choosing where to land, before anybody
// is there to be heard.
#pragma once
#include "core_stack/common/options.h"
#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core {

/// The log-distance law in air and a loss for each metre that the map does not show free. What radios are
/// like is known before a mission; what was heard in it (RelayGraph) overrules this where somebody was.
struct LinkEstimateOptions {
  double range_m = 50;  // in free air
  double path_loss_exponent = 2.0;
  double rock_db_per_m = 3.0;  // 0: distance alone decides
  double spare_db = 2.0;       // a link is counted on only with that much to spare
};
void describe(OptionTable& t, LinkEstimateOptions& o);

/// Length of the segment in cells that are not known to be free: unknown is taken for rock.
double not_free_m(const VoxelMap& map, const Vec3& a, const Vec3& b);

/// dB above what a receiver needs, spare_db taken off; below 0: not to be counted on.
double expected_margin_db(const VoxelMap& map, const Vec3& a, const Vec3& b, const LinkEstimateOptions& o);

}  // namespace karst::core
