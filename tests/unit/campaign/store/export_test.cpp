#include "sdk/campaign/store/export.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "sdk/evaluation/record/whole_file.h"
#include "sdk/host/isolation/process.h"
#include "tests/unit/campaign/store/store_fixture.h"

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

TEST(Export, AwkReadsEveryCellOfTheCsv) {
  const fs::path store = small_store("csv"), csv = store.parent_path() / "trials.csv";
  std::ofstream out(csv);
  const auto [results, extras] = read_with_extras(store);
  write_csv(out, results, extras);
  out.close();
  const auto awk = [&](const std::string& program) {
    return run_process({"/usr/bin/awk", "-F,", program, csv.string()}, 100).out;
  };
  const std::size_t columns = 8 + evaluation::metric_definitions().size() + 3 + 9 + 1;
  EXPECT_EQ(awk("{ print NF }"), [&] {
    std::string n = std::to_string(columns) + "\n";
    return n + n + n + n;
  }());
  EXPECT_EQ(awk("NR > 1 { print $1, $3, $4, $5 }"),
            "near maze 2 done\nhigh shaft 1 done\nhigh shaft 9 failed\n");
  EXPECT_EQ(awk("NR == 3 { print $8 }"), "home after 1 s: the pose was lost; 'twice'\n");
  const double wanted = trial_of(2, 1, 1).result.figures[0];
  EXPECT_EQ(std::stod(awk("NR == 3 { print $9 }")), std::stod(std::to_string(wanted)));
  EXPECT_EQ(awk("NR == 3 { print ($12 == \"\") }"), "1\n") << "not known is empty";
}

TEST(Export, TheJsonHoldsEverything) {
  const fs::path store = small_store("json");
  std::ostringstream out;
  const auto [results, extras] = read_with_extras(store);
  write_json(out, results, extras);
  const auto json = nlohmann::json::parse(out.str());
  EXPECT_EQ(json["schema"], "karst.results/1");
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
