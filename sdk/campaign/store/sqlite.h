// A thin wrapper of SQLite: every error becomes a core::InputError with advice.
#pragma once
#include <sqlite3.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace karst::campaign::sqlite {

/// Throws the last error of `db` as a sentence about `file`.
[[noreturn]] void fail(const std::filesystem::path& file, sqlite3* db);

/// One SQL statement with its parameters, ?1 first.
class Statement {
 public:
  Statement(const std::filesystem::path& file, sqlite3* db, const std::string& sql);
  Statement& bind(int at, const std::string& text);
  Statement& bind(int at, std::int64_t number);
  Statement& bind(int at, double number);  // NaN becomes NULL
  /// Returns true while there is a row.
  bool step();
  /// Steps to the end and resets the statement for other parameters.
  void run();

  std::string text(int column) const;
  std::int64_t integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }
  double real(int column) const;  // NULL becomes NaN

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* s) const { sqlite3_finalize(s); }
  };
  void check(int code) const;
  const std::filesystem::path& file_;
  sqlite3* db_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

void run(const std::filesystem::path& file, sqlite3* db, const std::string& sql);

/// Rolled back unless committed. A reading transaction sees a consistent snapshot.
class Transaction {
 public:
  enum class Kind { write, read };
  Transaction(const std::filesystem::path& file, sqlite3* db, Kind kind = Kind::write);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  const std::filesystem::path& file_;
  sqlite3* db_;
  bool committed_ = false;
};

}  // namespace karst::campaign::sqlite
