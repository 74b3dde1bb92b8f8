// What a survey tells of the cave before the flight, in the frame of the flight.
#pragma once
#include <cstddef>
#include <optional>
#include <string>

#include "core_stack/mapping/prior/surveyed_passages.h"
#include "sdk/survey/survey.h"

namespace karst::survey_prior {

/// Legs underground that are no duplicates, less `offset_m`. Stations that a leg of less than a centimetre
/// joins are one.
///
/// Distances to the walls come from the section at a station that was noted on the leg's run, else from
/// another one that looks along the leg, else from the splays across it, each on its own; else they are
/// core::kUnmeasuredWall_m.
///
/// Leads are stations that the surveyor marked (Therion's `continuation`), and those with a single leg unless
/// they are entrances, or a leg over ground ends there.
core::SurveyPrior prior_of(const survey::Survey& survey, const core::Vec3& offset_m);

/// How the stations of a survey lie on those of the same name in the cave.
struct StationFit {
  core::Vec3 offset_m = core::Vec3::Zero();  // the cave's origin in the coordinates of the survey
  std::size_t names = 0;                     // stations that both have
  double median_m = 0, greatest_m = 0;       // distances of those after the offset; 0 without any
};

/// A name that was given to another station in the meantime, or a station that was measured anew, moves a few
/// stations by metres. If half of them are farther off, the surveys contradict each other.
constexpr double kMostResidual_m = 5;

/// By the stations of OUT.stations.csv beside `cave`, which `karst cave from-survey` writes; none if there is
/// no such file. The offset is `given_m`, else the median on each axis. Throws core::InputError naming
/// `file`, the survey's, if none is given and no name is the same, or the median residual is more than
/// kMostResidual_m.
std::optional<StationFit> station_fit(const std::string& file, const survey::Survey& survey,
                                      const std::string& cave, const std::optional<core::Vec3>& given_m);

/// The distance from a point to the nearest leg's line; +infinity if there is no leg.
double distance_to_legs_m(const core::SurveyPrior& prior, const core::Vec3& p);

/// "x y z" in metres, separated by blanks. Throws core::InputError naming `source` and `key`.
core::Vec3 read_offset(const std::string& source, const std::string& key, const std::string& text);
/// As read_offset() reads it.
std::string offset_text(const core::Vec3& offset_m);

}  // namespace karst::survey_prior
