// What a candidate file offers, found out in a child process.
#pragma once
#include <string>
#include <vector>

#include "sdk/host/plugin/discovery.h"

namespace karst::host {

/// One listing a policy the file offers, or a single one with the reason why it is broken: also if it crashes
/// or does not answer in time. What it writes to stdout or stderr meanwhile is dropped.
std::vector<PolicyListing> probe(const std::string& file, double limit_s);

}  // namespace karst::host
