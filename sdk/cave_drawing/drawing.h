// What a drawing of a cave shows, before it is put on paper. In metres, right and up:
//
//   plan               east and north
//   extended profile   along the passages, unrolled, and height
//   projected profile  along a bearing, and height
//
// Heights are relative to the entrance.
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/common/enum_names.h"

namespace karst::cave_drawing {

using Point = Eigen::Vector2d;
using Line = std::vector<Point>;  // closed if it ends where it begins

enum class View { plan, extended_profile, projected_profile };
constexpr auto names_of(View) {
  using enum View;
  return std::to_array<core::Named<View>>(
      {{plan, "plan"}, {extended_profile, "extended"}, {projected_profile, "projected"}});
}

struct Mark {
  enum class Kind { entrance, find, unknown_end, joint, height, station };
  Kind kind = Kind::height;
  Point at = Point::Zero();
  std::string text;
};

struct Drawing {
  View view = View::plan;
  double bearing_rad = 0;                 // of a projected profile: clockwise from north, to the right
  std::vector<std::vector<Line>> spaces;  // filled by the even-odd rule: rings, those of pillars included
  std::vector<Line> walls;
  std::vector<Line> uncertain_walls;  // the limit of what was seen, or walls that were not measured
  std::vector<Line> hidden_walls;     // of passages below others
  std::vector<Line> centreline;       // measured legs
  std::vector<Line> paths;            // flown
  std::vector<Line> keep_in;          // outlines of where the vehicle might fly
  std::vector<Line> keep_out;         // and of where not
  std::vector<Line> splays;           // shots to the walls
  std::vector<Line> links;            // from a passage to where its side passage is drawn
  std::vector<Mark> marks;
};

/// What the title block says of the cave. Unknown figures are not printed.
struct CaveFacts {
  std::string name, date;
  std::string from;                       // "flight", "map", "survey"
  std::optional<double> length_m;         // along the passages
  std::optional<double> depth_m;          // of a survey: from the highest station to the lowest
  std::optional<double> floor_to_roof_m;  // of a map: from the lowest floor to the highest roof
  std::optional<double> volume_m3;
};

struct CaveDrawings {
  CaveFacts facts;
  Drawing plan, extended, projected;
};

}  // namespace karst::cave_drawing
