// Plain text and tables as LaTeX. What is written needs the package booktabs and a LaTeX of 2020 or later,
// which reads UTF-8 by itself.
#pragma once
#include <string>
#include <string_view>

#include "sdk/campaign/paper/paper_table.h"

namespace karst::campaign {

/// Text that prints as itself: no character of it is a command, joins with another into a third, or ends a
/// row. Line ends become blanks; what cannot be printed becomes '?'.
std::string latex_text(std::string_view plain);

/// A `table` environment with caption and label.
std::string latex_table(const PaperTable& table);

}  // namespace karst::campaign
