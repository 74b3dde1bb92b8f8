// The page, read as XML by a parser that is not karst's.
#include "sdk/cave_drawing/svg_sheet.h"

#include <gtest/gtest.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <functional>
#include <numbers>
#include <regex>
#include <sstream>

#include "sdk/cave_drawing/map_drawings.h"
#include "sdk/cave_drawing/svg_text.h"
#include "tests/unit/cave_drawing/box_maps.h"
#include "tests/unit/cave_drawing/drawn_lines.h"

namespace karst::cave_drawing {
namespace {

using boost::property_tree::ptree;

ptree drawn(const std::string& svg) {
  std::istringstream in(svg);
  ptree document;
  boost::property_tree::read_xml(in, document);
  return document.get_child("svg");
}

void for_each_element(const ptree& tree, const std::function<void(const std::string&, const ptree&)>& visit) {
  for (const auto& [name, element] : tree) {
    if (name == "<xmlattr>") continue;
    visit(name, element);
    for_each_element(element, visit);
  }
}

std::string said(const ptree& element, const std::string& attribute) {
  return element.get("<xmlattr>." + attribute, "");
}

CaveDrawings cross() {
  FlightRecord record;
  record.name = "Gouffre <& \"Berger\">";
  record.from = "flight";
  record.date = "2026-11-26";
  record.entrance = core::Vec3(1.5, 1.5, 1.5);
  record.path = {{1.5, 1.5, 1.5}, {30, 1.5, 1.5}};
  record.finds = {{"<helmet>", {20, 1, 1}}};
  return map_drawings(test::map_of_boxes({{{0, 0, 0}, {249, 14, 14}}, {{120, -150, 0}, {134, 150, 14}}}),
                      record, {}, "map");
}

/// Every place that an element names is on the page; relative steps of paths are short symbols.
void expect_on_page(const ptree& svg) {
  const double width = std::stod(said(svg, "width")), height = std::stod(said(svg, "height"));
  const auto inside = [&](double x, double y) {
    EXPECT_GE(x, -0.01);
    EXPECT_LE(x, width + 0.01);
    EXPECT_GE(y, -0.01);
    EXPECT_LE(y, height + 0.01);
  };
  int places = 0;
  for_each_element(svg, [&](const std::string&, const ptree& e) {
    for (const auto& [x, y] :
         {std::pair{"x", "y"}, std::pair{"x1", "y1"}, std::pair{"x2", "y2"}, std::pair{"cx", "cy"}})
      if (!said(e, x).empty()) inside(std::stod(said(e, x)), std::stod(said(e, y))), ++places;
    if (!said(e, "width").empty() && !said(e, "x").empty())
      inside(std::stod(said(e, "x")) + std::stod(said(e, "width")), std::stod(said(e, "y")));
    const std::string d = said(e, "d");
    const std::regex pair("[ML](-?[0-9.]+) (-?[0-9.]+)");
    for (std::sregex_iterator i(d.begin(), d.end(), pair), end; i != end; ++i)
      inside(std::stod((*i)[1]), std::stod((*i)[2])), ++places;
  });
  EXPECT_GT(places, 50);
}

TEST(SvgSheet, EveryViewIsXmlAndNothingLiesOutsideThePage) {
  const CaveDrawings drawings = cross();
  for (const Drawing* d : {&drawings.plan, &drawings.extended, &drawings.projected})
    for (const Paper paper : {Paper::a4, Paper::a3}) {
      SheetOptions options;
      options.paper = paper;
      options.declination_rad = 0.2;
      expect_on_page(drawn(svg_sheet(*d, drawings.facts, options, "map")));
    }
}

TEST(SvgSheet, TheScaleBarIsAsLongAsTheScaleSays) {
  const CaveDrawings drawings = cross();
  for (const double scale : {500.0, 1000.0, 750.0}) {
    SheetOptions options;
    options.paper = Paper::a3;
    options.scale = scale;
    const ptree svg = drawn(svg_sheet(drawings.plan, drawings.facts, options, "map"));
    double bar_mm = 0, bar_m = 0;
    for_each_element(svg, [&](const std::string& name, const ptree& e) {
      if (said(e, "class") == "length") bar_mm = std::stod(said(e, "width"));
      const std::string text = name == "text" ? e.data() : "";
      if (std::regex_match(text, std::regex("[0-9]+ m"))) bar_m = std::stod(text);
    });
    EXPECT_GT(bar_m, 0);
    EXPECT_NEAR(bar_mm, bar_m * 1000 / scale, 0.01);
    EXPECT_EQ(said(svg, "width"), "297mm");
    EXPECT_EQ(said(svg, "viewBox"), "0 0 297 420") << "a unit is a millimetre";
  }
}

TEST(SvgSheet, TheTitleBlockSaysWhatIsKnown) {
  const CaveDrawings drawings = cross();
  std::string all;
  for_each_element(drawn(svg_sheet(drawings.plan, drawings.facts, {}, "map")),
                   [&](const std::string&, const ptree& e) { all += e.data() + "\n"; });
  for (const char* part :
       {"Gouffre <& \"Berger\">", "Plan", "explored by karst", "2026-11-26", "floor to roof 3 m", "length ",
        "volume ", "1:", "<helmet>", "entrance", "N", "grid "})
    EXPECT_NE(all.find(part), std::string::npos) << part;
}

TEST(SvgSheet, UncertainWallsAreThinAndDashedAndTheLegendSaysWhy) {
  CaveDrawings drawings = cross();
  EXPECT_EQ(svg_sheet(drawings.plan, drawings.facts, {}, "map").find("black dashes"), std::string::npos);
  drawings.plan.uncertain_walls = {{{0, 0}, {10, 0}}};
  for (const auto& [from, why] : {std::pair{"flight", "black dashes: limit of sight"},
                                  {"survey", "black dashes: walls not measured"}}) {
    drawings.facts.from = from;
    const std::string svg = svg_sheet(drawings.plan, drawings.facts, {}, "map");
    EXPECT_NE(svg.find(why), std::string::npos) << from;
    EXPECT_NE(svg.find("class=\"uncertain\""), std::string::npos);
  }
}

TEST(SvgSheet, ANameThatIsTooLongIsCutAfterAWholeCharacter) {
  EXPECT_EQ(cut_to("short", 1, 10), "short");
  const std::string cut = cut_to("\u00E9\u00E9\u00E9\u00E9\u00E9\u00E9", 1, 2.3);  // room for four characters
  EXPECT_EQ(cut, "\u00E9\u00E9\u00E9\u2026");
  EXPECT_LE(text_width_mm(cut, 1), 2.3);
  EXPECT_EQ(cut_to("long", 1, 0.1), "\u2026");
}

TEST(SvgSheet, HeightsOfAMapWithoutAnEntranceAreNotSaidToBeFromIt) {
  const CaveDrawings with = cross();
  const CaveDrawings without = map_drawings(test::map_of_boxes({{{0, 0, 0}, {249, 14, 14}}}), {}, {}, "map");
  for (const auto drawing : {&CaveDrawings::plan, &CaveDrawings::extended, &CaveDrawings::projected}) {
    EXPECT_NE(svg_sheet(with.*drawing, with.facts, {}, "map").find("from the entrance"), std::string::npos);
    EXPECT_EQ(svg_sheet(without.*drawing, without.facts, {}, "map").find("from the entrance"),
              std::string::npos);
  }
}

TEST(SvgSheet, OnlyThePlanHasANorthArrowAndTheProjectedProfileItsBearing) {
  const CaveDrawings drawings = cross();
  const auto has = [](const std::string& svg, const char* part) {
    return svg.find(part) != std::string::npos;
  };
  EXPECT_TRUE(has(svg_sheet(drawings.plan, drawings.facts, {}, "map"), "class=\"north\""));
  EXPECT_FALSE(has(svg_sheet(drawings.extended, drawings.facts, {}, "map"), "class=\"north\""));
  Drawing east = drawings.projected;
  east.bearing_rad = std::numbers::pi / 2;
  const std::string svg = svg_sheet(east, drawings.facts, {}, "map");
  EXPECT_TRUE(has(svg, ">090\u00B0<") && has(svg, ">270\u00B0<"));
}

TEST(SvgSheet, TheSameCaveGivesTheSameBytes) {
  EXPECT_EQ(svg_sheet(cross().extended, cross().facts, {}, "map"),
            svg_sheet(cross().extended, cross().facts, {}, "map"));
}

}  // namespace
}  // namespace karst::cave_drawing
