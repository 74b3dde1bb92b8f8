// The components of one vehicle that all parts of a mission use.
#pragma once
#include "core_stack/common/lane_bound.h"
#include "core_stack/mission/flight/flight.h"
#include "core_stack/mission/onboard/explorer.h"
#include "core_stack/mission/recording/recorder.h"

namespace karst::core {

/// The latency from a scan's arrival to its integration into the map.
constexpr TimeNs kMappingBudget = 60 * kMillisecond;

struct Onboard {
  Onboard(const CoreOptions& o, const VehicleDescription& description, Executive& e, Recorder& r,
          PolicyPort& policy)
      : options(o),
        vehicle(description),
        executive(e),
        recorder(r),
        flight(o, description),
        map(e, Lane::map, o, description, policy) {}

  TimeNs now() const { return executive.now(); }

  const CoreOptions options;
  const VehicleDescription vehicle;
  Executive& executive;
  Recorder& recorder;
  Flight flight;
  LaneBound<Explorer> map;  // on the map lane
};

}  // namespace karst::core
