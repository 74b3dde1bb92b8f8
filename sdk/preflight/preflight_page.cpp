#include "sdk/preflight/preflight_page.h"

#include "core_stack/common/xml_text.h"
#include "sdk/evaluation/page/page.h"
#include "sdk/preflight/page_head.h"
#include "sdk/preflight/preflight_json.h"
#include "sdk/preflight/preflight_words.h"

namespace karst::preflight {
namespace {

using core::xml_text;

constexpr const char* kStyle = R"css(
@page { size: A4; margin: 12mm 14mm; }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 182mm; padding: 6mm 5mm; color: #111; background: #fff;
  font: 9.5pt/1.35 system-ui, "DejaVu Sans", sans-serif; overflow-wrap: anywhere; }
h1 { font-size: 15pt; margin: 0 0 1mm; }
h2 { font-size: 10.5pt; margin: 3mm 0 1mm; border-bottom: .3mm solid #111; }
.verdict { font-size: 13pt; font-weight: 700; padding: 1.5mm 3mm; border: .6mm solid #111; margin: 2mm 0; }
.no_go { border-width: 1.4mm; }
ul { margin: 0; padding-left: 5mm; }
table { border-collapse: collapse; width: 100%; }
th { text-align: left; font-weight: 600; width: 38mm; vertical-align: top; padding: .4mm 3mm .4mm 0; }
td { vertical-align: top; padding: .4mm 0; }
.plan { display: block; margin: 2mm auto; max-width: 100%; height: auto; }
.plan .cave { fill: #c9ced4; }
.plan .start { fill: #111; }
.plan .bar { stroke: #111; fill: none; }
.plan text { fill: #111; font-family: system-ui, "DejaVu Sans", sans-serif; }
.note { font-size: 8pt; margin: 0; text-align: center; }
/* One page: the picture takes the room that the text leaves of 297 - 2 x 12 mm, less 1 mm for rounding. */
@media print {
  body { padding: 0; max-width: none; font-size: 8.5pt; line-height: 1.25; height: 272mm; display: flex;
    flex-direction: column; }
  h2 { break-after: avoid; margin-top: 2mm; }
  table, ul { break-inside: avoid; }
  body > * { flex: none; }
  body > .plan { flex: 0 1 auto; min-height: 30mm; width: auto; margin: 1.5mm auto; }
}
)css";

std::string list_of_findings(const std::vector<Finding>& findings, Severity severity, const char* title) {
  std::string items;
  for (const Finding& f : findings)
    if (f.severity == severity)
      items += std::string("<li><b>") + core::name_of(f.subject) + "</b>: " + xml_text(f.text) + "</li>\n";
  return items.empty() ? "" : std::string("<h2>") + title + "</h2>\n<ul>\n" + items + "</ul>\n";
}

std::string table_of(const Section& section) {
  std::string rows;
  for (const Row& r : section.rows)
    rows += "<tr><th scope=\"row\">" + xml_text(r.name) + "</th><td>" + xml_text(r.text) + "</td></tr>\n";
  return "<h2>" + xml_text(section.title) + "</h2>\n<table>\n" + rows + "</table>\n";
}

}  // namespace

std::string preflight_page(const Preflight& preflight, const std::vector<Finding>& findings) {
  std::string body = "<h1>Preflight: " + xml_text(preflight.cave_file) + "</h1>\n<p class=\"verdict " +
                     (is_go(findings) ? "go" : "no_go") + "\">" + xml_text(verdict_text(findings)) + "</p>\n";
  body += list_of_findings(findings, Severity::no_go, "Reasons against it");
  body += list_of_findings(findings, Severity::watch, "Watch for");
  for (const Section& s : sections_of(preflight)) body += table_of(s);
  if (preflight.cave)
    if (const std::string svg = to_svg(preflight.cave->plan); !svg.empty())
      body += svg + "<p class=\"note\">The cave from above, north up; the dot is the start.</p>\n";
  const std::string markup = page_head("karst preflight") + body + "</body>\n</html>\n";
  return evaluation::assemble_page({.markup = markup, .styles = {kStyle}, .libraries = {}, .scripts = {}},
                                   to_json(preflight, findings));
}

}  // namespace karst::preflight
