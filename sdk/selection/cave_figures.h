// Description of a cave by figures, which are used to compare caves. One table defines each figure's
// name, unit, range and scale of comparison; files, JSON, text and distances all follow it
// (docs/select.md).
#pragma once
#include <limits>
#include <span>
#include <string>
#include <string_view>

namespace karst::selection {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// NaN: unknown.
struct CaveFigures {
  double volume_m3 = kUnknown;
  double length_m = kUnknown;
  double width_m = kUnknown;
  double width_spread = kUnknown;
  double height_m = kUnknown;
  double drop_m = kUnknown;
  double verticality = kUnknown;
  double branching = kUnknown;
  double loops = kUnknown;
  double tortuosity = kUnknown;
  double hall_width_m = kUnknown;
  double dead_ends = kUnknown;
  double sight_m = kUnknown;
};

struct FigureDefinition {
  std::string_view name, unit;
  double CaveFigures::*value;
  double low, high;  // range accepted from files
  // Two caves differ in a figure by the difference of scaled(value): log(value + offset) if logarithmic, or
  // the value itself.
  bool logarithmic;
  double offset;
  double min_scale;  // least unit of differences, however similar the known caves are
  double weight;
  bool told_by_part;  // a part of the cave tells it, too: it does not grow with what is explored
  std::string_view meaning;
};

std::span<const FigureDefinition> figure_definitions();

/// The value on the scale on which it is compared; NaN stays NaN.
double scaled(const FigureDefinition& figure, double value);

/// What a part of the cave tells of the whole: the figures with told_by_part.
CaveFigures told_by_part(const CaveFigures& of_part);

/// A JSON object of the known figures, rounded to six digits: the form in which a campaign's store keeps a
/// cave.
std::string to_json(const CaveFigures& figures);
/// Ignores keys that are not figures; for "" all are unknown. Throws InputError naming `source`.
CaveFigures figures_from_json(const std::string& text, const std::string& source);

/// Reads a caver's knowledge from an INFO file: any of the figures, values with units. Throws InputError with
/// file, key and range, also if the file has no figure at all.
CaveFigures read_figures(const std::string& file);

/// One line of text per known figure.
std::string to_text(const CaveFigures& figures);

}  // namespace karst::selection
