#include "sdk/evaluation/report/cloud.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <map>

#include "sdk/evaluation/page/base64.h"
#include "sdk/evaluation/page/decimate.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::evaluation {
namespace {

using core::CellKey;
using core::Vec3;
using test::TemporaryDirectory;

std::string record(std::int32_t x, std::int32_t y, std::int32_t z, std::int32_t t) {
  const std::int32_t r[4] = {x, y, z, t};
  return {reinterpret_cast<const char*>(r), sizeof r};
}

TEST(MapGrowth, GivesTheSpansOverWhichACellWasOccupied) {
  TemporaryDirectory dir;
  dir.write("g.bin",
            record(1, 2, 3, 100) + record(-5, 0, 0, 150) + record(1, 2, 3, -200) + record(1, 2, 3, 400));
  std::vector<std::string> problems;
  const auto spans = read_map_growth(dir.path() / "g.bin", problems);
  EXPECT_TRUE(problems.empty());
  ASSERT_EQ(spans.size(), 3u);
  EXPECT_EQ(spans[0].key, (CellKey{-5, 0, 0}));
  EXPECT_EQ(spans[0].until_ms, OccupiedSpan::kNever);
  EXPECT_EQ(spans[1].from_ms, 100);
  EXPECT_EQ(spans[1].until_ms, 200);
  EXPECT_EQ(spans[2].from_ms, 400);
}

TEST(MapGrowth, UsesACutFileUpToTheCut) {
  TemporaryDirectory dir;
  dir.write("g.bin", record(1, 2, 3, 100) + record(4, 2, 3, 100).substr(0, 9));
  std::vector<std::string> problems;
  EXPECT_EQ(read_map_growth(dir.path() / "g.bin", problems).size(), 1u);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0], "g.bin: byte 16: a record is cut off; only those before it are used");
}

TEST(MapGrowth, LeavesOutCellsThatCannotBe) {
  TemporaryDirectory dir;
  dir.write("g.bin", record(INT32_MAX, 2, 3, 100) + record(1, 2, INT32_MIN, 100) +
                         record(1, 2, 3, INT32_MIN) + record(1, 2, 3, 7));
  std::vector<std::string> problems;
  EXPECT_EQ(read_map_growth(dir.path() / "g.bin", problems).size(), 1u);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0], "g.bin: 2 records name cells out of this world; left out");
}

TEST(MapGrowth, TakesAnyBytes) {
  rc::check("no input crashes the reader", [](const std::string& bytes) {
    TemporaryDirectory dir;
    dir.write("g.bin", bytes + bytes + bytes);
    std::vector<std::string> problems;
    const auto spans = read_map_growth(dir.path() / "g.bin", problems);
    RC_ASSERT(spans.size() <= 3 * bytes.size() / 16);
    make_cloud(spans, 0.2, 100, {});
  });
}

/// Cells of the floor z = 0 and the wall x = 20, seen from a place between them.
std::vector<OccupiedSpan> floor_and_wall() {
  std::vector<OccupiedSpan> spans;
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y) spans.push_back({{x, y, 0}, 1000, OccupiedSpan::kNever});
  for (int z = 0; z < 20; ++z)
    for (int y = 0; y < 20; ++y) spans.push_back({{20, y, z}, 2000, OccupiedSpan::kNever});
  return spans;
}

TEST(Cloud, NormalsPointFromTheSurfaceToWhereItWasSeenFrom) {
  const std::vector<StampedPose> pose{{0, {Vec3(2, 2, 2), core::Quat::Identity()}}};
  const Cloud cloud = make_cloud(floor_and_wall(), 0.2, 100000, pose);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const CellKey& k = cloud.points[i].key;
    const auto& n = cloud.normals[i];
    using Packed = std::array<std::int8_t, 3>;
    if (k.z == 0 && k.x < 17) {
      EXPECT_EQ(n, (Packed{0, 0, 127})) << k.x << " " << k.y;
    } else if (k.x == 20 && k.z > 3) {
      EXPECT_EQ(n, (Packed{-127, 0, 0})) << k.y << " " << k.z;
    }
  }
}

