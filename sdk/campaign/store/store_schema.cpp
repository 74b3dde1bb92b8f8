#include "sdk/campaign/store/store_schema.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "core_stack/common/json_text.h"
#include "sdk/campaign/store/sqlite.h"
#include "sdk/evaluation/metrics/metric_definitions.h"

namespace karst::campaign {
namespace {

namespace fs = std::filesystem;
using core::InputError;
using sqlite::Statement;

/// ", a REAL, b REAL": the columns that follow the table of figures.
std::string figure_columns(const std::string& before, const char* type) {
  std::string text;
  for (const evaluation::MetricDefinition& m : evaluation::metric_definitions())
    text += ", " + before + std::string(m.name) + type;
  return text;
}

std::int64_t number(const fs::path& file, sqlite3* db, const std::string& sql) {
  Statement s(file, db, sql);
  return s.step() ? s.integer(0) : 0;
}

std::string value_of(const fs::path& file, sqlite3* db, const char* key) {
  Statement s(file, db, "SELECT value FROM campaign WHERE key = ?1");
  s.bind(1, std::string(key));
  return s.step() ? s.text(0) : "";
}

void set_value(const fs::path& file, sqlite3* db, const char* key, const std::string& value) {
  Statement(file, db, "INSERT OR REPLACE INTO campaign VALUES(?1, ?2)")
      .bind(1, std::string(key))
      .bind(2, value)
      .run();
}

std::vector<ContestantEntry> read_contestants(const fs::path& file, sqlite3* db) {
  std::vector<ContestantEntry> all;
  Statement s(file, db, "SELECT name, policy, version, parameters, settings FROM contestant ORDER BY id");
  while (s.step()) all.push_back({s.text(0), s.text(1), s.text(2), s.text(3), s.text(4)});
  return all;
}

std::vector<CaveEntry> read_caves(const fs::path& file, sqlite3* db) {
  std::vector<CaveEntry> all;
  Statement s(file, db, "SELECT name, file, start, description, hash FROM cave ORDER BY id");
  while (s.step()) all.push_back({s.text(0), s.text(1), s.text(2), s.text(3), s.text(4)});
  return all;
}

}  // namespace

std::string schema_sql() {
  return "PRAGMA application_id = " + std::to_string(kApplicationId) +
         ";PRAGMA user_version = " + std::to_string(kSchemaVersion) +
         ";CREATE TABLE campaign(key TEXT PRIMARY KEY NOT NULL, value TEXT NOT NULL) WITHOUT ROWID;"
         "CREATE TABLE contestant(id INTEGER PRIMARY KEY, name TEXT UNIQUE NOT NULL, policy TEXT NOT NULL,"
         " version TEXT NOT NULL, parameters TEXT NOT NULL, settings TEXT NOT NULL);"
         "CREATE TABLE cave(id INTEGER PRIMARY KEY, name TEXT UNIQUE NOT NULL, file TEXT NOT NULL,"
         " start TEXT NOT NULL, hash TEXT NOT NULL, description TEXT NOT NULL);"
         "CREATE TABLE trial(id INTEGER PRIMARY KEY, contestant INTEGER NOT NULL REFERENCES contestant,"
         " cave INTEGER NOT NULL REFERENCES cave, seed INTEGER NOT NULL,"
         " status TEXT NOT NULL CHECK(status IN ('done', 'failed')), outcome TEXT NOT NULL, reason TEXT NOT "
         "NULL,"
         " binary_version TEXT NOT NULL, mission_hash TEXT NOT NULL, run_dir TEXT NOT NULL" +
         figure_columns("", " REAL") +
         ", ended TEXT, UNIQUE(contestant, cave, seed));"
         "CREATE TABLE curve(trial INTEGER NOT NULL REFERENCES trial, time_s REAL NOT NULL, explored_m3 REAL,"
         " coverage REAL, PRIMARY KEY(trial, time_s)) WITHOUT ROWID;"
         "CREATE TABLE timing(trial INTEGER PRIMARY KEY REFERENCES trial, machine TEXT NOT NULL, trial_s "
         "REAL,"
         " wall_s REAL, simulated_s REAL, decide_mean_ms REAL, decide_p99_ms REAL, decide_max_ms REAL,"
         " plan_mean_ms REAL, plan_p99_ms REAL, plan_max_ms REAL);"
         "CREATE VIEW result AS SELECT contestant.name AS contestant, cave.name AS cave, trial.seed,"
         " trial.status, trial.outcome, trial.reason, trial.ended" +
         figure_columns("trial.", "") +
         ", trial.binary_version, trial.mission_hash, trial.run_dir, trial.id"
         " FROM trial JOIN contestant ON contestant.id = trial.contestant JOIN cave ON cave.id = trial.cave"
         " ORDER BY trial.contestant, trial.cave, trial.seed;";
}

OpenStore open_file(const fs::path& file, int flags) {
  if (fs::exists(file)) core::check_input(file.string(), core::kMaxDataFileBytes);
  sqlite3* db = nullptr;
  const int code = sqlite3_open_v2(file.c_str(), &db, flags, nullptr);
  OpenStore store(db);
  if (code != SQLITE_OK) throw InputError(file.string(), "", db ? sqlite3_errmsg(db) : "out of memory");
  sqlite3_busy_timeout(db, 5000);
  return store;
}

OpenStore open_to_read(const fs::path& file) {
  if (!fs::exists(file) && fs::is_directory(file.parent_path()) && file.filename() == "campaign.sqlite")
    throw InputError(file.parent_path().string(), "", "holds no campaign: there is no campaign.sqlite in it");
  if (!fs::exists(file)) throw InputError(file.string(), "", "no such store");
  // Not read-only: an incomplete write of a killed process must be rolled back first.
  OpenStore store = open_file(file, SQLITE_OPEN_READWRITE);
  check_store(file, store.get());
  return store;
}

std::set<std::string> trial_columns(const fs::path& file, sqlite3* db) {
  std::set<std::string> names;
  Statement s(file, db, "SELECT name FROM pragma_table_info('trial')");
  while (s.step()) names.insert(s.text(0));
  return names;
}

void check_store(const fs::path& file, sqlite3* db) {
  if (number(file, db, "PRAGMA application_id") != kApplicationId)
    throw InputError(file.string(), "", "is no store of a karst campaign");
  if (const auto version = number(file, db, "PRAGMA user_version"); version != kSchemaVersion)
    throw InputError(file.string(), "",
                     "its schema has version " + std::to_string(version) + ", this karst reads version " +
                         std::to_string(kSchemaVersion));
  Statement check(file, db, "PRAGMA quick_check(1)");
  const std::string found = check.step() ? check.text(0) : "";
  if (found != "ok")  // a headline; the last line names the problem
    throw InputError(file.string(), "", "is damaged (" + found.substr(found.rfind('\n') + 1) + ")");
  if (const std::string schema = value_of(file, db, "schema"); schema != kSchema)
    throw InputError(file.string(), "campaign.schema",
                     "expected " + std::string(kSchema) + ", got \"" + schema + "\"");
}

void write_head(const fs::path& file, sqlite3* db, const StoreHead& head) {
  nlohmann::json seeds = head.seeds;
  set_value(file, db, "schema", kSchema);
  set_value(file, db, "name", head.name);
  set_value(file, db, "definition", head.definition);
  set_value(file, db, "horizon_s", core::json_text(nlohmann::json(head.horizon_s)));
  set_value(file, db, "seeds", core::json_text(seeds));
  Statement contestant(file, db, "INSERT OR REPLACE INTO contestant VALUES(?1, ?2, ?3, ?4, ?5, ?6)");
  for (std::size_t i = 0; i < head.contestants.size(); ++i) {
    const ContestantEntry& c = head.contestants[i];
    contestant.bind(1, static_cast<std::int64_t>(i + 1)).bind(2, c.name).bind(3, c.policy).bind(4, c.version);
    contestant.bind(5, c.parameters).bind(6, c.settings).run();
  }
  Statement cave(file, db, "INSERT OR REPLACE INTO cave VALUES(?1, ?2, ?3, ?4, ?5, ?6)");
  for (std::size_t i = 0; i < head.caves.size(); ++i) {
    const CaveEntry& c = head.caves[i];
    cave.bind(1, static_cast<std::int64_t>(i + 1)).bind(2, c.name).bind(3, c.file).bind(4, c.start);
    cave.bind(5, c.hash).bind(6, c.description).run();
  }
}

StoreHead read_head(const fs::path& file, sqlite3* db) {
  const auto json_of = [&](const char* key) {
    auto parsed = core::json_of(value_of(file, db, key));
    if (parsed.is_discarded())
      throw InputError(file.string(), std::string("campaign.") + key, "cannot be read");
    return parsed;
  };
  StoreHead head;
  head.name = value_of(file, db, "name");
  head.definition = value_of(file, db, "definition");
  try {
    head.horizon_s = json_of("horizon_s").get<double>();
    head.seeds = json_of("seeds").get<std::vector<std::int64_t>>();
  } catch (const nlohmann::json::exception& e) {
    throw InputError(file.string(), "campaign", e.what());
  }
  if (!std::isfinite(head.horizon_s) || head.horizon_s <= 0)
    throw InputError(file.string(), "campaign.horizon_s",
                     "expected seconds, got " + value_of(file, db, "horizon_s"));
  head.contestants = read_contestants(file, db);
  head.caves = read_caves(file, db);
  return head;
}

}  // namespace karst::campaign
