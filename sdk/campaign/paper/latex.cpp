#include "sdk/campaign/paper/latex.h"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "core_stack/common/printable.h"

namespace karst::campaign {
namespace {

constexpr std::size_t kHeadingWidth = 14;  // characters after which a heading goes on in another line

struct Escape {
  std::string_view plain, latex;
};
// [ and * could be read as options of the end of a row before them. The usual fonts have neither the minus
// sign nor the raised 3 as a letter; the quotes' commands need no other font encoding.
constexpr Escape kEscapes[] = {
    {"\\", "\\textbackslash{}"},
    {"{", "\\{"},
    {"}", "\\}"},
    {"$", "\\$"},
    {"&", "\\&"},
    {"#", "\\#"},
    {"%", "\\%"},
    {"_", "\\_"},
    {"^", "\\textasciicircum{}"},
    {"~", "\\textasciitilde{}"},
    {"<", "\\textless{}"},
    {">", "\\textgreater{}"},
    {"|", "\\textbar{}"},
    {"\"", "\\symbol{34}"},
    {"`", "\\textasciigrave{}"},
    {"[", "{[}"},
    {"*", "{*}"},
    {"\n", " "},
    {"\t", " "},
    {"\u2212", "$-$"},
    {"\u2013", "\\textendash{}"},
    {"\u2020", "\\textdagger{}"},
    {"\u2021", "\\textdaggerdbl{}"},
    {"\u00B3", "$^3$"},
};

/// Of these, two in a row would become a dash or a quotation mark.
constexpr std::string_view kJoining = "-',";

/// The words in lines of about a heading's width.
std::string heading_text(const PaperColumn& column) {
  std::istringstream words(column.heading);
  std::string text, word;
  std::size_t in_line = 0;
  bool broken = false;
  while (words >> word) {
    const bool breaks = in_line > 0 && in_line + 1 + word.size() > kHeadingWidth;
    text += (in_line == 0 ? "" : breaks ? "\\\\" : " ") + latex_text(word);
    in_line = breaks || in_line == 0 ? word.size() : in_line + 1 + word.size();
    broken = broken || breaks;
  }
  if (!column.unit.empty()) {
    text += (broken ? "\\\\(" : " (") + latex_text(column.unit) + ")";
  }
  if (!broken) return text;
  return std::string("\\shortstack[") + (column.aligned == Aligned::right ? "r" : "l") + "]{" + text + "}";
}

/// Letters, digits and hyphens, which a label may consist of.
std::string plain_label(const std::string& label) {
  std::string plain;
  for (const char c : label) plain += std::isalnum(static_cast<unsigned char>(c)) ? c : '-';
  return plain;
}

void write_line(std::string& out, const std::vector<std::string>& cells) {
  out += "    ";
  for (std::size_t i = 0; i < cells.size(); ++i) out += (i == 0 ? "" : " & ") + cells[i];
  out += " \\\\\n";
}

}  // namespace

std::string latex_text(std::string_view plain) {
  const std::string text = core::printable(plain);
  std::string_view rest = text;
  std::string out;
  while (!rest.empty()) {
    const auto escape = std::find_if(std::begin(kEscapes), std::end(kEscapes),
                                     [&](const Escape& e) { return rest.starts_with(e.plain); });
    if (escape != std::end(kEscapes)) {
      out += escape->latex;
      rest.remove_prefix(escape->plain.size());
      continue;
    }
    out += rest.front();
    const bool joins = kJoining.find(rest.front()) != std::string_view::npos;
    if (joins && rest.size() > 1 && rest[1] == rest[0]) out += "{}";
    rest.remove_prefix(1);
  }
  return out;
}

std::string latex_table(const PaperTable& table) {
  const auto grid = laid_out(table, 0, heading_text, [](const PaperCell& c) {
    return c.bold ? "\\textbf{" + latex_text(c.text) + "}" : latex_text(c.text);
  });
  std::string out = "% Needs \\usepackage{booktabs}.\n\\begin{table}\n  \\centering\n  \\caption{" +
                    latex_text(table.caption) + "}\n  \\label{tab:" + plain_label(table.label) +
                    "}\n  \\begin{tabular}{";
  for (const PaperColumn& c : table.columns) out += c.aligned == Aligned::right ? 'r' : 'l';
  out += "}\n    \\toprule\n";
  write_line(out, grid.front());
  out += "    \\midrule\n";
  for (std::size_t i = 1; i < grid.size(); ++i) write_line(out, grid[i]);
  return out + "    \\bottomrule\n  \\end{tabular}\n\\end{table}\n";
}

}  // namespace karst::campaign
