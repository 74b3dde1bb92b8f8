#include "sdk/campaign/paper/paper_table.h"

#include <algorithm>

#include "core_stack/common/character_count.h"

namespace karst::campaign {

std::vector<std::vector<std::string>> laid_out(const PaperTable& table, std::size_t min_width,
                                               const std::function<std::string(const PaperColumn&)>& heading,
                                               const std::function<std::string(const PaperCell&)>& cell) {
  std::vector<std::vector<std::string>> grid(1);
  for (const PaperColumn& column : table.columns) grid.front().push_back(heading(column));
  for (const auto& row : table.rows) {
    auto& line = grid.emplace_back();
    for (const PaperCell& c : row) line.push_back(cell(c));
  }
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    std::size_t width = min_width;
    for (const auto& line : grid) width = std::max(width, core::character_count(line[c]));
    for (auto& line : grid) {
      const std::string blanks(width - core::character_count(line[c]), ' ');
      line[c] = table.columns[c].aligned == Aligned::right ? blanks + line[c] : line[c] + blanks;
    }
  }
  return grid;
}

}  // namespace karst::campaign
