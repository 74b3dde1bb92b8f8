#include "sdk/campaign/paper/paper_table.h"

#include <algorithm>

namespace karst::campaign {

std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

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
    for (const auto& line : grid) width = std::max(width, width_of(line[c]));
    for (auto& line : grid) {
      const std::string blanks(width - width_of(line[c]), ' ');
      line[c] = table.columns[c].aligned == Aligned::right ? blanks + line[c] : line[c] + blanks;
    }
  }
  return grid;
}

}  // namespace karst::campaign
