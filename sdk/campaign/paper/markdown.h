// Plain text and tables as Markdown (CommonMark, with the tables of GitHub and pandoc).
#pragma once
#include <string>
#include <string_view>

#include "sdk/campaign/paper/paper_table.h"

namespace karst::campaign {

/// Text that shows as itself within a paragraph or a cell. Line ends become blanks; what cannot be printed
/// becomes '?'.
std::string markdown_text(std::string_view plain);

/// The caption as a paragraph, then the table.
std::string markdown_table(const PaperTable& table);

}  // namespace karst::campaign