TEST(Cloud, MergesCellsUntilFewEnoughAndKeepsTheEarliestTime) {
  rc::check("each merged cell covers its parts in place and time", [] {
    const auto cells = *rc::gen::container<std::vector<std::tuple<int, int, int, int>>>(
        rc::gen::tuple(rc::gen::inRange(-20, 20), rc::gen::inRange(-20, 20), rc::gen::inRange(-20, 20),
                       rc::gen::inRange(0, 100000)));
    std::map<CellKey, std::int32_t> unique;
    for (const auto& [x, y, z, t] : cells) unique.emplace(CellKey{x, y, z}, t);
    std::vector<OccupiedSpan> spans;
    for (const auto& [k, t] : unique) spans.push_back({k, t, OccupiedSpan::kNever});
    const std::size_t most = 8;
    const Cloud cloud = make_cloud(spans, 0.2, most, {});
    RC_ASSERT(cloud.points.size() <= most);
    const int factor = static_cast<int>(std::lround(cloud.cell_m / 0.2));
    std::map<CellKey, std::int32_t> expected;  // by division instead of by halving
    const auto down = [&](int v) { return static_cast<std::int32_t>(std::floor(double(v) / factor)); };
    for (const auto& [k, t] : unique) {
      const auto [at, fresh] = expected.emplace(CellKey{down(k.x), down(k.y), down(k.z)}, t);
      if (!fresh) at->second = std::min(at->second, t);
    }
    RC_ASSERT(expected.size() == cloud.points.size());
    for (const OccupiedSpan& p : cloud.points) RC_ASSERT(expected.at(p.key) == p.from_ms);
  });
}

TEST(Cloud, LeavesOutCellsThatOnlyFlickered) {
  const std::vector<OccupiedSpan> spans{
      {{0, 0, 0}, 100, 900}, {{1, 0, 0}, 100, 9000}, {{2, 0, 0}, 100, OccupiedSpan::kNever}};
  EXPECT_EQ(make_cloud(spans, 0.2, 100, {}).points.size(), 2u);
}

TEST(Decimate, KeepsEveryPeakAndBothEnds) {
  rc::check("least, greatest, first and last survive; kept samples are of the curve, in order", [] {
    const auto y = *rc::gen::nonEmpty(rc::gen::container<std::vector<double>>(
        rc::gen::map(rc::gen::inRange(-1000, 1000), [](int v) { return v * 0.5; })));
    std::vector<double> many, x;
    for (int i = 0; i < 400; ++i) many.push_back(y[static_cast<std::size_t>(i * 7919) % y.size()]);
    for (std::size_t i = 0; i < many.size(); ++i) x.push_back(static_cast<double>(i));
    const Curve c = decimate(x, many, 40);
    RC_ASSERT(c.x.size() <= 40u);
    RC_ASSERT(c.x.front() == x.front() && c.x.back() == x.back());
    RC_ASSERT(*std::min_element(c.y.begin(), c.y.end()) == *std::min_element(many.begin(), many.end()));
    RC_ASSERT(*std::max_element(c.y.begin(), c.y.end()) == *std::max_element(many.begin(), many.end()));
    for (std::size_t i = 0; i < c.x.size(); ++i) {
      RC_ASSERT(c.y[i] == many[static_cast<std::size_t>(c.x[i])]);
      if (i > 0) RC_ASSERT(c.x[i] > c.x[i - 1]);  // RC_ASSERT evaluates both sides of ||
    }
  });
}

TEST(Base64, GivesTheStandardsExamples) {
  const auto encode = [](std::string s) { return base64_of(std::vector<char>(s.begin(), s.end())); };
  EXPECT_EQ(encode(""), "");
  EXPECT_EQ(encode("f"), "Zg==");
  EXPECT_EQ(encode("fo"), "Zm8=");
  EXPECT_EQ(encode("foo"), "Zm9v");
  EXPECT_EQ(encode("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64_of(std::vector<std::int16_t>{-1, 258}), "//8CAQ==");
}

}  // namespace
}  // namespace karst::evaluation
