// The summary as one printable page (A4): self-contained HTML that needs no script.
#pragma once
#include <string>
#include <vector>

#include "sdk/preflight/verdict.h"

namespace karst::preflight {

/// The JSON of the summary is in it too, in the element `data`.
std::string preflight_page(const Preflight& preflight, const std::vector<Finding>& findings);

}  // namespace karst::preflight
