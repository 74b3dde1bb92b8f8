#include "sdk/flight/timing.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>

#include "core_stack/common/json_text.h"

namespace karst::flight {

void write_timing(const std::filesystem::path& run_dir, const core::Executive& executive, double wall_s) {
  nlohmann::ordered_json jobs;
  for (const auto& [name, cost] : executive.costs()) {
    std::vector<float> ms = cost.milliseconds;
    if (ms.empty()) continue;
    std::sort(ms.begin(), ms.end());
    const auto quantile = [&](double q) {
      return ms[static_cast<std::size_t>(q * static_cast<double>(ms.size() - 1))];
    };
    const double sum = std::accumulate(ms.begin(), ms.end(), 0.0);
    jobs[name] = {{"count", ms.size()},
                  {"total_s", sum * 1e-3},
                  {"mean_ms", sum / static_cast<double>(ms.size())},
                  {"p50_ms", quantile(0.5)},
                  {"p99_ms", quantile(0.99)},
                  {"max_ms", ms.back()},
                  {"overruns", cost.overruns}};
  }
  const double simulated_s = core::seconds(executive.now());
  nlohmann::ordered_json timing{{"simulated_s", simulated_s},
                                {"wall_s", wall_s},
                                {"simulated_s_per_wall_s", simulated_s / wall_s},
                                {"threads", executive.threads()},
                                {"jobs", jobs}};
  std::ofstream(run_dir / "timing.json") << core::json_text(timing, 2) << '\n';
}

void write_team_timing(const std::filesystem::path& run_dir, const TeamTiming& t) {
  const nlohmann::ordered_json timing{{"simulated_s", t.simulated_s},
                                      {"wall_s", t.wall_s},
                                      {"simulated_s_per_wall_s", t.simulated_s / t.wall_s},
                                      {"threads", t.threads},
                                      {"jobs", nlohmann::ordered_json::object()}};
  std::ofstream(run_dir / "timing.json") << core::json_text(timing, 2) << '\n';
}

}  // namespace karst::flight
