// Reading a store: CampaignResults, and the additional data for exports.
#include <sqlite3.h>

#include <algorithm>
#include <limits>
#include <map>

#include "core_stack/common/error.h"
#include "core_stack/common/info_reader.h"
#include "core_stack/common/options.h"
#include "sdk/campaign/store/sqlite.h"
#include "sdk/campaign/store/store.h"
#include "sdk/campaign/store/store_schema.h"
#include "sdk/evaluation/metrics/metric_definitions.h"

namespace karst::campaign {
namespace {

namespace fs = std::filesystem;
using sqlite::Statement;

/// The store's columns of the figures, in the order of the definitions, then `ended`; NULL for missing ones,
/// in a store of an earlier karst.
std::string newer_columns(const fs::path& file, sqlite3* db) {
  const std::set<std::string> there = trial_columns(file, db);
  std::string text;
  for (const evaluation::MetricDefinition& m : evaluation::metric_definitions())
    text += there.contains(std::string(m.name)) ? ", " + std::string(m.name) : ", NULL";
  return text + (there.contains("ended") ? ", ended" : ", NULL");
}

void read_curves(const fs::path& file, sqlite3* db, const std::map<std::int64_t, std::size_t>& place,
                 std::vector<TrialResult>& trials) {
  Statement s(file, db, "SELECT trial, time_s, explored_m3, coverage FROM curve ORDER BY trial, time_s");
  while (s.step())
    if (const auto trial = place.find(s.integer(0)); trial != place.end())
      trials[trial->second].curve.push_back({s.real(1), s.real(2), s.real(3)});
}

/// A reference to a contestant or cave that is not in the store would index out of bounds.
std::size_t index_of(const fs::path& file, std::int64_t id, std::size_t count) {
  if (id < 1 || static_cast<std::size_t>(id) > count)
    throw core::InputError(file.string(), "trial", "names a contestant or cave that is not there");
  return static_cast<std::size_t>(id - 1);
}

}  // namespace

void read_conditions(const std::string& definition, const std::string& source, CampaignResults& results) {
  const boost::property_tree::ptree tree = core::parse_info(definition, source + ": campaign.definition");
  results.profile = tree.get("profile", "");
  results.metric = tree.get("metric", results.metric);
  for (const auto& [key, contestant] : tree) {
    if (key != "contestant") continue;
    if (results.flight_time.empty())  // the horizon is the same for all (plan.h)
      results.flight_time = contestant.get("mission.mission.max_flight_time", "");
    if (contestant.get("settings", "{}") != "{}") continue;
    for (const auto& [name, value] : core::leaves_of(contestant.get_child("mission", {})))
      if (!name.starts_with("policy.") && name != "mission.max_flight_time")
        results.shared.emplace_back(name, value);
    return;  // contains only what the contestants have in common
  }
}

ResultsWithExtras read_with_extras(const fs::path& folder_or_file) {
  const fs::path file = store_file(folder_or_file);
  const OpenStore store = open_to_read(file);
  sqlite3* db = store.get();
  const sqlite::Transaction one_moment(file, db, sqlite::Transaction::Kind::read);
  StoreHead head = read_head(file, db);
  ResultsWithExtras all{{head.name, head.horizon_s, std::move(head.contestants), std::move(head.caves), {}},
                        {}};
  CampaignResults& results = all.results;
  read_conditions(head.definition, file.string(), results);
  std::map<std::int64_t, std::size_t> place;
  Statement s(
      file, db,
      "SELECT id, contestant, cave, seed, status, outcome, reason, run_dir, binary_version, mission_hash,"
      " machine, trial_s, wall_s, simulated_s, decide_mean_ms, decide_p99_ms, decide_max_ms, plan_mean_ms,"
      " plan_p99_ms, plan_max_ms" +
          newer_columns(file, db) +
          " FROM trial LEFT JOIN timing ON timing.trial = trial.id ORDER BY contestant, cave, seed");
  while (s.step()) {
    TrialResult t;
    place[s.integer(0)] = results.trials.size();
    t.contestant = index_of(file, s.integer(1), results.contestants.size());
    t.cave = index_of(file, s.integer(2), results.caves.size());
    t.seed = s.integer(3);
    t.failed = s.text(4) == "failed";
    t.outcome = s.text(5);
    t.reason = s.text(6);
    t.run_dir = (fs::absolute(file).parent_path() / s.text(7)).lexically_normal().string();
    const double wall_s = s.real(12), simulated_s = s.real(13);
    const evaluation::WallClock flight{wall_s,     simulated_s, simulated_s / wall_s, s.real(14), s.real(15),
                                       s.real(16), s.real(17),  s.real(18),           s.real(19)};
    all.extras.push_back({s.text(8), s.text(9), {s.text(10), s.real(11), flight}});
    const std::size_t figures = evaluation::metric_definitions().size();
    for (std::size_t i = 0; i < figures; ++i) t.figures.push_back(s.real(static_cast<int>(20 + i)));
    t.ended = s.text(static_cast<int>(20 + figures));
    results.trials.push_back(std::move(t));
  }
  read_curves(file, db, place, results.trials);
  return all;
}

CampaignResults read_results(const fs::path& folder_or_file) {
  return read_with_extras(folder_or_file).results;
}

}  // namespace karst::campaign
