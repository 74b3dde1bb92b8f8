// The summary as JSON, schema karst.preflight/1 (docs/preflight.md).
#pragma once
#include <nlohmann/json.hpp>
#include <vector>

#include "sdk/preflight/verdict.h"

namespace karst::preflight {

/// What is not known is null.
nlohmann::ordered_json to_json(const Preflight& preflight, const std::vector<Finding>& findings);

}  // namespace karst::preflight
