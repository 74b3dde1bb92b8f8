// What writing and reading a store share: its schema, and opening a file that may be anything.
#pragma once
#include <sqlite3.h>

#include <filesystem>
#include <memory>
#include <set>
#include <string>

#include "sdk/campaign/store/store.h"

namespace karst::campaign {

constexpr int kApplicationId = 0x4b525354;  // "KRST": what `file` and we know a store by
constexpr int kSchemaVersion = 1;
constexpr const char* kSchema = "karst.campaign/1";

struct CloseDatabase {
  void operator()(sqlite3* db) const { sqlite3_close(db); }
};
using OpenStore = std::unique_ptr<sqlite3, CloseDatabase>;

/// SQL that makes an empty store of an empty file.
std::string schema_sql();
/// Any SQLite file; `flags` as of sqlite3_open_v2.
OpenStore open_file(const std::filesystem::path& file, int flags);
/// That it is a store, whole, and of this version.
void check_store(const std::filesystem::path& file, sqlite3* db);
/// A store that may be written to by somebody else meanwhile.
OpenStore open_to_read(const std::filesystem::path& file);

std::set<std::string> trial_columns(const std::filesystem::path& file, sqlite3* db);
void write_head(const std::filesystem::path& file, sqlite3* db, const StoreHead& head);
StoreHead read_head(const std::filesystem::path& file, sqlite3* db);

}  // namespace karst::campaign
