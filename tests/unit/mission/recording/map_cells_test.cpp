#include "core_stack/mission/recording/map_cells.h"

#include <gtest/gtest.h>

#include "core_stack/common/random.h"

namespace karst::core {
namespace {

TEST(MapCells, ARecordIsReadAsItWasWritten) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const auto key = [&] { return static_cast<std::int32_t>(random.uniform(-32768, 32767)); };
    const MapCellRecord record{{key(), key(), key()},
                               static_cast<Cell>(static_cast<int>(random.uniform(0, 2.999))),
                               static_cast<std::int32_t>(random.uniform(1, 172'800'000))};
    EXPECT_EQ(map_cell_of(bytes_of(record)), record);
  }
}

TEST(MapCells, TheBytesAreFourLittleEndianNumbers) {
  const MapCellBytes bytes = bytes_of({{1, -1, 256}, Cell::occupied, 250});
  const std::string expected{"\x01\0\0\0\xff\xff\xff\xff\0\x01\0\0\xea\x03\0\0", 16};
  EXPECT_EQ(std::string(std::string_view(bytes)), expected);
}

TEST(MapCells, ZerosAndWhatIsOutOfThisWorldAreNoRecords) {
  EXPECT_FALSE(map_cell_of(std::string(16, '\0')));
  EXPECT_FALSE(map_cell_of(std::string(16, '\xff')));
  EXPECT_FALSE(map_cell_of(std::string(15, '\1')));
  const std::string good{std::string_view(bytes_of({{1, 2, 3}, Cell::free, 5}))};
  ASSERT_TRUE(map_cell_of(good));
  // A power cut leaves zeros from some byte on: the time is last, so the record is none from its first byte
  // on.
  for (std::size_t whole = 0; whole <= 12; ++whole) {
    std::string torn = good;
    std::fill(torn.begin() + static_cast<std::ptrdiff_t>(whole), torn.end(), '\0');
    EXPECT_FALSE(map_cell_of(torn)) << whole;
  }
}

}  // namespace
}  // namespace karst::core
