// Stores to test with, and their content read by other means than the store's own.
#pragma once
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "sdk/campaign/store/store.h"
#include "sdk/evaluation/metrics/metric_definitions.h"

namespace karst::campaign {

namespace fs = std::filesystem;

/// Of each test its own: they run side by side. (Some ask before any test runs.)
inline fs::path fresh_folder(const std::string& name, const fs::path& root = KARST_BINARY_DIR) {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const fs::path mine =
      test == nullptr ? fs::path(std::to_string(getpid())) : fs::path(test->test_suite_name()) / test->name();
  const fs::path dir = root / "test_runs" / "campaign" / mine / name;
  fs::remove_all(dir);
  fs::create_directories(dir);
  return dir;
}

/// In memory, where the hundreds of transactions of a property do not wait for a disk.
inline fs::path quick_folder(const std::string& name) {
  const bool shared = fs::exists("/dev/shm") && access("/dev/shm", W_OK) == 0;
  return fresh_folder(
      name, fs::path(shared ? "/dev/shm" : KARST_BINARY_DIR) / ("karst-" + std::to_string(getpid())));
}

inline StoreHead small_head() {
  StoreHead head{"small", "name small\n", 300, {}, {}, {1, 2, 3, 9}};
  for (const char* name : {"near", "far", "high"})
    head.contestants.push_back({name, "policy", "1.0.0", "{}", "{}"});
  for (const char* name : {"maze", "shaft"})
    head.caves.push_back({name, std::string("/caves/") + name + ".info", "", "", "abc"});
  return head;
}

/// Every column tells which trial it is of; some figures are not known.
inline StoredTrial trial_of(std::size_t contestant, std::size_t cave, std::int64_t seed) {
  StoredTrial t;
  const auto base = static_cast<double>(100 * contestant + 10 * cave) + static_cast<double>(seed);
  t.result = {
      contestant,
      cave,
      seed,
      seed == 9,
      seed == 9 ? "failed" : "landed",
      "a reason, with \"quotes\"\n",
      "trials/" + std::to_string(contestant) + "/" + std::to_string(cave) + "/" + std::to_string(seed),
      {},
      {},
      "home after " + std::to_string(seed) + " s: the pose was lost, \"twice\""};
  for (std::size_t i = 0; i < evaluation::metric_definitions().size(); ++i)
    t.result.figures.push_back(i % 5 == 3 ? NAN : base + static_cast<double>(i) / 7);
  for (int i = 0; i < 20; ++i) t.result.curve.push_back({2.0 * i, base * i, i / 20.0});
  t.binary_version = "0.1.0+abc";
  t.mission_hash = "hash" + std::to_string(base);
  t.timing.machine = "here";
  t.timing.trial_s = base;
  return t;
}

/// All rows of all tables, as the library reads them in each table's own order, but those of `timing`.
inline std::string dump(const fs::path& file) {
  sqlite3* db = nullptr;
  EXPECT_EQ(sqlite3_open_v2(file.c_str(), &db, SQLITE_OPEN_READONLY, nullptr), SQLITE_OK);
  std::string text;
  const auto line = [](void* out, int columns, char** values, char**) {
    for (int i = 0; i < columns; ++i)
      *static_cast<std::string*>(out) += std::string(values[i] ? values[i] : "NULL") + "|";
    *static_cast<std::string*>(out) += "\n";
    return 0;
  };
  for (const char* table : {"sqlite_master", "campaign", "contestant", "cave", "trial", "curve", "result"})
    EXPECT_EQ(sqlite3_exec(db, (std::string("SELECT * FROM ") + table).c_str(), line, &text, nullptr),
              SQLITE_OK);
  sqlite3_close(db);
  return text;
}

/// What an action complains of; "" if it does not.
template <class Action>
std::string error_of(Action action) {
  try {
    action();
  } catch (const std::exception& e) {
    return e.what();
  }
  return "";
}

inline bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace karst::campaign
