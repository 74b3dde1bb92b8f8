#include "sdk/preflight/vehicle/vehicle_page.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core_stack/common/format_text.h"
#include "core_stack/common/xml_text.h"
#include "sdk/evaluation/page/page.h"
#include "sdk/preflight/page_head.h"
#include "sdk/preflight/vehicle/vehicle_plots.h"
#include "sdk/preflight/vehicle/vehicle_words.h"

namespace karst::preflight {
namespace {

using core::xml_text;

constexpr const char* kChecklistStyle = R"css(
@page { size: A4; margin: 8mm 12mm; }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 186mm; padding: 5mm 4mm; color: #111; background: #fff;
  font: 9pt/1.3 system-ui, "DejaVu Sans", sans-serif; overflow-wrap: anywhere; }
h1 { font-size: 14pt; margin: 0 0 1mm; } h1 + p { margin: 0; }
h2 { font-size: 10pt; margin: 2.5mm 0 1mm; border-bottom: .3mm solid #111; }
.verdict { font-size: 13pt; font-weight: 700; padding: 1.2mm 3mm; border: .6mm solid #111; margin: 1.5mm 0; }
.no_go { border-width: 1.4mm; }
table { border-collapse: collapse; width: 100%; }
th { text-align: left; font-weight: 600; width: 22mm; white-space: nowrap; vertical-align: top; padding: .3mm 2mm .3mm 0; }
td { vertical-align: top; padding: .3mm 2mm .3mm 0; }
ul { margin: 0; padding-left: 5mm; }
ul.boxes { list-style: none; padding: 0; columns: 2; column-gap: 6mm; }
ul.boxes li { padding-left: 6mm; text-indent: -6mm; margin-bottom: .8mm; break-inside: avoid; }
.box { display: inline-block; width: 3mm; height: 3mm; border: .3mm solid #111; margin-right: 3mm; text-indent: 0; }
.plots { display: flex; gap: 4mm; align-items: flex-start; margin-top: 2mm; }
.plots > div { flex: 1 1 0; min-width: 0; } .plots > .around { flex: 0 0 38mm; }
svg { display: block; width: 100%; height: auto; }
.plot text { font-size: 2.7px; font-family: system-ui, "DejaVu Sans", sans-serif; }
.plot .frame { fill: none; stroke: #999; stroke-width: .2; }
.plot .curve { fill: none; stroke-width: .4; } .plot .wide { stroke-width: 1.6; }
.around svg { max-height: 26mm; }
.pad path { fill: none; stroke-linecap: round; }
.pad .floor { stroke: #bbb; stroke-width: .03; } .pad .walls { stroke: #111; stroke-width: .05; }
.pad .hull { fill: none; stroke: #111; stroke-width: .04; }
.pad .room { fill: none; stroke: #111; stroke-width: .03; stroke-dasharray: .1 .1; }
.pad .bar { stroke: #111; stroke-width: .05; }
.note { font-size: 7.5pt; margin: 0; }
.sign { margin-top: 3mm; }
@media print { body { padding: 0; max-width: none; font-size: 7.5pt; line-height: 1.15; }
  h1 { font-size: 12pt; } h2 { margin: 1.5mm 0 .6mm; } .verdict { font-size: 11pt; padding: .6mm 3mm; }
  ul.boxes li { margin-bottom: .3mm; } .plots { margin-top: 1mm; } .sign { margin-top: 2mm; }
  table, ul { break-inside: avoid; } h2 { break-after: avoid; } }
)css";

std::string list_of(const std::vector<Check>& checks, Outcome outcome, const char* title) {
  std::string items;
  for (const Check& c : checks) {
    if (c.outcome != outcome) continue;
    items += std::string("<li><b>") + core::name_of(c.part) + ", " + xml_text(c.what) +
             "</b>: " + xml_text(c.measured) + " (required: " + xml_text(c.required) +
             "). To do: " + xml_text(c.remedy) + "</li>\n";
  }
  return items.empty() ? "" : std::string("<h2>") + title + "</h2>\n<ul>\n" + items + "</ul>\n";
}

/// A row a part: a page has no room for one a check.
std::string table_of_passed(const std::vector<Check>& checks) {
  std::string rows;
  for (const auto& part : names_of(Part{})) {
    const std::string cell = passed_text(checks, part.value);
    if (!cell.empty())
      rows +=
          std::string("<tr><th scope=\"row\">") + part.name + "</th><td>" + xml_text(cell) + "</td></tr>\n";
  }
  return rows.empty() ? "" : "<h2>Passed</h2>\n<table>\n" + rows + "</table>\n";
}

std::string plots_of(const VehicleMeasurements& m) {
  const std::string rates = rates_svg(m), turns = turns_svg(m), pad = pad_svg(m);
  if (rates.empty() && turns.empty() && pad.empty()) return "";
  std::string out = "<div class=\"plots\">";
  for (const std::string& plot : {rates, turns})
    if (!plot.empty()) out += "<div>" + plot + "</div>";
  if (!pad.empty())
    out += "<div class=\"around\">" + pad +
           "<p class=\"note\">A scan around the pad from above, forward is up. Black: at the heights of the "
           "climb. Circle: hull; dashed: the room it needs.</p></div>";
  return out + "</div>\n";
}

}  // namespace

std::string vehicle_page(const VehicleMeasurements& m, const std::vector<Check>& checks) {
  const bool go = verdict_of(checks) != Outcome::no_go;
  std::string body = "<h1>Preflight: vehicle " + xml_text(m.vehicle.name) + "</h1>\n<p>By " +
                     xml_text(source_text(m)) + ".</p>\n<p class=\"verdict " + (go ? "go" : "no_go") + "\">" +
                     xml_text(verdict_text(checks)) + "</p>\n";
  body += list_of(checks, Outcome::no_go, "Reasons against it");
  body += list_of(checks, Outcome::watch, "Watch for");
  body += "<h2>For a person to check</h2>\n<ul class=\"boxes\">\n";
  for (const std::string& box : boxes_for_persons(m))
    body += "<li><span class=\"box\"></span>" + xml_text(box) + "</li>\n";
  body += "</ul>\n" + plots_of(m) + table_of_passed(checks);
  body +=
      "<p class=\"sign\">Date, time and place: ______________________ Pilot: ____________________ Go: "
      "<span class=\"box\"></span></p>\n";
  const std::string markup = page_head("karst preflight of a vehicle") + body + "</body>\n</html>\n";
  return evaluation::assemble_page(
      {.markup = markup, .styles = {kChecklistStyle}, .libraries = {}, .scripts = {}}, to_json(m, checks));
}

}  // namespace karst::preflight
