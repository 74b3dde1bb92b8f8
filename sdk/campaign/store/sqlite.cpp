#include "sdk/campaign/store/sqlite.h"

#include <cerrno>
#include <cstring>
#include <limits>

#include "core_stack/common/error.h"

namespace karst::campaign::sqlite {

void fail(const std::filesystem::path& file, sqlite3* db) {
  const int code = sqlite3_errcode(db) & 0xff;
  const int system = sqlite3_system_errno(db);
  std::string reason = sqlite3_errmsg(db);
  if (code == SQLITE_FULL || (code == SQLITE_IOERR && (system == ENOSPC || system == EDQUOT)))
    reason = "the disk is full; what was stored before is there";
  else if (code == SQLITE_BUSY || code == SQLITE_LOCKED)
    reason = "is locked by another program, such as a sqlite3 shell with an open transaction";
  else if (code == SQLITE_NOTADB)
    reason = "is no SQLite file";
  else if (code == SQLITE_CORRUPT)
    reason = "is damaged (" + reason + ")";
  else if (code == SQLITE_IOERR || code == SQLITE_CANTOPEN)
    reason += system ? std::string(": ") + std::strerror(system) : "";
  throw core::InputError(file.string(), "", reason);
}

Statement::Statement(const std::filesystem::path& file, sqlite3* db, const std::string& sql)
    : file_(file), db_(db) {
  sqlite3_stmt* statement = nullptr;
  check(sqlite3_prepare_v2(db, sql.c_str(), static_cast<int>(sql.size()), &statement, nullptr));
  statement_.reset(statement);
}

void Statement::check(int code) const {
  if (code != SQLITE_OK) fail(file_, db_);
}

Statement& Statement::bind(int at, const std::string& text) {
  check(
      sqlite3_bind_text(statement_.get(), at, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT));
  return *this;
}
Statement& Statement::bind(int at, std::int64_t number) {
  check(sqlite3_bind_int64(statement_.get(), at, number));
  return *this;
}
Statement& Statement::bind(int at, double number) {  // SQLite turns NaN into NULL, but keeps infinity
  check(std::isfinite(number) ? sqlite3_bind_double(statement_.get(), at, number)
                              : sqlite3_bind_null(statement_.get(), at));
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) fail(file_, db_);
  return code == SQLITE_ROW;
}

void Statement::run() {
  while (step()) {
  }
  sqlite3_reset(statement_.get());
}

std::string Statement::text(int column) const {
  const unsigned char* bytes = sqlite3_column_text(statement_.get(), column);
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return bytes ? std::string(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size)) : "";
}

double Statement::real(int column) const {
  const int type = sqlite3_column_type(statement_.get(), column);
  if (type == SQLITE_NULL) return std::numeric_limits<double>::quiet_NaN();
  if (type != SQLITE_FLOAT && type != SQLITE_INTEGER)  // SQLite would read it as 0
    throw core::InputError(file_.string(), sqlite3_column_name(statement_.get(), column),
                           "expected a number, got \"" + text(column) + "\"");
  return sqlite3_column_double(statement_.get(), column);
}

void run(const std::filesystem::path& file, sqlite3* db, const std::string& sql) {
  if (sqlite3_exec(db, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail(file, db);
}

Transaction::Transaction(const std::filesystem::path& file, sqlite3* db, Kind kind) : file_(file), db_(db) {
  sqlite::run(file_, db_, kind == Kind::write ? "BEGIN IMMEDIATE" : "BEGIN");
}
Transaction::~Transaction() {
  if (!committed_) sqlite3_exec(db_, "ROLLBACK", nullptr, nullptr, nullptr);
}
void Transaction::commit() {
  sqlite::run(file_, db_, "COMMIT");
  committed_ = true;
}

}  // namespace karst::campaign::sqlite
