// What a mission is for, and the figure that tells how well it was done.
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace karst::selection {

struct Goal {
  std::string_view name, metric, meaning;
};

/// All are figures of one flight: goals cost an experience no flights of their own.
std::span<const Goal> goals();

/// The metric of a goal, or of a metric itself. Throws InputError naming `source` and the most similar goal.
std::string metric_for(const std::string& goal_or_metric, const std::string& source);

/// "deepest" for depth_m; "" if no goal stands for the metric.
std::string goal_of(const std::string& metric);

}  // namespace karst::selection
