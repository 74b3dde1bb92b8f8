#include "sdk/evaluation/record/table.h"

#include <algorithm>

#include "sdk/evaluation/record/lines.h"

namespace karst::evaluation {
namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::size_t begin = 0;
  for (std::size_t end; (end = line.find(',', begin)) != std::string::npos; begin = end + 1)
    cells.push_back(line.substr(begin, end - begin));
  cells.push_back(line.substr(begin));
  return cells;
}

}  // namespace

const std::vector<double>* Table::column(const std::string& name) const {
  const auto found = numbers.find(name);
  return found == numbers.end() ? nullptr : &found->second;
}

const std::vector<double>* Table::times() const { return column("t_s") ? column("t_s") : column("time_s"); }

Table read_table(const std::filesystem::path& file, const std::vector<std::string>& text_columns,
                 std::vector<std::string>& problems) {
  Table table;
  const std::vector<std::string> lines = read_lines(file, problems);
  if (lines.empty()) return table;
  const std::vector<std::string> names = split(lines[0]);
  std::vector<bool> is_text(names.size());
  std::vector<std::vector<double>*> numbers(names.size());
  std::vector<std::vector<std::string>*> text(names.size());
  for (std::size_t c = 0; c < names.size(); ++c) {
    is_text[c] = std::find(text_columns.begin(), text_columns.end(), names[c]) != text_columns.end();
    if (is_text[c]) text[c] = &table.text[names[c]];
    if (!is_text[c]) numbers[c] = &table.numbers[names[c]];
  }
  BadLines bad(file);
  std::vector<double> values(names.size());
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::vector<std::string> cells = split(lines[i]);
    if (cells.size() != names.size()) {
      bad.add(i + 1, "has " + std::to_string(cells.size()) + " cells where the header has " +
                         std::to_string(names.size()));
      continue;
    }
    std::size_t c = 0;
    while (c < cells.size() && (is_text[c] || parse_number(cells[c], values[c]))) ++c;
    if (c < cells.size()) {
      bad.add(i + 1, "column " + names[c] + ": \"" + cells[c] + "\" is not a number");
      continue;
    }
    for (c = 0; c < cells.size(); ++c) {
      if (is_text[c]) text[c]->push_back(cells[c]);
      if (!is_text[c]) numbers[c]->push_back(values[c]);
    }
    ++table.rows;
  }
  bad.report(problems);
  return table;
}

}  // namespace karst::evaluation
