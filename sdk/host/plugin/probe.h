// Determines in a child process which policies a candidate file offers.
#pragma once
#include <string>
#include <vector>

#include "sdk/host/plugin/discovery.h"

namespace karst::host {

/// One listing for each policy that the file offers, or a single one with the reason why it is broken, also
/// if it crashes or does not answer in time. Its output to stdout and stderr is dropped.
std::vector<PolicyListing> probe(const std::string& file, double limit_s);

}  // namespace karst::host
