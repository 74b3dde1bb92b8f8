// The components of one vehicle that all parts of a mission use.
#pragma once
#include "core_stack/common/lane_bound.h"
#include "core_stack/mission/flight/flight.h"
#include "core_stack/mission/flight/trusted_speeds.h"
#include "core_stack/mission/onboard/explorer.h"
#include "core_stack/mission/recording/recorder.h"
#include "core_stack/mission/state/load_shedding.h"

namespace karst::core {

struct Onboard {
  Onboard(const CoreOptions& o, const VehicleDescription& description, Executive& e, Recorder& r,
          PolicyPort& policy)
      : options(as_flown(o, description)),
        vehicle(description),
        executive(e),
        recorder(r),
        flight(options, description),
        map(e, Lane::map, options, description, policy),
        load({.maps_scans = description.lidar != nullptr,
              .locates_scans = description.lidar && o.localization.source == PoseSource::lidar,
              .depth_images = !description.cameras.empty(),
              .pictures = description.rgb != nullptr}) {}

  TimeNs now() const { return executive.now(); }

  const CoreOptions options;
  const VehicleDescription vehicle;
  Executive& executive;
  Recorder& recorder;
  Flight flight;
  LaneBound<Explorer> map;  // on the map lane
  LoadShedding load;        // what is left out while a lane is late
};

}  // namespace karst::core
