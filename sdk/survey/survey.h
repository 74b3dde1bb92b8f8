// A surveyed cave: its stations after adjustment, the legs between them, the passage around them, and the
// points that were shot on the walls. East, north and up, in metres.
//
//   Station ---- Leg ---- Station      measured along the passage
//      |  \                  |
//   Section  \- Splay        Section   left, right, up and down; points on the wall
//
// Stations that a survey equates are one station with several names: legs that meet share an index.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/common/enum_names.h"
#include "core_stack/common/geometry.h"

namespace karst::survey {

/// Where something stands in the survey's files. Line 0: the file does not say (.3d, .plt).
struct Source {
  std::uint32_t file = 0;  // index into Survey::files
  std::uint32_t line = 0;  // from 1
};

struct Station {
  std::string name;                  // in full, outermost survey first: "system.branch.12"
  std::vector<std::string> aliases;  // other names that were equated with it
  std::string comment;
  core::Vec3 position_m = core::Vec3::Zero();
  bool entrance = false;
  bool fixed = false;         // its coordinates were given, not measured
  bool continuation = false;  // the surveyor noted that the cave goes on
  bool surface = false;       // no leg that ends here is underground
  Source source;              // where it is first named
};

/// How a leg was measured.
enum class Style { normal, topofil, diving, cylpolar, cartesian, no_survey };
constexpr auto names_of(Style) {
  using enum Style;
  return std::to_array<core::Named<Style>>({{normal, "normal"},
                                            {topofil, "topofil"},
                                            {diving, "diving"},
                                            {cylpolar, "cylpolar"},
                                            {cartesian, "cartesian"},
                                            {no_survey, "no survey"}});
}

/// Where a leg goes in an extended profile, as its surveyor had it.
enum class Extend { normal, reverse, left, right, vertical, ignore, hide };
constexpr auto names_of(Extend) {
  using enum Extend;
  return std::to_array<core::Named<Extend>>({{normal, "normal"},
                                             {reverse, "reverse"},
                                             {left, "left"},
                                             {right, "right"},
                                             {vertical, "vertical"},
                                             {ignore, "ignore"},
                                             {hide, "hide"}});
}

/// Between two stations. The readings are calibrated, averaged with the backsights, and corrected for the
/// declination; none for what the style or the file does not give.
struct Leg {
  std::uint32_t from = 0, to = 0;  // indices into Survey::stations
  Style style = Style::normal;
  bool surface = false;      // over ground: no passage around it
  bool duplicate = false;    // the passage is measured by another leg as well
  bool approximate = false;  // sketched or estimated
  std::optional<double> length_m;
  std::optional<double> bearing_rad;      // clockwise from north
  std::optional<double> inclination_rad;  // up is positive
  Extend extend = Extend::normal;
  std::uint32_t run = 0;  // legs of one run were measured one after the other
  Source source;

  /// Under water, as far as the file tells: measured by depth gauge.
  bool underwater() const { return style == Style::diving; }
};

/// A point on the wall as seen from a station.
struct Splay {
  std::uint32_t station = 0;
  core::Vec3 end_m = core::Vec3::Zero();  // after adjustment
  bool surface = false;
  Source source;
};

/// Distances from a station to the walls. None: not measured. Zero: the wall is at the station.
struct Dimensions {
  std::optional<double> left_m, right_m, up_m, down_m;
  bool any() const { return left_m || right_m || up_m || down_m; }
};

/// The passage at a station, as seen in one direction. A junction has a section for each run through it.
struct Section {
  std::uint32_t station = 0;
  std::optional<std::uint32_t> leg;  // that it was noted with, if the file says so
  /// Horizontal, of unit length: left is a quarter turn counter-clockwise from it, seen from above. Along the
  /// run: between the directions of the legs before and behind; at a shaft, that of the section before, else
  /// of the first one that has any, else north.
  core::Vec3 facing = core::Vec3::UnitY();
  Dimensions dimensions;
  std::uint32_t run = 0;  // of the legs that it was noted with
  Source source;
};

/// What least squares had to distribute.
struct Loops {
  struct Traverse {        // between two junctions, as in cavern's .err file
    std::string from, to;  // names of its ends
    std::size_t legs = 0;
    double length_m = 0;
    double error_m = 0;                      // how far its far end moved against the measured one
    double error_percent = 0;                // of the length
    std::optional<double> sigmas;            // error over the one expected from the standard deviations
    std::vector<std::string> stations = {};  // that have a name, in order, its ends included
  };
  std::size_t count = 0;            // independent loops
  std::vector<Traverse> traverses;  // with an error of 0.01 m or more; the largest first
};

/// Parts of a survey that hang together with no fixed station. Readers of processed surveys see none.
struct LeftOut {
  std::size_t parts = 0, legs = 0;
  double legs_m = 0;
};

/// What was guessed, skipped or contradicts itself, in words.
struct Note {
  Source source;
  std::string text;
  std::size_t more = 0;  // further lines of the same file of which it holds as well
};

struct Survey {
  std::string title;
  std::vector<std::string> files;  // the one that was asked for first, then what it includes
  std::vector<Station> stations;   // without the far ends of splays
  std::vector<Leg> legs;           // without splays
  std::vector<Splay> splays;
  std::vector<Section> sections;  // those of a run in the order of the survey
  Loops loops;
  LeftOut left_out;
  std::vector<Note> notes;
  std::size_t notes_left_out = 0;  // beyond the first kMaxNotes
};
constexpr std::size_t kMaxNotes = 1000;

/// "data/upper.th: line 12", or the file alone.
std::string place_of(const Survey& survey, const Source& source);

/// Metres of the legs that are underground and no duplicates, after adjustment.
double length_m(const Survey& survey);

}  // namespace karst::survey
