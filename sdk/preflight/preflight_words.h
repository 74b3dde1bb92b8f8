// The summary in words: rows of a name and a text, which the terminal and the page show; details only the
// page.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "sdk/preflight/verdict.h"

namespace karst::preflight {

struct Row {
  std::string name, text;
  bool page_only = false;
};
struct Section {
  std::string title;
  std::vector<Row> rows;
};

/// "6:40 min", or "48 s" below a minute.
std::string duration_text(double seconds);

/// "GO", "GO, with 2 things to watch for", "NO-GO".
std::string verdict_text(const std::vector<Finding>& findings);

/// What is known; what is not is left out.
std::vector<Section> sections_of(const Preflight& preflight);

/// The verdict with the findings, as the terminal shows them.
std::string findings_text(const Preflight& preflight, const std::vector<Finding>& findings);

/// Characters before the text of each row in facts_text().
constexpr std::size_t kNameColumns = 23;
/// The sections without the rows that only the page has.
std::string facts_text(const Preflight& preflight);

}  // namespace karst::preflight
