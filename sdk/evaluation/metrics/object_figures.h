// Figures of the search for objects of interest. Definitions: docs/metrics.md.
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "sdk/evaluation/metrics/object_events.h"
#include "sdk/evaluation/record/run_record.h"

namespace karst::evaluation {

/// For each known object the index of the matching true one: pairs of one kind within 3 m, nearest first,
/// each object used once. None: a false positive.
std::vector<std::optional<std::size_t>> match_objects(const std::vector<KnownObject>& known,
                                                      const std::vector<TrueObject>& truth);

/// Empty where the record lacks the data.
struct ObjectFigures {
  std::optional<double> placed, seen, found, reported, reported_fraction, report_time_s, error_m, wrong;
};

/// `found`: objects known to the vehicles at the end; `at_base`: those known to the base.
ObjectFigures object_figures(const std::vector<TrueObject>& truth, const std::vector<KnownObject>& found,
                             const std::vector<KnownObject>& at_base);

/// Of one vehicle's flight.
ObjectFigures object_figures(const RunRecord& run);

/// Sets objects_* and object_* of metrics.json, null for unknown values.
void set_figures(nlohmann::ordered_json& metrics, const ObjectFigures& figures);

}  // namespace karst::evaluation
