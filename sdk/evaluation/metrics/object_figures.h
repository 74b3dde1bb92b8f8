// Figures of the search for objects of interest. Definitions: docs/metrics.md.
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "sdk/evaluation/metrics/object_events.h"
#include "sdk/evaluation/record/run_record.h"

namespace karst::evaluation {

/// For each known object the index of the true one it is: of all pairs of one kind within 3 m the nearest
/// first, each used once. None: it is a false one.
std::vector<std::optional<std::size_t>> match_objects(const std::vector<KnownObject>& known,
                                                      const std::vector<TrueObject>& truth);

/// Empty where the record does not tell.
struct ObjectFigures {
  std::optional<double> placed, seen, found, reported, reported_fraction, report_time_s, error_m, wrong;
};

/// `found` is what the vehicles know, `at_base` what the base does, in the end.
ObjectFigures object_figures(const std::vector<TrueObject>& truth, const std::vector<KnownObject>& found,
                             const std::vector<KnownObject>& at_base);

/// Of one vehicle's flight.
ObjectFigures object_figures(const RunRecord& run);

/// Sets objects_* and object_* of metrics.json, null for what is not known.
void set_figures(nlohmann::ordered_json& metrics, const ObjectFigures& figures);

}  // namespace karst::evaluation
