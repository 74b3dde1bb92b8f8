// A page in one file that loads nothing: markup, styles, scripts and data inside. docs/report.md
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

/// No text in the data, whatever it holds, can end the element it stands in.
std::string assemble_page(const PageParts& parts, const nlohmann::ordered_json& data);

}  // namespace karst::evaluation
