#include "sdk/evaluation/report/report_units.h"

#include <string>

#include "sdk/evaluation/metrics/metric_definitions.h"

namespace karst::evaluation {

nlohmann::ordered_json metric_units() {
  nlohmann::ordered_json units = nlohmann::ordered_json::object();
  for (const MetricDefinition& m : metric_definitions())
    if (!m.unit.empty()) units[std::string(m.name)] = std::string(m.unit);
  units["loop_correction_m"] = "m";  // of a replay, which campaigns do not compare
  return units;
}

}  // namespace karst::evaluation
