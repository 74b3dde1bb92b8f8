#include "sdk/campaign/store/export.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "sdk/evaluation/record/whole_file.h"
#include "sdk/host/isolation/process.h"
#include "tests/unit/campaign/store/store_fixture.h"
#include "tests/unit/common/csv_reader.h"

namespace karst::campaign {
namespace {

using host::run_process;

fs::path small_store(const std::string& name) {
  const fs::path file = fresh_folder(name) / "campaign.sqlite";
  Store store = Store::create(file, small_head());
  for (const std::int64_t seed : {1, 9}) store.add(trial_of(2, 1, seed));
  store.add(trial_of(0, 0, 2));
  return file;
}

TEST(Export, IntoADeviceLeavesItADevice) {
  const std::string error = error_of([] { evaluation::write_whole_file("/dev/full", "a,b\n"); });
  EXPECT_TRUE(says(error, "/dev/full: cannot be written: No space left on device")) << error;
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
  EXPECT_FALSE(fs::exists("/dev/full.part"));
}

/// Writes the store's trials beside it.
fs::path exported(const fs::path& store) {
  const fs::path csv = store.parent_path() / "trials.csv";
  std::ofstream out(csv);
  const auto [results, extras] = read_with_extras(store);
  write_csv(out, results, extras);
  return csv;
}

// Commas became semicolons, quotes apostrophes, and line ends blanks.
TEST(Export, TheCsvHoldsEveryCellAsItWas) {
  const fs::path csv = exported(small_store("csv"));
  std::ifstream in(csv);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  const std::vector<std::vector<std::string>> rows = test::read_csv(text);
  ASSERT_EQ(rows.size(), 4u);
  const std::size_t figures = evaluation::metric_definitions().size();
  for (const std::vector<std::string>& row : rows) ASSERT_EQ(row.size(), 8 + figures + 3 + 9 + 1);
  const auto beginning = [&](std::size_t row) {
    return std::vector<std::string>(rows[row].begin(), rows[row].begin() + 8);
  };
  using Words = std::vector<std::string>;
  EXPECT_EQ(beginning(0),
            (Words{"contestant", "policy", "cave", "seed", "status", "outcome", "reason", "ended"}));
  const std::string reason = trial_of(0, 0, 2).result.reason;
  EXPECT_NE(reason.find_first_of(","), std::string::npos) << "nothing is tested";
  const std::string ended = trial_of(2, 1, 1).result.ended;
  EXPECT_EQ(beginning(1),
            (Words{"near", "policy", "maze", "2", "done", "landed", reason, trial_of(0, 0, 2).result.ended}));
  EXPECT_EQ(beginning(2), (Words{"high", "policy", "shaft", "1", "done", "landed", reason, ended}));
  EXPECT_EQ(beginning(3), (Words{"high", "policy", "shaft", "9", "failed", "failed", reason,
                                 trial_of(2, 1, 9).result.ended}));
  EXPECT_EQ(std::stod(rows[2][8]), trial_of(2, 1, 1).result.figures[0]);
  EXPECT_EQ(rows[2][11], "") << "not known is empty";
  EXPECT_EQ(rows[2].back(), (csv.parent_path() / "trials/2/1/1").string());
  EXPECT_EQ(text.find('\r'), std::string::npos) << "lines end with LF";
}

TEST(Export, SqliteImportsTheCsv) {
  const fs::path csv = exported(small_store("sqlite"));
  const auto asked = [&](const std::string& query) {
    return run_process(
               {"/usr/bin/sqlite3", ":memory:", ".import --csv \"" + csv.string() + "\" trial", query}, 100)
        .out;
  };
  EXPECT_EQ(asked("SELECT contestant, cave, seed, status FROM trial"),
            "near|maze|2|done\nhigh|shaft|1|done\nhigh|shaft|9|failed\n");
  EXPECT_EQ(asked("SELECT count(*) FROM trial WHERE reason = 'a reason, with \"quotes\"' || char(10)"),
            "3\n");
  EXPECT_EQ(asked("SELECT DISTINCT run_dir FROM trial WHERE cave = 'maze'"),
            (csv.parent_path() / "trials/0/0/2").string() + "\n");
}

TEST(Export, TheJsonHoldsEverything) {
  const fs::path store = small_store("json");
  std::ostringstream out;
  const auto [results, extras] = read_with_extras(store);
  write_json(out, results, extras, {{"metric", "coverage"}});
  const auto json = nlohmann::json::parse(out.str());
  EXPECT_EQ(json["schema"], "karst.results/1");
  EXPECT_EQ(json["verdict"]["metric"], "coverage");
  ASSERT_EQ(json["trials"].size(), 3u);
  const auto& t = json["trials"][1];
  EXPECT_EQ(t["contestant"], "high");
  EXPECT_EQ(t["ended"], trial_of(2, 1, 1).result.ended);
  EXPECT_EQ(t["curve"].size(), 20u);
  EXPECT_EQ(t["curve"][3][0], 6.0);
  EXPECT_EQ(t["figures"].size(), evaluation::metric_definitions().size());
  EXPECT_EQ(t["figures"][std::string(evaluation::metric_definitions()[0].name)],
            trial_of(2, 1, 1).result.figures[0]);
  EXPECT_TRUE(t["figures"][std::string(evaluation::metric_definitions()[3].name)].is_null());
  EXPECT_EQ(t["timing"]["machine"], "here");
}

}  // namespace
}  // namespace karst::campaign
