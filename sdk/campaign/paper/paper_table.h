// A table of a paper as a value: what stands in it, in whatever language it is written.
#pragma once
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace karst::campaign {

enum class Aligned { left, right };

struct PaperColumn {
  std::string heading;
  std::string unit = {};  // "" if it has none
  Aligned aligned = Aligned::right;
};

/// Plain text. The numbers of a column have the same number of decimals: aligned to the right, their points
/// stand below one another.
struct PaperCell {
  std::string text;
  bool bold = false;
};

struct PaperTable {
  std::string label;  // by which LaTeX refers to it
  std::string caption;
  std::vector<PaperColumn> columns;
  std::vector<std::vector<PaperCell>> rows;  // each with a cell for every column
};

/// The headings and then the rows, written by the two functions, with the texts of a column padded to one
/// width of at least `min_width`.
std::vector<std::vector<std::string>> laid_out(const PaperTable& table, std::size_t min_width,
                                               const std::function<std::string(const PaperColumn&)>& heading,
                                               const std::function<std::string(const PaperCell&)>& cell);

}  // namespace karst::campaign
