// Whether cavern put the legs where their readings lead.
#pragma once
#include <vector>

#include "core_stack/common/geometry.h"
#include "sdk/survey/network.h"

namespace karst::survey {

/// A leg on no loop must lead where its reading says: nothing pulls at it. Throws core::InputError naming the
/// leg's line if it does not, since then all that hangs on it is elsewhere, too. A dive whose depth changes
/// by more than the tape is long contradicts itself: cavern weighs the two, and what it chose is a note.
/// `positions_m` are of the network's places, to the centimetre.
void check_legs(Readings& readings, const Network& network, const std::vector<core::Vec3>& positions_m);

}  // namespace karst::survey
