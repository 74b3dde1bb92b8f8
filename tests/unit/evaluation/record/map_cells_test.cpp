#include "sdk/evaluation/record/map_cells.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "core_stack/common/random.h"
#include "core_stack/common/temporary_folder.h"
#include "core_stack/mission/recording/map_cells.h"
#include "sdk/evaluation/record/map_growth.h"

namespace karst::evaluation {
namespace {

using core::Cell;
using core::CellKey;

std::string bytes_of(const std::vector<core::MapCellRecord>& records) {
  std::string bytes;
  for (const auto& r : records) bytes += std::string_view(core::bytes_of(r));
  return bytes;
}

std::vector<core::MapCellRecord> some_records(int count) {
  core::Random random(3);
  std::vector<core::MapCellRecord> records;
  for (int i = 0; i < count; ++i) {
    const auto near = [&] { return static_cast<std::int32_t>(random.uniform(-6, 6)); };
    records.push_back(
        {{near(), near(), near()}, static_cast<Cell>(static_cast<int>(random.uniform(0, 2.999))), 100 + i});
  }
  return records;
}

struct CellsFile : testing::Test {
  core::TemporaryFolder folder{"map-cells"};
  std::vector<std::string> problems;
  std::optional<core::VoxelMap> read(const std::string& bytes) {
    const auto file = folder.path() / "map_cells.bin";
    std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
    problems.clear();
    return read_map_cells(file, 0.2, problems);
  }
};

/// The oracle replays the records one by one.
void expect_as_after(const std::vector<core::MapCellRecord>& records, const core::VoxelMap& map) {
  std::map<CellKey, Cell> cells;
  for (const auto& r : records) cells[r.key] = r.cell;
  std::size_t known = 0;
  for (const auto& [key, cell] : cells) {
    EXPECT_EQ(map.at(key), cell);
    known += cell != Cell::unknown;
  }
  EXPECT_EQ(map.free_cells() + map.occupied_cells(), known);
}

TEST_F(CellsFile, TheMapIsThatOfTheLastRecordOfEachCell) {
  const auto records = some_records(3000);
  const auto map = read(bytes_of(records));
  ASSERT_TRUE(map);
  EXPECT_TRUE(problems.empty());
  expect_as_after(records, *map);
}

// Wherever the power was cut, and whatever stands behind the last byte that reached the disk.
TEST_F(CellsFile, CutAtAnyByteOrWithZerosBehindItTheMapIsThatOfTheRecordsBefore) {
  const auto records = some_records(4);
  const std::string whole = bytes_of(records);
  for (std::size_t cut = 0; cut <= whole.size(); ++cut) {
    const std::vector<core::MapCellRecord> before(records.begin(),
                                                  records.begin() + static_cast<std::ptrdiff_t>(cut / 16));
    for (const std::size_t zeros : {0u, 5u, 4096u}) {
      const std::string left = whole.substr(0, cut) + std::string(zeros, '\0');
      const auto map = read(left);
      bool damaged = left.size() % 16 != 0;
      for (std::size_t at = 12; at + 4 <= left.size(); at += 16)
        damaged = damaged || left.substr(at, 4) == std::string(4, '\0');
      EXPECT_EQ(!problems.empty(), damaged) << cut << " bytes and " << zeros << " zeros";
      // Where only zero bytes of the time are lost, the record is whole all the same.
      if (map && cut % 16 < 13) expect_as_after(before, *map);
    }
  }
}

TEST_F(CellsFile, NothingIsNoMap) {
  EXPECT_FALSE(read(""));
  EXPECT_FALSE(read(std::string(1600, '\0')));
  EXPECT_EQ(problems.size(), 1u);
  EXPECT_FALSE(read_map_cells(folder.path() / "no_such_file", 0.2, problems));
}

TEST_F(CellsFile, ZerosBehindTheGrowthOfAMapAreNoCell) {
  const auto file = folder.path() / "map_growth.bin";
  std::ofstream(file, std::ios::binary)
      << std::string("\1\0\0\0\2\0\0\0\3\0\0\0\x64\0\0\0", 16) << std::string(64, '\0');
  const auto spans = read_map_growth(file, problems);
  ASSERT_EQ(spans.size(), 1u);
  EXPECT_EQ(spans[0].key, (CellKey{1, 2, 3}));
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].find("4 records were never written"), std::string::npos) << problems[0];
}

}  // namespace
}  // namespace karst::evaluation
