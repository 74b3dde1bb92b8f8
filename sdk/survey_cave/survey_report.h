// What was made of a survey, what was guessed, and what is in the way.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::survey_cave {

/// Metres of legs at whose stations dimensions were not measured, by survey.
struct GuessedSurvey {
  std::string name;
  double legs_m = 0, without_m = 0, partly_m = 0;  // all legs; nothing measured; something measured
};

/// A connected part of the survey.
struct ConnectedPart {
  std::string station;  // one of it
  std::size_t stations = 0;
  double legs_m = 0;
};

struct Blocked {
  std::string station, comment;
};

/// The mesh that was made.
struct Walls {
  double resolution_m = 0, roughness_m = 0;
  double volume_m3 = 0, surface_m2 = 0;
  std::size_t triangles = 0, blocks = 0;
  std::size_t stations_in_rock = 0;        // 0, but for stations whose legs have no length
  std::vector<std::string> bare_stations;  // those, a few
};

/// Where the dimensions of passages come from.
struct Dimensioning {
  double without_m = 0, partly_m = 0;             // guessed: none measured; some measured
  double defaults_m = 0;                          // of those, nothing connected was measured either
  double half_width_m = 0, up_m = 0, down_m = 0;  // medians of what was measured
  double splays_m = 0, shafts_m = 0, widened_m = 0, least_m = 0;
  std::size_t sections_from_splays = 0;
  std::vector<GuessedSurvey> guessed;  // the most metres first
};

/// What keeps a vehicle or a caver from going on, and what does not.
struct Obstacles {
  double flooded_m = 0;
  std::vector<Blocked> blocked;              // stations whose comment names a sump or a choke
  std::vector<std::string> continuations;    // stations where the cave is noted to go on
  double vehicle_width_m = 0, narrow_m = 0;  // narrow: passage narrower or lower than the vehicle
  std::optional<double> within_reach_m;      // legs that the vehicle gets to from the start, if there is one
};

struct SurveyReport {
  std::size_t stations = 0, legs = 0, entrances = 0, splays = 0;
  double passage_m = 0, depth_m = 0;                  // depth: from the highest station to the lowest
  double surface_m = 0, duplicate_m = 0, rest_m = 0;  // left out; rest: passages outside the chosen part
  core::Vec3 offset_m = core::Vec3::Zero();           // survey coordinates = cave coordinates + offset
  Walls walls;
  Dimensioning dimensions;
  Obstacles obstacles;
  std::vector<ConnectedPart> parts;   // the longest first
  std::vector<std::string> findings;  // what may be wrong, and what mends it
};

}  // namespace karst::survey_cave
