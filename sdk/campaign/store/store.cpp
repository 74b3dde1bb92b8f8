#include "sdk/campaign/store/store.h"

#include <algorithm>
#include <type_traits>

#include "core_stack/common/error.h"
#include "sdk/campaign/store/sqlite.h"
#include "sdk/campaign/store/store_schema.h"
#include "sdk/evaluation/metrics/metric_definitions.h"

namespace karst::campaign {
namespace {

namespace fs = std::filesystem;
using core::InputError;
using sqlite::Statement;

// A trial's id in decimal: contestant, three digits for the cave, six for the seed's index, each from 1.
constexpr std::int64_t kSeedDigits = 1'000'000, kCaveDigits = 1'000;

/// With more caves or seeds, the ids of trials would collide.
void refuse_too_many(const fs::path& file, const StoreHead& head) {
  if (head.caves.size() >= kCaveDigits || head.seeds.size() >= kSeedDigits)
    throw InputError(file.string(), "", "at most 999 caves and 999999 seeds fit in a store");
}

template <class Entry>
void check_prefix(const fs::path& file, const std::vector<Entry>& now, const std::vector<Entry>& then,
                  const char* what) {
  const bool same = now.size() >= then.size() &&
                    std::equal(then.begin(), then.end(), now.begin(), [](const Entry& a, const Entry& b) {
                      if constexpr (std::is_integral_v<Entry>)
                        return a == b;
                      else
                        return a.name == b.name;
                    });
  if (!same)
    throw InputError(file.string(), what, "what is there already must stay in its place; only append to it");
}

}  // namespace

void Store::Close::operator()(sqlite3* db) const { sqlite3_close(db); }
Store::Store(Store&&) noexcept = default;
Store& Store::operator=(Store&&) noexcept = default;
Store::~Store() = default;

Store Store::create(const fs::path& file, const StoreHead& head) {
  if (fs::exists(file)) throw InputError(file.string(), "", "is there already");
  refuse_too_many(file, head);
  const fs::path part = file.string() + ".part";  // so that nobody opens an incomplete store
  std::error_code ignored;
  fs::remove(part, ignored);
  try {
    Store fresh(part);
    fresh.db_.reset(open_file(part, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE).release());
    sqlite::Transaction transaction(fresh.file_, fresh.db_.get());
    sqlite::run(fresh.file_, fresh.db_.get(), schema_sql());
    write_head(fresh.file_, fresh.db_.get(), head);
    transaction.commit();
  } catch (const InputError&) {
    fs::remove(part, ignored);
    throw;
  }
  std::error_code error;
  fs::rename(part, file, error);
  if (error) throw InputError(file.string(), "", error.message());
  return open(file);
}

Store Store::open(const fs::path& file, double lock_wait_s) {
  Store store(file);
  store.db_.reset(open_to_read(file).release());
  sqlite3_busy_timeout(store.db_.get(), static_cast<int>(lock_wait_s * 1000));
  const std::set<std::string> columns = trial_columns(file, store.db_.get());
  for (const evaluation::MetricDefinition& m : evaluation::metric_definitions())
    if (!columns.contains(std::string(m.name)))
      throw InputError(file.string(), "trial." + std::string(m.name),
                       "was not known to the karst that made this store; start the campaign anew to have it");
  return store;
}

StoreHead Store::head() const { return read_head(file_, db_.get()); }

void Store::extend(const StoreHead& wanted) {
  const StoreHead there = head();
  refuse_too_many(file_, wanted);
  check_prefix(file_, wanted.contestants, there.contestants, "contestants");
  check_prefix(file_, wanted.caves, there.caves, "caves");
  check_prefix(file_, wanted.seeds, there.seeds, "seeds");
  StoreHead merged = wanted;
  for (std::size_t i = 0; i < there.caves.size(); ++i)
    if (merged.caves[i].description.empty()) merged.caves[i].description = there.caves[i].description;
  sqlite::Transaction transaction(file_, db_.get());
  write_head(file_, db_.get(), merged);
  transaction.commit();
}

void Store::describe_cave(std::size_t cave, const std::string& description) {
  sqlite::Transaction transaction(file_, db_.get());
  Statement(file_, db_.get(), "UPDATE cave SET description = ?2 WHERE id = ?1")
      .bind(1, static_cast<std::int64_t>(cave + 1))
      .bind(2, description)
      .run();
  transaction.commit();
}

void Store::add(const std::vector<StoredTrial>& trials) {
  if (trials.empty()) return;
  const std::vector<std::int64_t> seeds = head().seeds;
  const bool tells_ending = trial_columns(file_, db_.get()).contains("ended");  // or an earlier karst made it
  sqlite::Transaction transaction(file_, db_.get());
  for (const StoredTrial& trial : trials) write(trial, seeds, tells_ending);
  transaction.commit();
}

void Store::write(const StoredTrial& trial, const std::vector<std::int64_t>& seeds, bool tells_ending) {
  const TrialResult& r = trial.result;
  const auto definitions = evaluation::metric_definitions();
  const auto place = std::find(seeds.begin(), seeds.end(), r.seed);
  if (place == seeds.end() || r.figures.size() != definitions.size())
    throw InputError(file_.string(), "trial", "seed or figures do not belong to this campaign");
  const std::int64_t contestant = static_cast<std::int64_t>(r.contestant) + 1,
                     cave = static_cast<std::int64_t>(r.cave) + 1;
  const std::int64_t id = (contestant * kCaveDigits + cave) * kSeedDigits + (place - seeds.begin()) + 1;

  std::string names, marks;
  for (std::size_t i = 0; i < definitions.size(); ++i) {
    names += ", " + std::string(definitions[i].name);
    marks += ", ?" + std::to_string(11 + i);
  }
  const int ended_at = static_cast<int>(11 + definitions.size());
  if (tells_ending) {
    names += ", ended";
    marks += ", ?" + std::to_string(ended_at);
  }
  Statement row(file_, db_.get(),
                "INSERT OR REPLACE INTO trial(id, contestant, cave, seed, status, outcome, reason,"
                " binary_version, mission_hash, run_dir" +
                    names + ") VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10" + marks + ")");
  row.bind(1, id).bind(2, contestant).bind(3, cave).bind(4, r.seed);
  row.bind(5, std::string(r.failed ? "failed" : "done")).bind(6, r.outcome).bind(7, r.reason);
  row.bind(8, trial.binary_version).bind(9, trial.mission_hash).bind(10, r.run_dir);
  for (std::size_t i = 0; i < definitions.size(); ++i) row.bind(static_cast<int>(11 + i), r.figures[i]);
  if (tells_ending) row.bind(ended_at, r.ended);
  row.run();
  Statement(file_, db_.get(), "DELETE FROM curve WHERE trial = ?1").bind(1, id).run();
  Statement point(file_, db_.get(), "INSERT INTO curve VALUES(?1, ?2, ?3, ?4)");
  for (const CurvePoint& p : r.curve)
    point.bind(1, id).bind(2, p.time_s).bind(3, p.explored_m3).bind(4, p.coverage).run();
  const TrialTiming& t = trial.timing;
  const evaluation::WallClock& f = t.flight;
  Statement timing(file_, db_.get(),
                   "INSERT OR REPLACE INTO timing VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11)");
  timing.bind(1, id).bind(2, t.machine).bind(3, t.trial_s).bind(4, f.wall_s).bind(5, f.simulated_s);
  timing.bind(6, f.decide_mean_ms).bind(7, f.decide_p99_ms).bind(8, f.decide_max_ms);
  timing.bind(9, f.plan_mean_ms).bind(10, f.plan_p99_ms).bind(11, f.plan_max_ms).run();
}

std::set<TrialKey> Store::finished() const {
  std::set<TrialKey> keys;
  Statement s(file_, db_.get(), "SELECT contestant, cave, seed FROM trial");
  while (s.step()) keys.emplace(s.integer(0) - 1, s.integer(1) - 1, s.integer(2));
  return keys;
}

fs::path store_file(const fs::path& path) { return fs::is_directory(path) ? path / "campaign.sqlite" : path; }

}  // namespace karst::campaign
