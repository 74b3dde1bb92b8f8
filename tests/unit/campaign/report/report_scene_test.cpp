// A flight's map as the page carries it, unpacked as its script does, against the map that was flown.
#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <cstring>

#include "sdk/campaign/report/report.h"
#include "sdk/evaluation/metrics/flight_figures.h"
#include "sdk/evaluation/record/run_record.h"
#include "sdk/evaluation/report/cloud.h"
#include "tests/unit/campaign/fake_campaign.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::campaign {
namespace {

std::string bytes_of_base64(const std::string& text) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(letters.find(c));
    if ((count += 6) >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 255);
  }
  return bytes;
}

struct Unpacked {
  std::vector<std::int16_t> steps;   // x of all cells, then y, then z
  std::vector<std::uint16_t> times;  // from of all, then until
  std::vector<std::int8_t> normals;
};

Unpacked unpacked(const nlohmann::json& cloud) {
  const std::string deflated = bytes_of_base64(cloud["packed"]);
  const std::size_t n = cloud["count"];
  std::string bytes(13 * n, '\0');
  uLongf size = bytes.size();
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size,
                       reinterpret_cast<const Bytef*>(deflated.data()), deflated.size()),
            Z_OK);
  EXPECT_EQ(size, bytes.size());
  Unpacked u{std::vector<std::int16_t>(3 * n), std::vector<std::uint16_t>(2 * n),
             std::vector<std::int8_t>(3 * n)};
  std::memcpy(u.steps.data(), bytes.data(), 6 * n);
  std::memcpy(u.times.data(), bytes.data() + 6 * n, 4 * n);
  std::memcpy(u.normals.data(), bytes.data() + 10 * n, 3 * n);
  return u;
}

TEST(ReplayedMap, IsTheOneThatWasFlown) {
  test::TemporaryDirectory dir;
  test::FakeRunOptions small;
  small.length_m = 30;
  small.map_resolution_m = 0.5;
  test::write_fake_run(dir.path() / "run", small);
  CampaignResults results = test::fake_campaign(1, 1, 1);
  results.trials[0].run_dir = (dir.path() / "run").string();
  const nlohmann::json page = campaign_report_data(results, dir.path());
  const nlohmann::json cloud = page["replays"]["scenes"][0]["cloud"];
  const Unpacked u = unpacked(cloud);

  const evaluation::RunRecord run = evaluation::read_run(dir.path() / "run");
  const evaluation::Cloud flown = evaluation::make_cloud(run.growth, 0.5, 100000, run.estimate);
  const double begin_s = evaluation::flight_begin_s(run), tick_s = cloud["tick_s"];
  const std::size_t n = cloud["count"];
  ASSERT_EQ(n, flown.points.size());
  std::array<int, 3> at{};
  for (std::size_t i = 0; i < n; ++i) {
    const core::CellKey& key = flown.points[i].key;
    const std::array<int, 3> keys = {key.x, key.y, key.z};
    for (std::size_t a = 0; a < 3; ++a) {
      at[a] += u.steps[a * n + i];
      EXPECT_NEAR(cloud["origin"][a].get<double>() + 0.5 * at[a], 0.5 * (keys[a] + 0.5), 1e-9);
      EXPECT_NEAR(u.normals[a * n + i], flown.normals[i][a], 8);
    }
    const double from_s = std::max(0.0, flown.points[i].from_ms * 1e-3 - begin_s);
    EXPECT_NEAR(u.times[i] * tick_s, from_s, 0.5 * tick_s + 1e-9);
    EXPECT_EQ(u.times[n + i] == 65535, flown.points[i].until_ms == evaluation::OccupiedSpan::kNever);
  }
}

TEST(ReplayedMap, OfACloudWithALeastCellIsNoFiner) {
  std::vector<evaluation::OccupiedSpan> spans;
  for (int x = 0; x < 16; ++x) spans.push_back({{x, 0, 0}});
  EXPECT_EQ(evaluation::make_cloud(spans, 0.2, 100, {}, 0.2).points.size(), 16u);
  EXPECT_EQ(evaluation::make_cloud(spans, 0.2, 100, {}, 0.8).points.size(), 4u);
  EXPECT_NEAR(evaluation::make_cloud(spans, 0.2, 100, {}, 0.8).cell_m, 0.8, 1e-12);
  EXPECT_TRUE(evaluation::make_cloud({}, 0.2, 100, {}, 0.8).points.empty());
}

}  // namespace
}  // namespace karst::campaign
