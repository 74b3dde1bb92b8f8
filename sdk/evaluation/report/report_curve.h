// A curve in the form of the report's plots.
#pragma once
#include <nlohmann/json.hpp>
#include <vector>

namespace karst::evaluation {

/// [[x, y], ...], reduced to a plot's resolution, or null if the record has no such curve.
nlohmann::ordered_json report_curve(const std::vector<double>* t_s, const std::vector<double>* y,
                                    double scale = 1);

}  // namespace karst::evaluation
