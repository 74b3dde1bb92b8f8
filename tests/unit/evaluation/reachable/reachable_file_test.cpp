// What is kept of a cave is what is found anew; what is damaged or of another cave is not used.
#include "sdk/evaluation/reachable/reachable_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/unit/evaluation/reachable/boxes.h"

namespace karst::evaluation {
namespace {

namespace fs = std::filesystem;
using core::Vec3;

cave::TriangleMesh room(int length) {
  std::set<std::array<int, 3>> cells;
  test::fill(cells, {0, 0, 0}, {length, 4, 3});
  return test::lattice_mesh(cells, 1.0, Vec3(0.03, -0.07, 0.05));
}

void expect_same(const Reachable& a, const Reachable& b) {
  for (const auto set : {&Reachable::free, &Reachable::flyable, &Reachable::reachable}) {
    std::vector<CellKey> in_a, in_b;
    (a.*set).for_each([&](const CellKey& k) { in_a.push_back(k); });
    (b.*set).for_each([&](const CellKey& k) { in_b.push_back(k); });
    EXPECT_EQ(in_a, in_b);
  }
  EXPECT_EQ(a.free_cells, b.free_cells);
  EXPECT_EQ(a.flyable_cells, b.flyable_cells);
  EXPECT_EQ(a.volume_m3(), b.volume_m3());
}

std::string content(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

struct ReachableFile : ::testing::Test {
  fs::path folder = fs::temp_directory_path() / ("karst-reachable-" + std::to_string(getpid()));
  Vec3 start{1.5, 2, 1.5};
  void SetUp() override { fs::remove_all(folder); }
  void TearDown() override { fs::remove_all(folder); }

  Reachable once(const cave::TriangleMesh& mesh, const Vec3& from, const ReachableOptions& o = {}) const {
    return find_reachable_once(mesh, from, o, "room", folder);
  }
  std::vector<fs::path> files() const {
    std::vector<fs::path> out;
    for (const auto& entry : fs::directory_iterator(folder)) out.push_back(entry.path());
    return out;
  }
};

TEST_F(ReachableFile, TheSameIsFoundAndKeptOnce) {
  const auto mesh = room(5);
  expect_same(once(mesh, start), find_reachable(mesh, start, {}, "room"));
  ASSERT_EQ(files().size(), 1u);
  const auto written = fs::last_write_time(files().front());
  expect_same(once(mesh, start), find_reachable(mesh, start, {}, "room"));
  EXPECT_EQ(fs::last_write_time(files().front()), written) << "it was read, not written again";
}

TEST_F(ReachableFile, AnotherCaveStartOrOptionIsAnotherFile) {
  once(room(5), start);
  const auto longer = room(6);
  expect_same(once(longer, start), find_reachable(longer, start, {}, "room"));
  once(longer, start + Vec3(0.5, 0, 0));
  ReachableOptions coarse;
  coarse.resolution_m = 0.25;
  expect_same(once(longer, start, coarse), find_reachable(longer, start, coarse, "room"));
  EXPECT_EQ(files().size(), 4u);
}

TEST_F(ReachableFile, AFileUnderAnothersNameIsNotUsed) {
  const auto mesh = room(5), other = room(6);
  once(mesh, start), once(other, start);
  ASSERT_EQ(files().size(), 2u);
  const std::string first = content(files()[0]), second = content(files()[1]);
  std::ofstream(files()[0], std::ios::binary) << second;
  std::ofstream(files()[1], std::ios::binary) << first;
  expect_same(once(mesh, start), find_reachable(mesh, start, {}, "room"));
}

TEST_F(ReachableFile, AnyDamageIsNoticed) {
  const auto mesh = room(5);
  const Reachable truth = once(mesh, start);
  const fs::path file = files().front();
  const std::string whole = content(file);
  for (std::size_t at = 0; at < whole.size(); at += whole.size() / 61 + 1) {
    std::string bad = whole;
    bad[at] = static_cast<char>(bad[at] ^ 0x10);
    std::ofstream(file, std::ios::binary) << bad;
    expect_same(once(mesh, start), truth);
    EXPECT_EQ(content(file), whole) << "and mended";
  }
  for (const std::size_t size : {std::size_t{0}, std::size_t{7}, whole.size() / 2, whole.size() - 1}) {
    std::ofstream(file, std::ios::binary) << whole.substr(0, size);
    expect_same(once(mesh, start), truth);
  }
}

TEST_F(ReachableFile, AFolderInTheFilesPlaceIsDoneWithout) {
  const auto mesh = room(5);
  once(mesh, start);
  const fs::path file = files().front();
  fs::remove(file);
  fs::create_directories(file / "full");
  expect_same(once(mesh, start), find_reachable(mesh, start, {}, "room"));
  EXPECT_EQ(files().size(), 1u) << "nothing half done is left";
}

TEST_F(ReachableFile, AFolderThatCannotBeWrittenIsDoneWithout) {
  std::ofstream(folder.string()) << "a file";
  const auto mesh = room(5);
  expect_same(once(mesh, start), find_reachable(mesh, start, {}, "room"));
}

}  // namespace
}  // namespace karst::evaluation
