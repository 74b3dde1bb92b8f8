// Common parts of writing and reading a store: its schema, and opening arbitrary files.
#pragma once
#include <sqlite3.h>

#include <filesystem>
#include <memory>
#include <set>
#include <string>

#include "sdk/campaign/store/store.h"

namespace karst::campaign {

constexpr int kApplicationId = 0x4b525354;  // "KRST": identifies a store to `file` and to karst
constexpr int kSchemaVersion = 1;
constexpr const char* kSchema = "karst.campaign/1";

struct CloseDatabase {
  void operator()(sqlite3* db) const { sqlite3_close(db); }
};
using OpenStore = std::unique_ptr<sqlite3, CloseDatabase>;

/// SQL that creates an empty store in an empty file.
std::string schema_sql();
/// Opens any SQLite file; `flags` as for sqlite3_open_v2.
OpenStore open_file(const std::filesystem::path& file, int flags);
/// Throws unless the file is a complete store of this version.
void check_store(const std::filesystem::path& file, sqlite3* db);
/// Opens a store for reading while others may write to it.
OpenStore open_to_read(const std::filesystem::path& file);

std::set<std::string> trial_columns(const std::filesystem::path& file, sqlite3* db);
void write_head(const std::filesystem::path& file, sqlite3* db, const StoreHead& head);
StoreHead read_head(const std::filesystem::path& file, sqlite3* db);

}  // namespace karst::campaign
