// Predicts the quality of a radio link between two positions from the map, for choosing a landing site before
// any radio is there.
#pragma once
#include "core_stack/common/options.h"
#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core {

/// The log-distance path loss in air, plus a loss for each metre that the map does not show as free. The
/// radio's parameters are known before a mission; links measured in flight (RelayGraph) override the
/// estimate.
struct LinkEstimateOptions {
  double range_m = 50;  // in free air
  double path_loss_exponent = 2.0;
  double rock_db_per_m = 3.0;  // 0: distance alone decides
  double spare_db = 2.0;       // margin required of a usable link
};
void describe(OptionTable& t, LinkEstimateOptions& o);

/// Length of the segment in cells not known to be free: unknown counts as rock.
double not_free_m(const VoxelMap& map, const Vec3& a, const Vec3& b);

/// Link margin in dB above the receiver's need, less spare_db; negative: the link is not usable.
double expected_margin_db(const VoxelMap& map, const Vec3& a, const Vec3& b, const LinkEstimateOptions& o);

}  // namespace karst::core
