// What a cave is like, in ten figures: what caves are compared by. One table says each figure's name, unit,
// range and how two values of it are compared; files, JSON, text and distances all follow it
// (docs/select.md).
#pragma once
#include <limits>
#include <span>
#include <string>
#include <string_view>

namespace karst::selection {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// NaN: not known.
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
};

struct FigureDefinition {
  std::string_view name, unit;
  double CaveFigures::*value;
  double low, high;  // what is taken from a file
  // Two caves differ in a figure by the difference of scaled(value): log(value + offset), or the value
  // itself.
  bool logarithmic;
  double offset;
  double min_scale;  // differences are never magnified beyond this unit, however alike the known caves are
  double weight;
  std::string_view meaning;
};

std::span<const FigureDefinition> figure_definitions();

/// The value on the scale on which it is compared; NaN stays NaN.
double scaled(const FigureDefinition& figure, double value);

/// A JSON object of the figures that are known, rounded to six digits: what a campaign's store keeps of a
/// cave.
std::string to_json(const CaveFigures& figures);
/// Keys that are no figure are passed over; "" has none known. Throws InputError naming `source`.
CaveFigures figures_from_json(const std::string& text, const std::string& source);

/// What a caver knows, as an INFO file says it: any of the figures, values with units. Throws InputError
/// naming file, key and range, also if the file gives none at all.
CaveFigures read_figures(const std::string& file);

/// A line a known figure, for people.
std::string to_text(const CaveFigures& figures);

}  // namespace karst::selection
