#include "sdk/evaluation/page/page.h"

#include "core_stack/common/json_text.h"

namespace karst::evaluation {
namespace {

using nlohmann::ordered_json;

void replace(std::string& text, std::string_view mark, std::string_view by) {
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + by.size()))
    text.replace(at, mark.size(), by);
}

/// Text inside <script> must not contain its end tag.
std::string joined_scripts(const std::vector<std::string_view>& scripts) {
  std::string all;
  for (const std::string_view script : scripts) {
    std::string text(script);
    replace(text, "</script", "<\\/script");
    all += text + "\n;\n";
  }
  return all;
}

}  // namespace

std::string assemble_page(const PageParts& parts, const ordered_json& data) {
  // Invalid UTF-8 in a plugin's text is shown as U+FFFD. Outside strings < is not needed, so escaping all of
  // them prevents any text in the data from ending the element.
  std::string json = core::json_text(data);
  replace(json, "<", "\\u003c");
  std::string styles;
  for (const std::string_view text : parts.styles) styles.append(text).append("\n");
  std::string out;
  std::size_t from = 0;
  const auto put = [&](std::string_view mark, std::string_view content) {
    const std::size_t at = parts.markup.find(mark, from);
    out.append(parts.markup.substr(from, at - from)).append(content);
    from = at + mark.size();
  };
  put("@style@", styles);
  put("@data@", json);
  put("@libraries@", joined_scripts(parts.libraries));
  put("@scripts@", joined_scripts(parts.scripts));
  return out.append(parts.markup.substr(from));
}

}  // namespace karst::evaluation
