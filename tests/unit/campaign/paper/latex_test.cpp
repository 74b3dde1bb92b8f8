// Text and tables as LaTeX.
#include "sdk/campaign/paper/latex.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <optional>
#include <utility>

namespace karst::campaign {
namespace {

/// What LaTeX prints, for the commands that stand for a character; nothing if anything else of LaTeX is in
/// it.
std::optional<std::string> printed_by_latex(std::string_view latex) {
  const std::vector<std::pair<std::string, std::string>> commands = {{"\\textbackslash{}", "\\"},
                                                                     {"\\textasciicircum{}", "^"},
                                                                     {"\\textasciitilde{}", "~"},
                                                                     {"\\textless{}", "<"},
                                                                     {"\\textgreater{}", ">"},
                                                                     {"\\textbar{}", "|"},
                                                                     {"\\textasciigrave{}", "`"},
                                                                     {"\\symbol{34}", "\""},
                                                                     {"\\{", "{"},
                                                                     {"\\}", "}"},
                                                                     {"\\$", "$"},
                                                                     {"\\&", "&"},
                                                                     {"\\#", "#"},
                                                                     {"\\%", "%"},
                                                                     {"\\_", "_"},
                                                                     {"{[}", "["},
                                                                     {"{*}", "*"},
                                                                     {"{}", ""}};
  std::string out;
  while (!latex.empty()) {
    bool taken = false;
    for (const auto& [command, character] : commands)
      if (!taken && latex.starts_with(command)) {
        out += character;
        latex.remove_prefix(command.size());
        taken = true;
      }
    if (taken) continue;
    if (std::string_view("\\{}$&#%_^~[*<>|\"`").find(latex.front()) != std::string_view::npos)
      return std::nullopt;
    out += latex.front();
    latex.remove_prefix(1);
  }
  return out;
}

RC_GTEST_PROP(LatexText, PrintsAnyTextAsItIs, ()) {
  const auto any = rc::gen::inRange<char>(' ', 127);
  const auto special = rc::gen::elementOf(std::string("\\{}$&#%_^~<>|\"`'[]*-,"));
  const auto text = *rc::gen::container<std::string>(rc::gen::oneOf(any, special));
  const std::string latex = latex_text(text);
  const auto printed = printed_by_latex(latex);
  RC_ASSERT(printed.has_value());
  RC_ASSERT(*printed == text);
  for (const char* joined : {"--", "''", ",,", "!`", "?`", "\\\\"})
    RC_ASSERT(latex.find(joined) == std::string::npos);
}

TEST(LatexText, LeavesLettersOfOtherLanguagesAndTakesSignsThatAreNone) {
  EXPECT_EQ(latex_text("Höhle"), "Höhle");
  EXPECT_EQ(latex_text("\u22120.5 \u2013 1"), "$-$0.5 \\textendash{} 1");
  EXPECT_EQ(latex_text("> 1 \u2020 \u2021"), "\\textgreater{} 1 \\textdagger{} \\textdaggerdbl{}");
  EXPECT_EQ(latex_text("two\nlines\x01\xff"), "two lines??");
}

TEST(LatexTable, IsABooktabsTable) {
  const PaperTable table{
      "a b%",
      "Caves of 50 %",
      {{"Name", "", Aligned::left}, {"Volume", "m\u00B3"}},
      {std::vector<PaperCell>{{"x_1"}, {"10.5", true}}, std::vector<PaperCell>{{"y"}, {"9.0"}}}};
  EXPECT_EQ(latex_table(table),
            "% Needs \\usepackage{booktabs}.\n"
            "\\begin{table}\n"
            "  \\centering\n"
            "  \\caption{Caves of 50 \\%}\n"
            "  \\label{tab:a-b-}\n"
            "  \\begin{tabular}{lr}\n"
            "    \\toprule\n"
            "    Name & Volume (m$^3$) \\\\\n"
            "    \\midrule\n"
            "    x\\_1 &  \\textbf{10.5} \\\\\n"
            "    y    &            9.0 \\\\\n"
            "    \\bottomrule\n"
            "  \\end{tabular}\n"
            "\\end{table}\n");
}

TEST(LatexTable, BreaksALongHeading) {
  const PaperTable table{"t", "", {{"Coverage averaged over the flight", "%"}}, {}};
  EXPECT_NE(
      latex_table(table).find("    \\shortstack[r]{Coverage\\\\averaged over\\\\the flight\\\\(\\%)} \\\\\n"),
      std::string::npos)
      << latex_table(table);
}

}  // namespace
}  // namespace karst::campaign
