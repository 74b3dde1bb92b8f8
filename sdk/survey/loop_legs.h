// Which legs of a survey lie on a loop.
#pragma once
#include <vector>

#include "sdk/survey/network.h"

namespace karst::survey {

/// By leg of the network: whether it lies on a loop, fixed places taken as one. The other measured legs are
/// the bridges of the graph: least squares has nothing to distribute to them. True for legs that were not
/// measured.
std::vector<bool> legs_on_loops(const Readings& readings, const Network& network);

}  // namespace karst::survey
