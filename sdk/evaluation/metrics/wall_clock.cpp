#include "sdk/evaluation/metrics/wall_clock.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "core_stack/common/json_file.h"
#include "core_stack/common/json_text.h"
#include "sdk/evaluation/record/table.h"

namespace karst::evaluation {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

struct Spread {
  double mean = kUnknown, p99 = kUnknown, max = kUnknown;
};

Spread spread_of(const std::vector<double>* column) {
  std::vector<double> values;
  if (column)
    std::copy_if(column->begin(), column->end(), std::back_inserter(values),
                 [](double v) { return std::isfinite(v); });
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  double sum = 0;
  for (const double v : values) sum += v;
  const auto count = static_cast<double>(values.size());
  return {sum / count, values[static_cast<std::size_t>(std::ceil(0.99 * count)) - 1], values.back()};
}

}  // namespace

WallClock read_wall_clock(const std::filesystem::path& run_dir, std::vector<std::string>& problems) {
  const Table decisions = read_table(run_dir / "decisions.csv", {}, problems);
  const Spread decide = spread_of(decisions.column("decide_ms")),
               plan = spread_of(decisions.column("plan_ms"));
  WallClock w{kUnknown,   kUnknown,  kUnknown, decide.mean, decide.p99,
              decide.max, plan.mean, plan.p99, plan.max};
  const auto file = run_dir / "timing.json";
  if (!std::filesystem::is_regular_file(file)) return w;
  const auto timing = core::json_of_file(file);
  if (!timing.is_object()) {
    problems.push_back("timing.json: is no JSON object");
    return w;
  }
  const auto number = [&](const char* key) {
    const auto v = timing.find(key);
    return v != timing.end() && v->is_number() ? v->get<double>() : kUnknown;
  };
  w.wall_s = number("wall_s");
  w.simulated_s = number("simulated_s");
  w.simulated_s_per_wall_s = number("simulated_s_per_wall_s");
  return w;
}

}  // namespace karst::evaluation
