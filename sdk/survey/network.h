// Which readings tie stations together: places, legs between them, splays, and what hangs together.
#pragma once
#include <cstdint>
#include <vector>

#include "sdk/survey/readings.h"

namespace karst::survey {

/// Stations that are equated share a place.
struct Network {
  static constexpr std::uint32_t kNone = ~0u;

  std::vector<std::uint32_t> place;     // of each station; kNone: it is not part of the network
  std::vector<std::uint32_t> stations;  // of each place: the first station there, in the order of the files
  std::vector<std::uint32_t> legs;      // indices of readings
  struct SplayAt {
    std::uint32_t reading = 0, place = 0;
    bool reversed = false;  // it was read from the wall
  };
  std::vector<SplayAt> splays;
  std::vector<std::uint32_t> fixes;  // indices; one for each fixed place
  std::size_t loops = 0;             // independent ones, fixed places taken as one
  LeftOut left_out;                  // for lack of a fixed station
};

/// Parts that neither a leg nor an equate ties to a fixed station are left out, each with a note; if nothing
/// is fixed, all but the part with the most legs. Throws core::InputError if a place is fixed at two
/// positions, or if there is no leg at all.
Network network_of(Readings& readings);

}  // namespace karst::survey
