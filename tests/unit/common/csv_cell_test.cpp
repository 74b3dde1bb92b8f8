#include "core_stack/common/csv_cell.h"

#include <gtest/gtest.h>

#include "core_stack/common/random.h"
#include "tests/unit/common/csv_reader.h"

namespace karst::core {
namespace {

TEST(CsvCell, IsInQuotesOnlyWhereItMustBe) {
  EXPECT_EQ(csv_cell("landed; 62 % left"), "landed; 62 % left");
  EXPECT_EQ(csv_cell(""), "");
  EXPECT_EQ(csv_cell(" a\tb "), " a\tb ");
  EXPECT_EQ(csv_cell("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_cell("say \"no\""), "\"say \"\"no\"\"\"");
  EXPECT_EQ(csv_cell("two\nlines\r"), "\"two\nlines\r\"");
}

TEST(CsvCell, ControlCharactersBecomeBlanks) {
  EXPECT_EQ(csv_cell("a\033[2Jb"), "a [2Jb");
  EXPECT_EQ(csv_cell(std::string("a\0b", 3)), "a b");
}

TEST(CsvCell, AnyRowsAreReadBackAsTheyWere) {
  const std::string letters = "ab ,;\"\n\r\t'";
  Random random(3);
  const auto draw = [&](double most) { return static_cast<std::size_t>(random.uniform(0, most)); };
  for (int round = 0; round < 500; ++round) {
    std::vector<std::vector<std::string>> rows(1 + draw(4));
    std::string text;
    for (std::vector<std::string>& row : rows) {
      row.resize(1 + draw(5));
      for (std::string& cell : row) {
        for (std::size_t n = draw(6); n > 0; --n) cell += letters[draw(static_cast<double>(letters.size()))];
        text += (&cell == &row.front() ? "" : ",") + csv_cell(cell);
      }
      text += "\n";
    }
    EXPECT_EQ(test::read_csv(text), rows) << text;
  }
}

TEST(CsvReader, RefusesWhatIsNoCsv) {
  for (const char* bad : {"a", "\"a\n", "a\"b\n", "\"a\"b\n", "a\rb\n"})
    EXPECT_THROW(test::read_csv(bad), std::runtime_error) << bad;
}

}  // namespace
}  // namespace karst::core
