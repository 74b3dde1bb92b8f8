// The passage at both ends of a surveyed leg, from left, right, up and down.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "sdk/survey/survey.h"

namespace karst::cave_drawing {

struct LegEnd {
  core::Vec3 station = core::Vec3::Zero();
  core::Vec3 left = core::Vec3::Zero(), right = core::Vec3::Zero();  // on the walls; the station if unknown
  double up_m = 0, down_m = 0, width_m = 0;
};

/// At the leg's first and its second station.
struct LegPassage {
  std::array<LegEnd, 2> drawn;     // what was not measured is interpolated along the passage
  std::array<LegEnd, 2> measured;  // what was not measured is 0
};

class LegWalls {
 public:
  /// `survey` must outlive it.
  explicit LegWalls(const survey::Survey& survey);

  /// A section of the leg's own run comes before others at the station. A dimension that is missing is
  /// interpolated between the nearest stations that have it, as `cave from-survey` does (left and right as
  /// the mean of both); but if nothing was measured at either end, the leg has no passage.
  LegPassage of(const survey::Leg& leg) const;

 private:
  const survey::Section* section_at(std::uint32_t station, std::uint32_t run) const;
  LegEnd end_of(std::uint32_t station, const core::Vec3& facing, const survey::Dimensions& dimensions) const;

  const survey::Survey& survey_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> of_run_;  // station and run: section
  std::map<std::uint32_t, std::size_t> of_station_;                        // the first
  std::vector<survey::Dimensions> between_;                                // by station: interpolated
};

/// More up or down than ahead.
bool is_steep(const std::array<LegEnd, 2>& ends);

}  // namespace karst::cave_drawing
