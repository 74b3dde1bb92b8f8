// The units of the figures on the page.
#pragma once
#include <nlohmann/json.hpp>

namespace karst::evaluation {

/// {"path_length_m": "m", ...}: the figures of metric_definitions() that have a unit.
nlohmann::ordered_json metric_units();

}  // namespace karst::evaluation
