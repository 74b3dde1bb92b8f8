#include "sdk/flight/timing.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "core_stack/common/json_text.h"

namespace karst::flight {
namespace {

double ms(core::TimeNs t) { return 1e3 * core::seconds(t); }

nlohmann::ordered_json json_of(const core::Cost& cost) {
  const core::DurationHistogram& d = cost.duration;
  const double sum_s = core::seconds(d.total());
  return {{"count", d.count()},
          {"total_s", sum_s},
          {"mean_ms", 1e3 * sum_s / static_cast<double>(d.count())},
          {"p50_ms", ms(d.quantile(0.5))},
          {"p99_ms", ms(d.quantile(0.99))},
          {"max_ms", ms(d.max())},
          {"overruns", cost.overruns}};
}

nlohmann::ordered_json json_of(const core::Punctuality& p) {
  return {{"count", p.lateness.count()},
          {"p50_ms", ms(p.lateness.quantile(0.5))},
          {"p99_ms", ms(p.lateness.quantile(0.99))},
          {"p99_9_ms", ms(p.lateness.quantile(0.999))},
          {"max_ms", ms(p.lateness.max())},
          {"missed_deadlines", p.missed_deadlines}};
}

nlohmann::ordered_json json_of(const core::Executive& executive, const RealTimeTiming& real_time) {
  nlohmann::ordered_json out{{"granted", nlohmann::ordered_json::object()},
                             {"lateness", nlohmann::ordered_json::object()},
                             {"lost_s", core::seconds(executive.lost_time())},
                             {"degraded", nlohmann::ordered_json::object()}};
  for (const Grant& g : real_time.grants) out["granted"][g.what] = {{"granted", g.granted}, {"text", g.text}};
  for (const auto& [step, punctuality] : executive.punctuality())
    if (punctuality.lateness.count() > 0) out["lateness"][step] = json_of(punctuality);
  for (const auto& [relief, times] : real_time.degraded) out["degraded"][core::name_of(relief)] = times;
  return out;
}

}  // namespace

void write_timing(const std::filesystem::path& run_dir, const core::Executive& executive, double wall_s,
                  const RealTimeTiming* real_time) {
  nlohmann::ordered_json jobs;
  for (const auto& [name, cost] : executive.costs())
    if (cost.duration.count() > 0) jobs[name] = json_of(cost);
  const double simulated_s = core::seconds(executive.now());
  nlohmann::ordered_json timing{{"simulated_s", simulated_s},
                                {"wall_s", wall_s},
                                {"simulated_s_per_wall_s", simulated_s / wall_s},
                                {"threads", executive.threads()},
                                {"jobs", jobs}};
  if (real_time) timing["real_time"] = json_of(executive, *real_time);
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
