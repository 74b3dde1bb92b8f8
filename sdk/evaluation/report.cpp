#include "sdk/evaluation/report.h"

#include <fstream>

#include "sdk/evaluation/metrics.h"
#include "sdk/evaluation/report_assets.h"
#include "sdk/evaluation/whole_file.h"

namespace karst::evaluation {
namespace {

using nlohmann::ordered_json;

void replace(std::string& text, std::string_view mark, std::string_view by) {
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + by.size()))
    text.replace(at, mark.size(), by);
}

/// Text inside <script> must not contain its end tag.
std::string script_safe(std::string_view script) {
  std::string text(script);
  replace(text, "</script", "<\\/script");
  return text;
}

}  // namespace

std::string report_page(const ordered_json& data) {
  // Invalid UTF-8 in a plugin's text is shown as U+FFFD. As < is not needed outside strings, escaping all of
  // them keeps any text in the data from ending the element.
  std::string json = data.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  replace(json, "<", "\\u003c");
  std::string libraries, scripts;
  for (const std::string_view text : report_libraries()) libraries += script_safe(text) + "\n;\n";
  for (const std::string_view text : report_scripts()) scripts += script_safe(text) + "\n";
  const std::string_view page = report_template();
  std::string out;
  std::size_t from = 0;
  const auto put = [&](std::string_view mark, std::string_view content) {
    const std::size_t at = page.find(mark, from);
    out.append(page.substr(from, at - from)).append(content);
    from = at + mark.size();
  };
  put("@style@", report_style());
  put("@data@", json);
  put("@libraries@", libraries);
  put("@scripts@", scripts);
  return out.append(page.substr(from));
}

void write_report(const std::filesystem::path& run_dir) {
  const RunRecord run = read_run(run_dir);
  std::ifstream in(run_dir / "metrics.json");
  ordered_json metrics = in ? ordered_json::parse(in, nullptr, false) : ordered_json();
  if (!metrics.is_object()) metrics = evaluate_run(run_dir, {});
  write_whole_file(run_dir / "report.html", report_page(report_data(run, metrics)));
}

}  // namespace karst::evaluation
