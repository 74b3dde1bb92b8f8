#include "sdk/campaign/paper/markdown.h"

#include "core_stack/common/character_count.h"
#include "core_stack/common/printable.h"
#include "sdk/campaign/paper/printed_figure.h"

namespace karst::campaign {
namespace {

constexpr std::string_view kMarkup = "\\`*_{}[]<>#|~$&";

std::string row_text(const std::vector<std::string>& cells) {
  std::string out = "|";
  for (const std::string& cell : cells) out += " " + cell + " |";
  return out + "\n";
}

}  // namespace

std::string markdown_text(std::string_view plain) {
  std::string out;
  for (const char c : core::printable(plain)) {
    if (kMarkup.find(c) != std::string_view::npos) out += '\\';
    out += c == '\n' || c == '\t' ? ' ' : c;
  }
  return out;
}

std::string markdown_table(const PaperTable& table) {
  constexpr std::size_t kRule = 3;  // "--:" is the shortest that every reader takes
  const auto grid = laid_out(
      table, kRule, [](const PaperColumn& c) { return markdown_text(with_unit(c.heading, c.unit)); },
      [](const PaperCell& c) {
        return c.bold ? "**" + markdown_text(c.text) + "**" : markdown_text(c.text);
      });
  std::vector<std::string> rules;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const bool right = table.columns[c].aligned == Aligned::right;
    const std::string dashes(core::character_count(grid.front()[c]) - 1, '-');
    rules.push_back(right ? dashes + ":" : ":" + dashes);
  }
  std::string out =
      "**Table:** " + markdown_text(table.caption) + "\n\n" + row_text(grid.front()) + row_text(rules);
  for (std::size_t i = 1; i < grid.size(); ++i) out += row_text(grid[i]);
  return out;
}

}  // namespace karst::campaign
