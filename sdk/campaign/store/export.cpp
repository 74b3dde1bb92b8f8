#include "sdk/campaign/store/export.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <ostream>
#include <utility>

#include "core_stack/common/csv_cell.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/json_text.h"
#include "sdk/evaluation/metrics/metric_definitions.h"

namespace karst::campaign {
namespace {

using core::csv_cell;
using nlohmann::ordered_json;

/// Names and values of the wall-clock quantities.
std::array<std::pair<const char*, double>, 9> timing_of(const TrialTiming& t) {
  const evaluation::WallClock& f = t.flight;
  return {{{"trial_s", t.trial_s},
           {"wall_s", f.wall_s},
           {"simulated_s", f.simulated_s},
           {"decide_mean_ms", f.decide_mean_ms},
           {"decide_p99_ms", f.decide_p99_ms},
           {"decide_max_ms", f.decide_max_ms},
           {"plan_mean_ms", f.plan_mean_ms},
           {"plan_p99_ms", f.plan_p99_ms},
           {"plan_max_ms", f.plan_max_ms}}};
}

std::string number_cell(double v) { return std::isfinite(v) ? core::shortest_text(v) : ""; }

ordered_json value(double v) { return std::isfinite(v) ? ordered_json(v) : ordered_json(nullptr); }

ordered_json parsed(const std::string& text) {
  auto read = core::json_of<ordered_json>(text);
  return read.is_discarded() ? ordered_json(nullptr) : read;
}

ordered_json trial_json(const CampaignResults& results, const TrialResult& t, const TrialExtras& extras) {
  ordered_json j{{"contestant", results.contestants[t.contestant].name},
                 {"cave", results.caves[t.cave].name},
                 {"seed", t.seed},
                 {"status", t.failed ? "failed" : "done"},
                 {"outcome", t.outcome},
                 {"reason", t.reason},
                 {"ended", t.ended},
                 {"figures", ordered_json::object()},
                 {"curve", ordered_json::array()},
                 {"binary_version", extras.binary_version},
                 {"mission_hash", extras.mission_hash},
                 {"timing", {{"machine", extras.timing.machine}}},
                 {"run_dir", t.run_dir}};
  const auto definitions = evaluation::metric_definitions();
  for (std::size_t i = 0; i < definitions.size(); ++i)
    j["figures"][std::string(definitions[i].name)] = value(t.figures[i]);
  for (const CurvePoint& p : t.curve)
    j["curve"].push_back({p.time_s, value(p.explored_m3), value(p.coverage)});
  for (const auto& [name, v] : timing_of(extras.timing)) j["timing"][name] = value(v);
  return j;
}

}  // namespace

void write_csv(std::ostream& out, const CampaignResults& results, const std::vector<TrialExtras>& extras) {
  out << "contestant,policy,cave,seed,status,outcome,reason,ended";
  for (const evaluation::MetricDefinition& m : evaluation::metric_definitions()) out << ',' << m.name;
  out << ",binary_version,mission_hash,machine";
  for (const auto& [name, ignored] : timing_of({})) out << ',' << name;
  out << ",run_dir\n";
  for (std::size_t i = 0; i < results.trials.size(); ++i) {
    const TrialResult& t = results.trials[i];
    const ContestantEntry& who = results.contestants[t.contestant];
    out << csv_cell(who.name) << ',' << csv_cell(who.policy) << ',' << csv_cell(results.caves[t.cave].name)
        << ',' << t.seed << ',' << (t.failed ? "failed" : "done") << ',' << csv_cell(t.outcome) << ','
        << csv_cell(t.reason) << ',' << csv_cell(t.ended);
    for (const double v : t.figures) out << ',' << number_cell(v);
    out << ',' << csv_cell(extras[i].binary_version) << ',' << csv_cell(extras[i].mission_hash) << ','
        << csv_cell(extras[i].timing.machine);
    for (const auto& [name, v] : timing_of(extras[i].timing)) out << ',' << number_cell(v);
    out << ',' << csv_cell(t.run_dir) << '\n';
  }
}

void write_json(std::ostream& out, const CampaignResults& results, const std::vector<TrialExtras>& extras,
                const ordered_json& verdict) {
  ordered_json j{{"schema", "karst.results/1"},    {"name", results.name},
                 {"horizon_s", results.horizon_s}, {"contestants", ordered_json::array()},
                 {"caves", ordered_json::array()}, {"verdict", verdict},
                 {"trials", ordered_json::array()}};
  for (const ContestantEntry& c : results.contestants)
    j["contestants"].push_back({{"name", c.name},
                                {"policy", c.policy},
                                {"version", c.version},
                                {"parameters", parsed(c.parameters)},
                                {"settings", parsed(c.settings)}});
  for (const CaveEntry& c : results.caves)
    j["caves"].push_back({{"name", c.name},
                          {"file", c.file},
                          {"start", c.start},
                          {"hash", c.hash},
                          {"description", parsed(c.description)}});
  for (std::size_t i = 0; i < results.trials.size(); ++i)
    j["trials"].push_back(trial_json(results, results.trials[i], extras[i]));
  out << core::json_text(j, 1) << '\n';
}

}  // namespace karst::campaign
