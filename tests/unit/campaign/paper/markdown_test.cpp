// Text and tables as Markdown.
#include "sdk/campaign/paper/markdown.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cctype>

namespace karst::campaign {
namespace {

// CommonMark: a backslash before punctuation gives that character, whatever it would mean without.
RC_GTEST_PROP(MarkdownText, ShowsAnyTextAsItIs, ()) {
  const std::string markup = "\\`*_{}[]<>#|~$&";
  const auto text = *rc::gen::container<std::string>(
      rc::gen::oneOf(rc::gen::inRange<char>(' ', 127), rc::gen::elementOf(markup)));
  const std::string markdown = markdown_text(text);
  std::string shown;
  for (std::size_t i = 0; i < markdown.size(); ++i) {
    if (markdown[i] == '\\') {
      ++i;
      RC_ASSERT(i < markdown.size());
      RC_ASSERT(std::ispunct(static_cast<unsigned char>(markdown[i])) != 0);
    } else {
      RC_ASSERT(markup.find(markdown[i]) == std::string::npos);
    }
    shown += markdown[i];
  }
  RC_ASSERT(shown == text);
}

TEST(MarkdownTable, IsAlignedInItsSource) {
  const PaperTable table{
      "t",
      "Caves of 50 %",
      {{"Name", "", Aligned::left}, {"Volume", "m\u00B3"}},
      {std::vector<PaperCell>{{"x_1"}, {"10.5", true}}, std::vector<PaperCell>{{"y"}, {"9.0"}}}};
  EXPECT_EQ(markdown_table(table),
            "**Table:** Caves of 50 %\n"
            "\n"
            "| Name | Volume (m³) |\n"
            "| :--- | ----------: |\n"
            "| x\\_1 |    **10.5** |\n"
            "| y    |         9.0 |\n");
}

}  // namespace
}  // namespace karst::campaign
