// A reader of CSV by the grammar of RFC 4180, section 2, with LF as the end of a line. It refuses all else.
#pragma once
#include <stdexcept>
#include <string>
#include <vector>

namespace karst::test {

inline std::vector<std::vector<std::string>> read_csv(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::size_t at = 0;
  const auto here = [&] { return at < text.size() ? text[at] : '\0'; };
  const auto quoted_cell = [&] {
    std::string cell;
    for (++at;; ++at) {
      if (at >= text.size()) throw std::runtime_error("a quoted cell does not end");
      if (text[at] == '"' && text.compare(at, 2, "\"\"") != 0) break;
      if (text[at] == '"') ++at;  // the first of two
      cell += text[at];
    }
    ++at;
    return cell;
  };
  const auto bare_cell = [&] {
    std::string cell;
    for (; at < text.size() && here() != ',' && here() != '\n'; ++at) {
      if (here() == '"' || here() == '\r') throw std::runtime_error("a cell should be in quotes: " + cell);
      cell += here();
    }
    return cell;
  };
  while (at < text.size()) {
    std::vector<std::string>& row = rows.emplace_back();
    for (char end = ','; end != '\n'; ++at) {
      row.push_back(here() == '"' ? quoted_cell() : bare_cell());
      if (at >= text.size()) throw std::runtime_error("the last line does not end");
      end = here();
      if (end != ',' && end != '\n') throw std::runtime_error("text behind a quoted cell: " + row.back());
    }
  }
  return rows;
}

}  // namespace karst::test
