// The keys of a mission file that say where the vehicle may fly.
#pragma once
#include <memory>
#include <string>

#include "core_stack/common/options.h"
#include "core_stack/mapping/region/flight_region.h"

namespace karst::core {

/// A body is `box X Y Z X Y Z` (two opposite corners) or `polygon X Y X Y X Y ... [from LOW] [to HIGH]`.
struct RegionKeys {
  std::string keep_in;    // a body; "": everywhere
  std::string keep_out;   // bodies with | between them; "": none
  double max_home_m = 0;  // 0: no limit
  double margin_m = 0.5;

  bool empty() const { return keep_in.empty() && keep_out.empty() && max_home_m == 0; }
};
void describe(OptionTable& t, RegionKeys& k);

/// Null if the keys limit nothing. Throws InputError with `source`, the key and the reason.
std::shared_ptr<const FlightRegion> region_of(const std::string& source, const RegionKeys& keys);

/// The same of a mission file that was read already, such as a run's mission.info.
std::shared_ptr<const FlightRegion> region_in(const std::string& source,
                                              const boost::property_tree::ptree& mission);

}  // namespace karst::core
