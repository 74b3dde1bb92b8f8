// A self-contained page: markup, styles, scripts and data in one file. docs/report.md
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace karst::evaluation {

struct PageParts {
  std::string_view markup;  // holds @style@, @data@, @libraries@ and @scripts@, in this order
  std::vector<std::string_view> styles, libraries, scripts;
};

/// Text in the data cannot end the element that contains it.
std::string assemble_page(const PageParts& parts, const nlohmann::ordered_json& data);

}  // namespace karst::evaluation
