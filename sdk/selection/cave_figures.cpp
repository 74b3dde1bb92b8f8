#include "sdk/selection/cave_figures.h"

#include <array>
#include <boost/property_tree/ptree.hpp>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core_stack/common/error.h"
#include "core_stack/common/json_text.h"
#include "core_stack/common/options.h"
#include "core_stack/common/unit_text.h"

namespace karst::selection {
namespace {

using C = CaveFigures;

// Least scales: the difference between two descriptions of one cave, at another resolution or from a flown
// map (docs/select.md).
constexpr std::array kFigures{
    FigureDefinition{"volume", "m^3", &C::volume_m3, 1, 1e9, true, 0, 0.2, 1, false,
                     "free space that a vehicle can reach or see, with half of the cells at the rock"},
    FigureDefinition{"length", "m", &C::length_m, 1, 1e6, true, 0, 0.2, 0.5, false, "length of all passages"},
    FigureDefinition{"width", "m", &C::width_m, 0.5, 500, true, 0, 0.15, 1, true,
                     "median over the passages of the widest ball that fits, its diameter"},
    FigureDefinition{"width_spread", "", &C::width_spread, 1, 100, true, 0, 0.15, 0.5, false,
                     "90th over 10th percentile of the width"},
    FigureDefinition{"height", "m", &C::height_m, 0.5, 1000, true, 0, 0.15, 0.5, true,
                     "geometric mean over the passages of the height from floor to roof"},
    FigureDefinition{"drop", "m", &C::drop_m, 0.5, 5000, true, 2, 0.2, 0.5, false,
                     "from the lowest place to the highest"},
    FigureDefinition{"verticality", "", &C::verticality, 0, 1, false, 0, 0.05, 1, true,
                     "vertical share of the way along the passages: 0 level, 1 shafts only"},
    FigureDefinition{"branching", "", &C::branching, 0, 100, true, 1, 0.25, 1, false,
                     "junctions in 100 m of passage"},
    FigureDefinition{"loops", "", &C::loops, 0, 100, true, 0.5, 0.25, 1, false,
                     "ways round, back to the same place, in 100 m of passage"},
    FigureDefinition{"tortuosity", "", &C::tortuosity, 1, 50, true, 0, 0.05, 0.5, false,
                     "way between two places over their straight distance, median"},
    FigureDefinition{"hall_width", "m", &C::hall_width_m, 0.5, 1000, true, 0, 0.15, 0.5, false,
                     "the widest ball that fits anywhere, its diameter"},
    FigureDefinition{"dead_ends", "", &C::dead_ends, 0, 100, true, 1, 0.25, 0.5, false,
                     "passages that end, in 100 m of passage"},
    FigureDefinition{"sight", "m", &C::sight_m, 0.5, 500, true, 0, 0.15, 0.5, false,
                     "median over the passages of the longest straight line of sight"},
};

}  // namespace

std::span<const FigureDefinition> figure_definitions() { return kFigures; }

double scaled(const FigureDefinition& figure, double value) {
  return figure.logarithmic ? std::log(value + figure.offset) : value;
}

CaveFigures told_by_part(const CaveFigures& of_part) {
  CaveFigures told;
  for (const FigureDefinition& f : kFigures)
    if (f.told_by_part) told.*f.value = of_part.*f.value;
  return told;
}

std::string to_json(const CaveFigures& figures) {
  nlohmann::ordered_json j = nlohmann::ordered_json::object();
  for (const FigureDefinition& f : kFigures)
    if (const double v = figures.*f.value; std::isfinite(v)) {
      std::array<char, 32> text;
      std::snprintf(text.data(), text.size(), "%.6g", v);
      j[std::string(f.name)] = std::strtod(text.data(), nullptr);
    }
  return core::json_text(j);
}

CaveFigures figures_from_json(const std::string& text, const std::string& source) {
  CaveFigures figures;
  if (text.empty()) return figures;
  const nlohmann::json j = core::json_of(text);
  if (!j.is_object()) throw core::InputError(source, "description", "expected a JSON object, got " + text);
  for (const FigureDefinition& f : kFigures) {
    const auto found = j.find(f.name);
    if (found == j.end() || found->is_null()) continue;
    const double v = found->is_number() ? found->get<double>() : kUnknown;
    if (!(v >= f.low && v <= f.high))
      throw core::InputError(source, "description." + std::string(f.name),
                             "out of range: " + core::json_text(*found));
    figures.*f.value = v;
  }
  return figures;
}

CaveFigures read_figures(const std::string& file) {
  CaveFigures figures;
  core::OptionTable table;
  for (const FigureDefinition& f : kFigures)
    table.add(std::string(f.name), figures.*f.value, std::string(f.unit), f.low, f.high,
              std::string(f.meaning));
  const boost::property_tree::ptree tree = core::read_info(file);
  table.read(file, tree);
  if (tree.empty()) throw core::InputError(file, "", "gives no figure of a cave, such as: width \"4 m\"");
  return figures;
}

std::string to_text(const CaveFigures& figures) {
  std::string out;
  for (const FigureDefinition& f : kFigures) {
    const double v = figures.*f.value;
    if (!std::isfinite(v)) continue;
    const std::string unit = core::unit_text(f.unit);
    const int width = unit == f.unit ? 4 : 5;  // in bytes, of which m³ has one more than characters
    std::array<char, 200> line;
    std::snprintf(line.data(), line.size(), "  %-13s %8.*f %-*s %.*s\n", std::string(f.name).c_str(),
                  v < 100 ? 2 : 0, v, width, unit.c_str(), static_cast<int>(f.meaning.size()),
                  f.meaning.data());
    out += line.data();
  }
  return out;
}

}  // namespace karst::selection
